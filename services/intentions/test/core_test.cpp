// The intentions service without a bus, by core.txt; and what its lines cannot say.
#include "saphira/intentions/core.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>

#include "arguments.hpp"
#include "bench.hpp"
#include "lines.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/idl/goal_words.hpp"
#include "saphira/idl/members.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/navigation.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::intentions {
namespace {

constexpr Core::Writer kKaren{1};
constexpr Core::Writer kJohn{2};

Core::Writer writer_of(const std::string& name) {
  return name == "karen" ? kKaren : kJohn;
}

Core::Settings settings() {
  Core::Settings settings;
  settings.registry = built_in();
  settings.functions = all_functions();
  return settings;
}

Core::Settings remembering(Memory memory) {
  Core::Settings made = settings();
  made.memory = std::move(memory);
  made.remembers_work = true;
  return made;
}

Core::Received::Goal written(std::uint64_t number, const Core::Writer& writer) {
  Core::Received::Goal received;
  received.writer = writer;
  received.event.goal.id = {5, number};
  received.event.goal.functor = "go_to";
  received.event.goal.requester = "a test";
  received.event.goal.arguments = {point("position", {5.0, 0.0, 0.0}, Frame::odom)};
  return received;
}

/// A connected robot, and the newest statuses of goals.
class Site {
 public:
  Site() {
    inputs.stamp.epoch = 7;
    inputs.robot.connected = true;
    inputs.robot.odom = 1;
  }
  Core::Outputs step(Core& core) {
    ++inputs.stamp.cycle;
    if (!silent)
      inputs.behaviors_cycle = inputs.stamp.cycle - 1;
    const lps::LpsSettings robot;
    inputs.new_robot = inputs.stamp.cycle == 1 || is_new ? &robot : nullptr;
    is_new = false;
    core.processes().step(inputs.stamp.cycle);
    Core::Outputs outputs = core.step(inputs);
    inputs.received = {};
    inputs.maps.clear();
    inputs.new_frame = false;
    note(outputs.intended.updates);
    return outputs;
  }
  void note(const GoalUpdates& updates) {
    for (const GoalStatus& status : updates.changed)
      statuses[status.id] = status;
  }
  const GoalStatus& status(std::uint64_t number) const { return statuses.at({5, number}); }
  GoalState state(std::uint64_t number) const { return status(number).state; }

  Core::Inputs inputs;
  bool is_new = false;  ///< the core has not seen the robot
  bool silent = false;  ///< the behaviors are not heard any more
  std::map<GoalId, GoalStatus> statuses;
};

/// One case of core.txt.
class Programs : public test::LinePlayer {
 public:
  Programs() {
    events_ = {
      ON("lockstep", settings_.lockstep = true),
      ON("models-need-approval", settings_.approval = {"", "language model", "guest"}),
      ON("ask", now().goals.push_back(goal(in))),
      ON("begin", now().goals.push_back(goal(in)); step(1)),
      {"end",
       [this](auto& in) {
         now().goals.push_back(goal(in));
         now().goals.back().event.kind = GoalEvent::Kind::kDisposed;
         step(1);
       }},
      ON("lose", now().lost_requesters = now().lost_claimants = {writer_of(rest(in))}),
      ON("grant", grant(in)),
      ON("own-stop", site_.inputs.own_stop = stop_of(rest(in))),
      ON("claim", claim(in)),
      ON("running", now().running = read<double>(in)),
      ON("step", step(in >> std::ws && !in.eof() ? read<int>(in) : 1)),
      {"run",
       [this](auto& in) {
         const auto id = read<std::uint64_t>(in);
         for (int left = read<int>(in); left > 0 && !ended(site_.state(id)); --left)
           step(1);
       }},
      ON("between", between(read<double>(in))),
      ON("behaviors-fall-silent", site_.silent = true),
      ON("suspend", core().processes().find("execute-intentions")->suspend()),
      ON("resume", core().processes().find("execute-intentions")->resume()),
      ON("tell", tell(in)),
      ON("activity", activity(in)),
      ON("no-activity", now().activities = ActivityFolders::Reload{true, {}, {rest(in)}, {}, {}}),
      ON("map", map(in)),
      ON("map-revision", site_.inputs.map_revision = read<std::uint64_t>(in)),
      ON("odom-in-map", site_.inputs.robot.odom_in_map = test::pose_of(rest(in))),
      {"registration",
       [this](auto& in) {
         const std::string state = rest(in);
         site_.inputs.registered.state =
             state == "lost" ? v1::REGISTRATION_LOST : v1::REGISTRATION_TRACKING;
         if (state == "gone")
           site_.inputs.registered.state.reset();
         site_.inputs.registered.adds_features = state == "grows";
       }},
      ON("says",
         expect_like(joined(notes_.lines(), " | ", [](const Note& one) { return one.text; }),
                     rest(in)))
    };
    facts_ = {
        IS("intends", yes(!out_.intended.behaviors.empty())),
        IS("asks to stop", out_.intended.stop.value_or("nobody")),
        {"heeds",
         [this] {
           const v1::StopId stop = core().executor().heeds();
           return format("%d:%d", int(stop.asker), int(stop.number));
         }},
        IS("requester of 1", site_.status(1).requester),
        IS("changed", std::to_string(changed_)),
        IS("answer", answer_),
        IS("believed", believed(false)),
        IS("believed since", believed(true)),
        IS("audit", joined(out_.audit, ", ",
                           [](const v1::AuditEntry& one) {
                             return one.who + " " + std::string(v1::name_of(one.act)).substr(6);
                           })),
        IS("asks registration",
           joined(out_.intended.requests, " ", [](const Request& one) { return one.functor; })),
        IS("edges", std::to_string(out_.edges.size())),
        IS("nearest edge",
           format("%.2f %.2f", out_.edges.at(0).from.y(), out_.edges.at(0).to.y()))};
  }
  void take(const std::string& line) {
    std::istringstream in(line);
    const auto ids = read<std::string>(in);
    if (std::isdigit(static_cast<unsigned char>(ids[0])) != 0 && ids.back() == ':')
      check(ids, rest(in));
    else
      LinePlayer::take(line);
  }

 private:
  Core& core() {
    if (!core_)
      core_.emplace(settings_);
    return *core_;
  }
  Core::Received& now() { return site_.inputs.received; }
  void step(int steps) {
    for (; steps > 0; --steps) {
      out_ = site_.step(core());
      heard(out_.notes, out_.intended.updates);
      if (out_.beliefs)
        beliefs_ = *out_.beliefs;
    }
  }
  void between(double silence) {
    const Core::BetweenOutputs told = core().between(std::exchange(now(), {}), silence);
    site_.note(told.updates);
    heard(told.notes, told.updates);
  }
  void heard(const Notes& notes, const GoalUpdates& updates) {
    notes_ = notes;
    changed_ = updates.changed.size();
  }
  /// "1 go_to position=(5 0) @by=karen @as=karen/agent @priority=7": usually Karen's program goes
  /// to a point; a program of another person is John's.
  static Core::Received::Goal goal(std::istringstream& in) {
    Core::Received::Goal made = written(read<std::uint64_t>(in), kKaren);
    Goal& goal = made.event.goal;
    std::string text = rest(in);
    const std::string first = text.substr(0, text.find(' '));
    if (!first.empty() && first.find('=') == std::string::npos) {
      goal.functor = first;
      goal.arguments.clear();
      text.erase(0, first.size());
    }
    for (const Argument& one : test::arguments_of(text, Frame::odom))
      if (one.name == "@by")
        made.writer = writer_of(one.text);
      else if (one.name == "@as")
        made.person = Identity{one.text.substr(0, one.text.find('/')),
                               one.text.substr(one.text.find('/') + 1)};
      else if (one.name == "@says")
        goal.requester = one.text;
      else if (one.name == "@why")
        made.event.why = one.text;
      else if (one.name == "@priority")
        goal.priority = static_cast<int>(one.number);
      else if (one.name == "@deadline")
        goal.deadline = one.number;
      else if (one.name == "@age")
        made.age = one.number;
      else if (one.name == "@keep")
        goal.writer_lost = v1::WRITER_LOST_KEEP;
      else
        goal.arguments = {one};
    return made;
  }
  void grant(std::istringstream& in) {
    Core::Received::Grant grant;
    for (const Argument& one : test::arguments_of(rest(in)))
      if (one.name == "pressed")
        grant.pressed = true, grant.source = one.text;
      else if (one.name == "stop")
        grant.stop = stop_of(one.text);
      else if (one.name == "waits")
        grant.waits_for_hand_back = true;
      else
        (one.name == "person" ? grant.person : grant.refusal) = one.text;
    now().grants.push_back(grant);
  }
  /// "1 door ends", with its writer, John; or "1 door stays 2.5", which is its age [s].
  void claim(std::istringstream& in) {
    Core::Received::Claim claim;
    claim.event.id = {9, read<std::uint64_t>(in)};
    claim.event.source = "a person";
    claim.event.name = read<std::string>(in);
    claim.event.value = Value(1.0);
    claim.writer = kJohn;
    claim.ends_with_writer = read<std::string>(in) == "ends";
    in >> claim.age;
    now().claims.push_back(claim);
  }
  std::string believed(bool since) const {
    std::string all;
    for (const Belief& one : beliefs_)
      if (one.said_by == "a person")
        all += (all.empty() ? "" : " ") + one.name + (since ? " " + std::to_string(one.since) : "");
    return all.empty() ? "nothing" : all;
  }
  /// "interrupt NAME", "resume NAME"; with a count of cycles at its end.
  void tell(std::istringstream& in) {
    const bool resume = read<std::string>(in) == "resume";
    const auto name = read<std::string>(in);
    std::uint32_t cycles = 0;
    in >> cycles;
    answer_ = core()
                  .ask(name, resume ? ProcessAction::resume : ProcessAction::interrupt, cycles)
                  .value_or("no such intention");
    if (answer_.empty())
      answer_ = "done";
  }
  /// "go-to-place" or "go-to-place place", which is its parameter.
  void activity(std::istringstream& in) {
    Schema schema;
    in >> schema.name;
    Parameter parameter;
    if (in >> parameter.name) {
      parameter.kind = ArgumentKind::text;
      parameter.place = true;
      schema.parameters = {parameter};
    }
    now().activities = ActivityFolders::Reload{true, {schema}, {}, {}, {}};
  }
  /// "1 CORRIDOR ... / OFFICE ...": its revision and lines.
  void map(std::istringstream& in) {
    const auto revision = read<std::uint64_t>(in);
    std::string text = rest(in) + "\n";
    for (std::size_t at = 0; (at = text.find(" / ")) != std::string::npos;)
      text.replace(at, 3, "\n");
    site_.inputs.maps.push_back(
        {revision, std::make_shared<const maps::Map>(maps::parse_map(text, "a.map"))});
  }
  /// "1,2: suspended PREEMPTED (the reason)": without a reason any is right.
  void check(const std::string& ids, const std::string& wanted) {
    std::istringstream all(ids.substr(0, ids.size() - 1));
    for (std::string id; std::getline(all, id, ',');) {
      const GoalStatus& status = site_.status(std::stoull(id));
      expect_like(word_of(status.state) +
                      (status.code == v1::CODE_NONE ? "" : " " + code_name(status.code)) +
                      (wanted.find('(') == std::string::npos ? "" : " (" + status.reason + ")"),
                  wanted);
    }
  }

  Core::Settings settings_ = settings();
  std::optional<Core> core_;
  Site site_;
  Core::Outputs out_;
  Notes notes_;
  std::size_t changed_ = 0;  ///< goals of the newest step, or of that between
  std::vector<Belief> beliefs_;
  std::string answer_;
};

TEST(IntentionsCore, DoesAsWritten) {
  EXPECT_EQ(test::play<Programs>("services/intentions/test/core.txt"), 36);
}

class CoreTest : public testing::Test, protected Site {};

TEST_F(CoreTest, WithoutMemoryAGoalOfBeforeTheStartIsNotDriven) {
  using Condition = Memory::Condition;
  for (const Condition condition : {Condition::kNone, Condition::kDamaged, Condition::kWhole}) {
    Memory memory;
    memory.condition = condition;
    memory.endings = {{{5, 3}, v1::GOAL_SUCCEEDED, v1::CODE_NONE, "arrived"}};
    Core core(remembering(memory));
    for (const std::uint64_t number : {1U, 2U, 3U}) {
      inputs.received.goals.push_back(written(number, kKaren));
      inputs.received.running = 1.0;
      inputs.received.goals.back().age = number == 2 ? 3.0 : 61.0;
    }
    statuses.clear();
    inputs.stamp.cycle = 0;
    step(core);
    step(core);
    const bool whole = condition == Condition::kWhole;
    EXPECT_EQ(state(1), whole ? v1::GOAL_UNDERWAY : v1::GOAL_REFUSED);
    EXPECT_EQ(state(2), whole ? v1::GOAL_WAITING : v1::GOAL_UNDERWAY)
        << "programs of a deployment start together";
    EXPECT_EQ(state(3), v1::GOAL_SUCCEEDED) << "it is remembered";
    if (whole)
      continue;
    const GoalStatus& refused = statuses.at({5, 1});
    EXPECT_EQ(refused.code, v1::CODE_FORGOTTEN);
    EXPECT_NE(refused.reason.find("60 s before intentions started"), std::string::npos)
        << refused.reason;
    EXPECT_EQ(refused.reason.find("damaged") != std::string::npos,
              condition == Condition::kDamaged);
    // A repeated request is another goal.
    inputs.received.goals = {written(4, kKaren)};
    step(core);
    EXPECT_EQ(state(4), v1::GOAL_WAITING);
  }
}

TEST_F(CoreTest, ActivitiesOfFilesThatHaveChangedAreToldOf) {
  Core core(settings());
  const auto look = [&](const ActivityFolders::Reload& reload) {
    Core::Received received;
    received.activities = reload;
    return core.between(received, 0.0).notes.lines();
  };
  ActivityFolders::Reload updates;
  Schema wave = *built_in().find("stop");
  wave.name = "wave";
  wave.source = "wave.act";
  updates.taken = {wave};
  updates.errors = {"other.act:1:2: expected a name"};
  updates.warnings = {"wave.act:3: it is odd"};
  using Lines = std::vector<Note>;
  EXPECT_EQ(look(updates), (Lines{{Note::Level::error, "other.act:1:2: expected a name"},
                                  {Note::Level::warning, "wave.act:3: it is odd"},
                                  {Note::Level::info, "took wave of wave.act"}}));
  EXPECT_NE(core.executor().registry().find("wave"), nullptr);
  updates = {};
  updates.removed = {"wave"};
  EXPECT_EQ(look(updates), (Lines{{Note::Level::info, "wave is gone: no file gives it any more"}}));
  EXPECT_EQ(core.executor().registry().find("wave"), nullptr);
}

TEST_F(CoreTest, AStepFromRememberedGoalsGoesOnAsTheCoreBeforeIt) {
  Memory memory;
  const auto remember = [&](const GoalUpdates& updates) {
    memory.endings.insert(memory.endings.end(), updates.endings.begin(), updates.endings.end());
    if (updates.work)
      memory.work = *updates.work;
  };
  Core before(remembering({}));
  inputs.received.goals = {written(1, kKaren), written(2, kKaren)};
  remember(step(before).intended.updates);
  inputs.received.goals = {written(1, kKaren)};
  inputs.received.goals[0].event.kind = GoalEvent::Kind::kDisposed;
  remember(step(before).intended.updates);
  ASSERT_TRUE(ended(state(1)));
  for (int i = 0; i < 3; ++i)
    remember(step(before).intended.updates);
  const Core::Outputs newest = step(before);
  remember(newest.intended.updates);
  ASSERT_FALSE(newest.intended.behaviors.empty());

  // The requesters' goals are latched: both come again. The link continues as well.
  Core next(remembering(memory));
  statuses.clear();
  is_new = true;
  inputs.received.goals = {written(1, kKaren), written(2, kKaren)};
  Core::Outputs outputs = step(next);
  for (int i = 0; i < 3 && outputs.intended.behaviors.empty(); ++i)
    outputs = step(next);
  EXPECT_TRUE(ended(state(1))) << "it is not done twice";
  EXPECT_EQ(state(2), v1::GOAL_UNDERWAY);
  ASSERT_EQ(outputs.intended.behaviors.size(), newest.intended.behaviors.size());
  for (std::size_t i = 0; i < outputs.intended.behaviors.size(); ++i)
    EXPECT_EQ(outputs.intended.behaviors[i].parameters, newest.intended.behaviors[i].parameters);
}

TEST_F(CoreTest, AGoalThatIsKeptOverARestartIsStillItsOwners) {
  Memory memory;
  Core before(remembering({}));
  const auto of = [](const Core::Writer& writer, const Identity& person) {
    Core::Received::Goal goal = written(1, writer);
    goal.event.goal.writer_lost = v1::WRITER_LOST_KEEP;
    goal.person = person;
    return goal;
  };
  const auto withdraw = [&](Core& core, const Identity& person) {
    inputs.received.goals = {of(kJohn, person)};
    inputs.received.goals[0].event.kind = GoalEvent::Kind::kDisposed;
    step(core);
  };
  inputs.received.goals = {of(kKaren, {"karen", "agent"})};
  for (int i = 0; i < 3; ++i)
    if (const auto& work = step(before).intended.updates.work)
      memory.work = *work;
  for (const Identity& who : {Identity{"karen", "agent"}, Identity{"anna", "operator"}}) {
    Core next(remembering(memory));
    statuses.clear();
    is_new = true;
    for (int i = 0; i < 31; ++i)
      step(next);
    ASSERT_EQ(state(1), v1::GOAL_UNDERWAY);
    withdraw(next, {"john", "agent"});
    EXPECT_EQ(state(1), v1::GOAL_UNDERWAY);
    withdraw(next, who);
    EXPECT_EQ(state(1), v1::GOAL_CANCELED) << who.name;
  }
}

TEST_F(CoreTest, IsDegradedWhileNotAllIsSaved) {
  Core core(settings());
  step(core);
  core.know_saved({}, "the disk is full");
  const Core::Outputs outputs = step(core);
  EXPECT_EQ(outputs.degraded, "the disk is full; a restart may do finished work again");
  EXPECT_EQ(outputs.notes.lines(), (std::vector<Note>{{Note::Level::warning, outputs.degraded}}));
  EXPECT_TRUE(step(core).notes.lines().empty()) << "it is told once";
  core.know_saved({}, "");
  EXPECT_EQ(step(core).degraded, "");
}

TEST_F(CoreTest, TheSameInputsGiveTheSameOutputs) {
  Core one(settings());
  Core other(settings());
  for (int i = 1; i < 60; ++i) {
    inputs.robot.pose_in_odom.x = 0.03 * i;
    if (i % 7 == 1)
      inputs.received.goals = {written(static_cast<std::uint64_t>(i), i % 2 == 0 ? kKaren : kJohn)};
    if (i == 20)
      inputs.received.lost_requesters = {kKaren};
    if (i == 30)
      inputs.received.grants = {{true, "button"}, {false, ""}};
    if (i == 40) {
      ++inputs.robot.odom;
      inputs.new_frame = true;
    }
    const Core::Inputs same = inputs;
    const Core::Outputs a = step(one);
    inputs = same;
    const Core::Outputs b = step(other);
    EXPECT_EQ(a.intended.behaviors, b.intended.behaviors) << i;
    EXPECT_EQ(a.intended.updates.changed, b.intended.updates.changed) << i;
    EXPECT_EQ(a.intended.updates.endings, b.intended.updates.endings) << i;
    EXPECT_EQ(a.notes.lines(), b.notes.lines()) << i;
  }
  EXPECT_FALSE(statuses.empty());
}

}  // namespace
}  // namespace saphira::intentions
