#include "robots.hpp"

#include <set>
#include <utility>

#include "saphira/situation/why.hpp"

namespace saphira::console {

namespace {

constexpr double kCountRobots = 2.0;   // [s]
constexpr double kLookAtRobots = 0.5;  // [s]
constexpr double kLinger = 5.0;        // [s]

/// Its name tells it from the robot's own page, which ends with the robot.
bus::NodeOptions of_robot(bus::NodeOptions options, const std::string& robot) {
  options.name += " of " + options.robot;
  options.robot = robot;
  options.others = bus::Others::ignored;
  return options;
}

}  // namespace

Robots::Member::Member(bus::NodeOptions options, const std::string& robot)
    : node(of_robot(std::move(options), robot)) {}

void Robots::find(bool shown, double now) {
  if (shown)
    shown_ = now;
  shown = now < shown_ + kLinger;
  if (now < looked_ + (shown ? kLookAtRobots : kCountRobots))
    return;
  looked_ = now;
  std::set<std::string> partitions;
  for (const bus::OtherProgram& program : bus::Census(own_).others())
    if (program.name == "bridge" || program.name == "console")
      partitions.insert(program.robot);
  std::map<std::string, Robot> robots;
  for (const std::string& name : robots_of(partitions, own_.options().robot))
    if (name != own_.options().robot)
      robots[name] = std::move(robots_[name]);
  robots_ = std::move(robots);
  for (auto& [name, robot] : robots_) {
    if (!shown)
      robot = {};
    if (!shown || robot.member || !robot.trouble.empty())
      continue;
    try {
      robot.member = std::make_unique<Member>(own_.options(), name);
    } catch (const std::exception& error) {  // credentials for another robot
      robot.trouble = error.what();
    }
    return;  // one at a time: the pages of this robot do not wait for it
  }
}

void Robots::poll(double now) {
  for (auto& [name, robot] : robots_) {
    if (!robot.member)
      continue;
    Member& member = *robot.member;
    member.node.clear_wake();
    member.mind.poll();
    member.pages.visit([&](const v1::ConsolePage& page, const bus::SampleInfo& info) {
      if (info.disposed)
        member.page.erase(info.writer);
      else
        member.page[info.writer] = page;
    });
    for (const bus::WriterId& writer : member.pages.take_lost())
      member.page.erase(writer);
    member.stops.poll(now);
    const v1::Grant* grant = member.mind.grant();
    if (const auto command = member.pilot.stop(grant != nullptr && grant->estopped))
      member.estop.write(*command);
    if (now < member.explained + kLookAtRobots || !member.mind.heard())
      continue;
    member.explained = now;
    member.why = situation::why(member.mind.situation()).sentence;
  }
}

std::vector<RobotSeen> Robots::seen() const {
  std::vector<RobotSeen> all;
  for (const auto& [name, robot] : robots_) {
    RobotSeen& seen = all.emplace_back();
    seen.name = name;
    seen.trouble = robot.trouble;
    if (!robot.member)
      continue;
    const Member& member = *robot.member;
    seen.age = member.mind.silence();
    seen.robot = member.mind.robot();
    seen.grant = member.mind.grant();
    seen.why = member.why;
    if (!member.page.empty())
      seen.page = member.page.begin()->second;
  }
  return all;
}

void Robots::stop(const std::string& robot, bool latched, const std::string& person) {
  const auto found = robots_.find(robot);
  if (found == robots_.end() || !found->second.member)
    return;
  Member& member = *found->second.member;
  if (latched)
    member.pilot.press(person);
  else
    member.stops.send(bus::request("stop", {bus::text("by", person)}));
}

}  // namespace saphira::console
