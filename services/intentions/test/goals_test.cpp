// The goals of goals.txt: the test is their askers, the bridge and the robot.
#include <cctype>
#include <memory>
#include <sstream>
#include <string>

#include "arguments.hpp"
#include "bench.hpp"
#include "lines.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/idl/goal_words.hpp"

namespace saphira::intentions {
namespace {

/// One case.
class Desk : public test::LinePlayer {
 public:
  void take(const std::string& line) {
    if (std::isdigit(static_cast<unsigned char>(line[0])) != 0) {
      std::istringstream in(line);
      const auto ids = read<std::string>(in);
      check(ids, in);
    } else {
      LinePlayer::take(line);
    }
  }
  Desk() {
    events_ = {
      ON("ask", ask(in)),
      ON("begin", ask(in); bench_->step()),
      ON("step", bench_->step(in >> std::ws && !in.eof() ? read<int>(in) : 1)),
      ON("hear", bench_->hear()),
      ON("run", run(in)),
      ON("withdraw", bench_->dispose(read<std::uint64_t>(in))),
      ON("lose-writer", bench_->lose_writer(read<std::uint64_t>(in))),
      ON("estop", bench_->estop = rest(in)),
      ON("stop", bench_->stop = stop_of(rest(in))),
      ON("bridge-confirms", bench_->confirms_stops = true),
      ON("heed", bench_->executor.heed(stop_of(rest(in)))),
      ON("interrupt", EXPECT_TRUE(bench_->executor.interrupt(bench_->out.nodes.at(0).id))),
      ON("robot-gone", bench_->executor.lose_robot(); bench_->hear()),
      ON("connected", bench_->world.robot.connected = rest(in) == "yes"),
      ON("new-connection", connect_anew()),
      ON("new-odom", bench_->world.robot.odom = 2),
      ON("at", bench_->world.robot.pose_in_odom = test::pose_of(rest(in))),
      ON("map", bench_->world.robot.odom_in_map = test::pose_of(rest(in))),
      ON("lost", bench_->world.robot.odom_in_map.reset()),
      ON("held", bench_->world.held = rest(in) == "yes"),
      ON("velocity", bench_->world.robot.velocity = read<double>(in)),
      ON("motors-off", bench_->world.robot.has_power = false),
      ON("step-alone", bench_->step_without_moving()),
      ON("restart", restart()),
      ON("sleep", bench_->cycle += read<std::uint64_t>(in))
    };
    facts_ = {IS("behaviors", behaviors()),
              IS("goal", goal()),
              IS("nodes", std::to_string(bench_->out.nodes.size())),
              {"heeds",
               [this] {
                 const v1::StopId stop = bench_->executor.heeds();
                 return std::to_string(stop.asker) + ":" + std::to_string(stop.number);
               }},
              IS("asks the bridge to stop for", bench_->out.stop.value_or("nobody")),
              IS("known", known()),
              IS("cycle", std::to_string(bench_->cycle)),
              IS("published", std::to_string(bench_->published)),
              IS("functor of 1", bench_->status(1).functor),
              IS("pose", told(bench_->world.robot.pose_in_odom)),
              IS("note of 1", bench_->status(1).note),
              IS("step of 1", bench_->status(1).step),
              IS("elapsed of 1", plain(bench_->status(1).elapsed)),
              IS("elapsed of 2", plain(bench_->status(2).elapsed))};
  }

 private:
  /// "1,2: waiting preempted for 3 (the reason)": without a reason any is right, and "..." is any
  /// end of it.
  void check(const std::string& ids, std::istringstream& in) {
    const std::string wanted = rest(in);
    std::istringstream all(ids.substr(0, ids.find(':')));
    for (std::string id; std::getline(all, id, ',');) {
      const GoalStatus& status = bench_->status(std::stoull(id));
      std::string is = word_of(status.state);
      if (status.code != v1::CODE_NONE)
        is += " " + code_name(status.code);
      if (status.waits_for.number != 0)
        is += " for " + std::to_string(status.waits_for.number);
      if (wanted.find('(') != std::string::npos)
        is += " (" + status.reason + ")";
      if (wanted.ends_with("..."))
        is = is.substr(0, wanted.size() - 3) + "...";
      EXPECT_EQ(is, wanted) << "goal " << id;
    }
  }
  /// "1,2 go_to position=(50 0) @priority=5 @deadline=2 @keep=yes".
  void ask(std::istringstream& in) {
    std::istringstream ids(read<std::string>(in));
    const auto functor = read<std::string>(in);
    const std::string text = rest(in);
    for (std::string id; std::getline(ids, id, ',');) {
      Goal goal = Bench::goal(std::stoull(id), functor, {});
      for (const Argument& argument : test::arguments_of(text, Frame::odom))
        if (argument.name == "@priority")
          goal.priority = static_cast<int>(argument.number);
        else if (argument.name == "@deadline")
          goal.deadline = argument.number;
        else if (argument.name == "@keep")
          goal.writer_lost = v1::WRITER_LOST_KEEP;
        else
          goal.arguments.push_back(argument);
      if (goal.id.number == 0)
        goal.id = {};
      bench_->write(goal);
    }
  }
  /// Until the goal is in another state, to that cycle at most.
  void run(std::istringstream& in) {
    const auto id = read<std::uint64_t>(in);
    const auto until = read<std::uint64_t>(in);
    bench_->run(id, until, bench_->statuses.contains(id) ? bench_->state(id) : v1::GOAL_WAITING);
  }
  void restart() {
    const ScriptedRobot world = bench_->world;
    const std::uint64_t cycle = bench_->cycle;
    bench_ = std::make_unique<Bench>(bench_->memory);
    bench_->world = world;
    bench_->cycle = cycle;
  }
  void connect_anew() {
    bench_->epoch = 101;
    bench_->cycle = 0;
  }
  /// With their priorities.
  std::string behaviors() const {
    std::string all;
    for (const IntendedBehavior& behavior : bench_->out.behaviors)
      all += (all.empty() ? "" : " ") + behavior.schema + "/" + std::to_string(behavior.priority);
    return all.empty() ? "none" : all;
  }
  std::string known() const {
    std::string all;
    for (const auto& [id, status] : bench_->statuses)
      all += (all.empty() ? "" : " ") + std::to_string(id);
    return all.empty() ? "none" : all;
  }
  /// Of the first behavior that has one.
  std::string goal() const {
    for (const IntendedBehavior& behavior : bench_->out.behaviors)
      if (const Argument* goal = find(behavior.parameters, "goal"); goal != nullptr)
        return told(goal->point);
    return "none";
  }
  static std::string told(const Pose& at) {
    return format("%.2f %.2f %.0f", at.x, at.y, degrees(at.th));
  }

  std::unique_ptr<Bench> bench_ = std::make_unique<Bench>();
};

TEST(Goals, DoAsWritten) {
  EXPECT_EQ(test::play<Desk>("services/intentions/test/goals.txt"), 54);
}

}  // namespace
}  // namespace saphira::intentions
