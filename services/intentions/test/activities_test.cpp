// The activities of activities.txt.
#include <memory>
#include <sstream>

#include "arguments.hpp"
#include "language_bench.hpp"
#include "lines.hpp"
#include "saphira/base/text.hpp"
#include "saphira/idl/goal_words.hpp"

namespace saphira::intentions {
namespace {

std::string code_words(GoalCode code) {
  return code == v1::CODE_TIMEOUT    ? "timeout"
         : code == v1::CODE_ACTIVITY ? "activity"
                                     : std::to_string(code);
}

std::string digits(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

/// One case.
class Script : public test::LinePlayer {
 public:
  /// A line of the activities; or, behind them, an event or an expectation.
  void take(const std::string& line) {
    if (line[0] == '(' || line[0] == ' ') {
      activities_ += line + "\n";
      return;
    }
    if (!stage_)
      stage_ = std::make_unique<Stage>(activities_);
    const std::size_t colon = line.find(':');
    std::istringstream in(line.substr(0, colon));
    std::string verb;
    in >> verb;
    if (colon == std::string::npos) {
      happen(verb, in);
      return;
    }
    expect_like(fact(line.substr(0, colon), verb, in),
                line.size() > colon + 2 ? line.substr(colon + 2) : "");
  }

 private:
  std::string fact(const std::string& what, const std::string& verb, std::istringstream& in) {
    if (what == "behaviors")
      return joined(stage_->behaviors(), " ");
    if (what == "display")
      return stage_->display();
    if (what == "said")
      return joined(stage_->messages, " | ");
    if (what == "last said")
      return stage_->messages.back();
    if (what == "sentences")
      return std::to_string(stage_->messages.size());
    if (what == "nodes")
      return std::to_string(stage_->out.nodes.size());
    if (what == "first behavior") {
      const IntendedBehavior& first = stage_->out.behaviors.at(0);
      return first.schema + "/" + std::to_string(first.priority) + " " + describe(first.parameters);
    }
    if (what == "behavior control")
      return stage_->out.behavior_control ? "yes" : "no";
    std::string name;
    in >> name;
    if (verb == "belief")
      return spoken(stage_->belief(name));
    const GoalStatus& status = stage_->status(std::stoull(name));
    return verb == "goal"       ? word_of(status.state)
           : verb == "code"     ? code_words(status.code)
           : verb == "reason"   ? status.reason
           : verb == "step"     ? status.step
           : verb == "progress" ? digits(status.progress)
           : verb == "level"    ? digits(status.level)
           : verb == "trend"    ? digits(status.trend)
                                : "no such fact: " + what;
  }

  void happen(const std::string& verb, std::istringstream& in) {
    std::string name;
    std::string more;
    double level = 0.0;
    std::uint64_t id = 0;
    int cycles = 1;
    if (verb == "begin" && in >> id >> name >> cycles) {
      stage_->begin(id, name, cycles);
    } else if (verb == "ask" && in >> id >> name) {
      std::getline(in, more);
      const std::size_t at = std::min(more.find(" priority "), more.size());
      stage_->ask(id, name, test::arguments_of(more.substr(0, at)),
                  at < more.size() ? std::stoi(more.substr(at + 10)) : 0);
    } else if (verb == "step" && in >> cycles) {
      stage_->step(cycles);
    } else if (verb == "withdraw" && in >> id) {
      stage_->dispose(id);
    } else if ((verb == "stall" || verb == "free") && in >> cycles) {
      stage_->stall(verb == "stall", cycles);
    } else if ((verb == "left" || verb == "right") && in >> name) {
      (verb == "left" ? stage_->inputs.robot.left_stalled : stage_->inputs.robot.right_stalled) =
          name == "stalls";
    } else if (verb == "satisfy" && in >> name >> level >> cycles) {
      stage_->satisfy(name, level, cycles);
    } else if (verb == "claim" && in >> name >> more) {
      claim(*stage_, name, more == "t");
    } else if (verb == "say" && in >> name && std::getline(in >> std::ws, more)) {
      stage_->inputs.claims.push_back(
          {ClaimEvent::Kind::kSaid, {9, ++claims_}, "a person", name, Value(more)});
    } else if (verb == "keep" && in >> name >> id) {
      kept_[name] = stage_->out.nodes.at(id).id;
    } else if ((verb == "interrupt" || verb == "not-interrupt") && in >> name) {
      EXPECT_EQ(stage_->executor->interrupt(kept_.at(name)), verb == "interrupt");
    } else if ((verb == "resume" || verb == "not-resume") && in >> name) {
      EXPECT_EQ(stage_->executor->resume(kept_.at(name)), verb == "resume");
    } else if (verb == "level" && in >> level) {
      stage_->level = level;
    } else if (verb == "odom" && in >> id) {
      stage_->inputs.robot.odom = id;
    } else if (verb == "at" && std::getline(in, more)) {
      stage_->inputs.robot.pose_in_odom = test::pose_of(more);
    } else if (verb == "odom-in-map" && std::getline(in, more)) {
      stage_->inputs.robot.odom_in_map = test::pose_of(more);
    } else if (verb == "lost") {
      stage_->inputs.robot.odom_in_map.reset();
    } else if (verb == "trouble" && std::getline(in >> std::ws, more)) {
      stage_->inputs.troubles = {{stage_->out.behaviors.at(0).name, more}};
    } else {
      ADD_FAILURE() << "not understood: " << verb;
    }
  }

  std::string activities_;
  std::unique_ptr<Stage> stage_;
  std::map<std::string, std::uint32_t> kept_{{"nobody", 4711}};  ///< intentions by a name
  std::uint64_t claims_ = 0;
};

TEST(ActivitiesInWords, DoAsWritten) {
  EXPECT_EQ(test::play<Script>("services/intentions/test/activities.txt", ';'), 57);
}

}  // namespace
}  // namespace saphira::intentions
