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
        {"ask", [this](auto& in) { ask(in); }},
        {"begin",
         [this](auto& in) {
           ask(in);
           bench_->step();
         }},
        {"step",
         [this](auto& in) { bench_->step(in >> std::ws && !in.eof() ? read<int>(in) : 1); }},
        {"hear", [this](auto&) { bench_->hear(); }},
        {"run", [this](auto& in) { run(in); }},
        {"withdraw", [this](auto& in) { bench_->dispose(read<std::uint64_t>(in)); }},
        {"lose-writer", [this](auto& in) { bench_->lose_writer(read<std::uint64_t>(in)); }},
        {"estop", [this](auto& in) { bench_->estop = rest(in); }},
        {"stop", [this](auto& in) { bench_->stop = stop_of(rest(in)); }},
        {"bridge-confirms", [this](auto&) { bench_->confirms_stops = true; }},
        {"heed", [this](auto& in) { bench_->executor.heed(stop_of(rest(in))); }},
        {"interrupt",
         [this](auto&) { EXPECT_TRUE(bench_->executor.interrupt(bench_->out.nodes.at(0).id)); }},
        {"robot-gone",
         [this](auto&) {
           bench_->executor.lose_robot();
           bench_->hear();
         }},
        {"connected", [this](auto& in) { bench_->world.robot.connected = rest(in) == "yes"; }},
        {"new-connection", [this](auto&) { connect_anew(); }},
        {"new-odom", [this](auto&) { bench_->world.robot.odom = 2; }},
        {"at", [this](auto& in) { bench_->world.robot.pose_in_odom = test::pose_of(rest(in)); }},
        {"map", [this](auto& in) { bench_->world.robot.odom_in_map = test::pose_of(rest(in)); }},
        {"lost", [this](auto&) { bench_->world.robot.odom_in_map.reset(); }},
        {"held", [this](auto& in) { bench_->world.held = rest(in) == "yes"; }},
        {"velocity", [this](auto& in) { bench_->world.robot.velocity = read<double>(in); }},
        {"motors-off", [this](auto&) { bench_->world.robot.has_power = false; }},
        {"step-alone", [this](auto&) { bench_->step_without_moving(); }},
        {"restart", [this](auto&) { restart(); }},
        {"sleep", [this](auto& in) { bench_->cycle += read<std::uint64_t>(in); }}};
    facts_ = {
        {"behaviors", [this] { return behaviors(); }},
        {"goal", [this] { return goal(); }},
        {"nodes", [this] { return std::to_string(bench_->out.nodes.size()); }},
        {"heeds",
         [this] {
           const v1::StopId stop = bench_->executor.heeds();
           return std::to_string(stop.asker) + ":" + std::to_string(stop.number);
         }},
        {"asks the bridge to stop for", [this] { return bench_->out.stop.value_or("nobody"); }},
        {"known", [this] { return known(); }},
        {"cycle", [this] { return std::to_string(bench_->cycle); }},
        {"published", [this] { return std::to_string(bench_->published); }},
        {"functor of 1", [this] { return bench_->status(1).functor; }},
        {"pose", [this] { return told(bench_->world.robot.pose_in_odom); }},
        {"note of 1", [this] { return bench_->status(1).note; }},
        {"step of 1", [this] { return bench_->status(1).step; }},
        {"elapsed of 1", [this] { return plain(bench_->status(1).elapsed); }},
        {"elapsed of 2", [this] { return plain(bench_->status(2).elapsed); }}};
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
