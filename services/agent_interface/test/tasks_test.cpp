// The tasks of tasks.txt.
#include "saphira/agent_interface/tasks.hpp"

#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "lines.hpp"
#include "saphira/base/archive.hpp"

namespace saphira::agent_interface {
namespace {

const std::map<std::string, Identity> kMembers{{"planner", {"planner", "agent"}},
                                               {"karen", {"karen", "operator"}},
                                               {"anna", {"anna", "agent"}}};

/// "turn", "stop" and "pause" are motions; anything else is brought.
Task task(const std::string& speaker, const std::string& name) {
  const bool motion = name == "turn" || name == "stop" || name == "pause";
  Task task;
  task.goal.functor = name == "turn" ? "turn_to" : motion ? name : "deliver";
  task.goal.lasting = !motion;
  task.goal.speaker = speaker;
  task.brief = motion;
  task.what = name == "stop" ? "I stop" : motion ? "I turn" : "I bring " + name;
  task.doing = motion ? "" : "bringing " + name;
  task.name = motion ? "the turn" : name;
  return task;
}

/// The open tasks, the newest first.
std::string doing(const Tasks& tasks) {
  std::string text;
  for (const Task& one : tasks.open())
    text = whole_text(one) + (text.empty() ? "" : "; ") + text;
  return text;
}

/// One case.
class Errands : public test::LinePlayer {
 public:
  Errands() {
    events_ = {
      ON("want", want(in, false)),
      ON("want-and-drop", want(in, true)),
      ON("agree", told(tasks_.want(asks_, said_, true))),
      ON("go-on", said_ = words(in); told(tasks_.go_on(said_))),
      ON("done", end(in, true)),
      ON("failed", end(in, false)),
      ON("left", told(tasks_.left({static_cast<std::uint8_t>(read<int>(in))}))),
      ON("sent", tasks_.asked(read<std::uint64_t>(in), {40, 2}, "it")),
      ON("restart", restart()),
      ON(">", next(rest(in)))
    };
    facts_ = {IS("doing", doing(tasks_)), IS("asks", std::to_string(asks_.size())),
              IS("spoken for", std::to_string(tasks_.spoken_for().second)),
              IS("bob goes on", tasks_.going_on("bob")),
              IS("alice goes on", tasks_.going_on("alice"))};
  }
  void finish() { EXPECT_EQ(next_, told_.size()) << "not expected: " << told_.at(next_); }

 private:
  /// "alice", "alice as anna" or "model of 1".
  Utterance words(std::istringstream& in) {
    Utterance made{{7, ++number_}, read<std::string>(in), "do it"};
    std::string more;
    while (in >> more && (more == "as" || more == "of"))
      if (more == "as")
        made.person = kMembers.at(read<std::string>(in));
      else
        made.program = {static_cast<std::uint8_t>(read<int>(in))};
    return made;
  }
  /// "alice: the mail, turn".
  void want(std::istringstream& in, bool drops) {
    const std::string line = rest(in);
    const std::size_t colon = line.find(':');
    std::istringstream speaker(line.substr(0, colon));
    said_ = words(speaker);
    std::vector<Task> steps;
    for (std::size_t at = colon + 2, end = 0; at < line.size(); at = end + 2) {
      end = std::min(line.find(", ", at), line.size());
      steps.push_back(task(said_.speaker, line.substr(at, end - at)));
    }
    told(tasks_.want(std::move(steps), said_, drops));
  }
  void end(std::istringstream& in, bool success) {
    const auto tag = read<std::uint64_t>(in);
    told(tasks_.ended({tag, success, rest(in)}));
  }
  void restart() {
    const std::string kept = saved(tasks_);
    auto restarted = restored<Tasks>(kept);
    EXPECT_EQ(restarted.lasting(), tasks_.lasting());
    EXPECT_EQ(saved(restarted), kept);
    tasks_ = std::move(restarted);
  }
  /// The robot's words with their listeners, the canceled goals, and the new ones with their
  /// priorities and persons.
  void told(const Tasks::Outputs& out) {
    finish();
    told_.clear();
    next_ = 0;
    asks_ = out.asks;
    for (const Said& one : out.said)
      told_.push_back(one.listener + ": " + one.text + (one.end ? "." : "") +
                      (!one.refused              ? ""
                       : out.denied.text.empty() ? " (asks)"
                                                 : " (refused)"));
    for (const std::uint64_t tag : out.canceled)
      told_.push_back("cancel " + std::to_string(tag));
    for (const WantedGoal& goal : out.goals)
      told_.push_back("goal " + std::to_string(goal.tag) + " " + goal.functor + " " +
                      std::to_string(goal.priority) +
                      (goal.person ? " of " + goal.person->name : ""));
  }
  void next(const std::string& wanted) {
    ASSERT_LT(next_, told_.size()) << "not told: " << wanted;
    expect_like(told_[next_++], wanted);
  }

  Tasks tasks_;
  Utterance said_;
  std::vector<Task> asks_;  ///< the newest question is about
  std::uint64_t number_ = 0;
  std::vector<std::string> told_;
  std::size_t next_ = 0;
};

TEST(Tasks, GoOnAsWritten) {
  EXPECT_EQ(test::play<Errands>("services/agent_interface/test/tasks.txt"), 16);
}

TEST(GoalDeadline, LeavesTimeForTheAnswer) {
  EXPECT_DOUBLE_EQ(goal_deadline(1.5), 1.0);
  EXPECT_DOUBLE_EQ(goal_deadline(0.4), 0.2);
  EXPECT_EQ(goal_deadline(0.0), 0.0) << "without one";
}

}  // namespace
}  // namespace saphira::agent_interface
