#include <gtest/gtest.h>

#include <set>

#include "language_bench.hpp"
#include "saphira/base/random.hpp"

// Random schemas in random worlds: properties that always hold.

namespace saphira::intentions {
namespace {

constexpr int kSchemas = 6;

const char* pick(Random& random, std::initializer_list<const char*> words) {
  return *(words.begin() + random.next() % words.size());
}

std::string condition(Random& random) {
  return pick(random, {"*a*", "*b*", "stalled", "(not *a*)", "(and *a* *b*)", "(> (elapsed) 1.5)",
                       "(equal (state 'n1) 'success)", "(> (level 'n2) 0.5)", "t", "nil", "(> n 3)",
                       "(> x 1)"});
}

std::string goal(Random& random, int depth, int labels);

std::string goals(Random& random, int depth, int labels) {
  std::string text;
  const std::uint32_t count = 1 + random.next() % 2;
  for (std::uint32_t i = 0; i < count; ++i)
    text += " " + goal(random, depth, labels);
  return text;
}

std::string intend(Random& random, int depth, int labels) {
  std::string text = "(INTEND ";
  if (random.chance(0.5))
    text += std::string(":") + pick(random, {"Follow", "GoToPos", "Stop"}) +
            (random.chance(0.5) ? " ((goal . (point n 1)))" : " ()");
  else
    text += ":s" + std::to_string(random.next() % kSchemas) +
            (random.chance(0.5) ? " ((n . (+ n 1)))" : " ()");
  text += std::string(" :blocking ") + pick(random, {"t", "t", "nil", "0.3", "0.7"});
  if (random.chance(0.5))
    text += std::string(" :name ") + pick(random, {"n1", "n2", "n3"});
  if (random.chance(0.5))
    text += std::string(" :timeout ") + pick(random, {"0.3s", "1s", "3s"});
  if (random.chance(0.2))
    text += " :priority " + std::to_string(random.next() % 5);
  if (random.chance(0.4) && depth > 0)
    text += " :else " + goal(random, depth - 1, labels);
  return text + ")";
}

std::string goal(Random& random, int depth, int labels) {
  const std::string test = condition(random);
  switch (random.next() % (depth > 0 ? 14 : 8)) {
    case 0:
      return "(TEST " + test + (random.chance(0.8) ? " :else (= x 1)" : "") + ")";
    case 1:
      return std::string("(EXECUTE (setq ") + pick(random, {"*a*", "*b*"}) + " " + test + "))";
    case 2:
      return "(= x (+ n 1))";
    case 3:
      return "(WAIT-FOR " + test + " :timeout " + pick(random, {"0.2s", "1s", "5s"}) +
             (random.chance(0.8) ? " :else (= x 2)" : "") + ")";
    case 4:
    case 5:
    case 6:
      return intend(random, depth, labels);
    case 7:
      return std::string("(UNINTEND '") + pick(random, {"n1", "n2", "n3"}) + ")";
    case 8:
      return "(IF " + test + " (GOTO :l" + std::to_string(random.next() % labels) + "))";
    case 9:
      return "(IF " + test + " " + goal(random, depth - 1, labels) + " " +
             goal(random, depth - 1, labels) + ")";
    case 10:
      return "(AND" + goals(random, depth - 1, labels) + goals(random, depth - 1, labels) + ")";
    case 11:
      return "(SPLIT" + goals(random, depth - 1, labels) + ")";
    case 12:
      return "(PRESERVE " + test + goals(random, depth - 1, labels) +
             (random.chance(0.7) ? " :else (= x 3)" : "") + ")";
    default:
      return "(MAINTAIN " + test + " :by " + goal(random, depth - 1, labels) +
             goals(random, depth - 1, labels) + (random.chance(0.7) ? " :else (= x 4)" : "") + ")";
  }
}

std::string schemas(Random& random) {
  std::string text;
  for (int i = 0; i < kSchemas; ++i) {
    const int labels = 2 + static_cast<int>(random.next() % 4);
    text += "(defintention :s" + std::to_string(i) + " :params ((n 0))";
    if (random.chance(0.3))
      text += " :timeout 4s";
    if (random.chance(0.3))
      text += " :priority " + std::to_string(random.next() % 3);
    if (random.chance(0.2))
      text += " :concurrent t";
    text += "\n :goals '((= x 0)\n";
    for (int l = 0; l < labels; ++l)
      text += "  (:l" + std::to_string(l) + goals(random, 3, labels) + ")\n";
    text += "))\n";
  }
  return text;
}

/// Properties of the executor's output that hold after every cycle.
void check(const Stage& stage, std::size_t most) {
  std::map<std::uint32_t, const IntentionNode*> nodes;
  for (const IntentionNode& node : stage.out.nodes) {
    ASSERT_TRUE(nodes.emplace(node.id, &node).second);
    if (node.parent == 0)
      continue;
    ASSERT_TRUE(nodes.contains(node.parent)) << "an intention without a parent";
    ASSERT_FALSE(finished(nodes[node.parent]->state)) << "its parent has ended";
    ASSERT_EQ(nodes[node.parent]->goal, node.goal);
  }
  ASSERT_LE(nodes.size(), most);
  std::set<std::string> names;
  for (const IntendedBehavior& behavior : stage.out.behaviors) {
    ASSERT_TRUE(names.insert(behavior.name).second);
    ASSERT_TRUE(nodes.contains(behavior.intention));
    for (std::uint32_t id = behavior.intention; id != 0; id = nodes[id]->parent) {
      ASSERT_NE(nodes[id]->state, IntentionState::kSuspended) << "it does not go on";
      ASSERT_FALSE(finished(nodes[id]->state));
    }
  }
}

TEST(RandomActivities, NeverLoseAParentAndLeaveNothingBehind) {
  std::size_t most_seen = 0;
  std::map<GoalState, int> ends;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const std::string text = schemas(random);
    Stage stage(text, core_functions(), 400, MayFail::kYes);
    // Some goals are unreachable, or a name is used twice: then there is nothing to run.
    if (!stage.loaded.ok())
      continue;
    std::uint64_t last = 0;
    for (int cycle = 0; cycle < 200; ++cycle) {
      if (random.chance(0.1))
        stage.ask(++last, "s" + std::to_string(random.next() % kSchemas), {},
                  static_cast<int>(random.next() % 3));
      if (random.chance(0.05) && last > 0)
        stage.dispose(1 + random.next() % last);
      if (random.chance(0.1))
        stage.inputs.claims.push_back(
            {random.chance(0.5) ? ClaimEvent::Kind::kSaid : ClaimEvent::Kind::kWithdrawn,
             {9, 1 + random.next() % 3},
             "chance",
             pick(random, {"*a*", "*b*"}),
             Value::truth(random.chance(0.5))});
      if (random.chance(0.1))
        stage.inputs.robot.left_stalled = !stage.inputs.robot.left_stalled;
      if (random.chance(0.02))
        stage.inputs.robot.connected = !stage.inputs.robot.connected;
      for (const char* const name : {"n1", "n2", "n3", "Follow", "GoToPos", "Stop"})
        stage.satisfy(name, random.uniform(0.0, 1.0));
      if (!stage.out.nodes.empty() && random.chance(0.1)) {
        const std::uint32_t id = stage.out.nodes[random.next() % stage.out.nodes.size()].id;
        if (random.chance(0.3))
          stage.executor->interrupt(id);
        else
          stage.executor->resume(id);
      }
      if (!stage.out.behaviors.empty() && random.chance(0.02))
        stage.inputs.troubles.push_back({stage.out.behaviors.front().name, "it is broken"});
      if (random.chance(0.02)) {
        const Loaded again = load_activities({{"test.act", schemas(random)}},
                                             *stage.options.functions, stage.executor->registry());
        for (const Schema& schema : again.schemas)
          stage.executor->registry().add(schema);
      }
      stage.step();
      check(stage, 400 + last);
      if (::testing::Test::HasFatalFailure()) {
        ADD_FAILURE() << "cycle " << cycle << "\n" << text;
        return;
      }
      most_seen = std::max(most_seen, stage.out.nodes.size());
    }
    stage.inputs.robot.connected = true;
    for (std::uint64_t id = 1; id <= last; ++id)
      stage.dispose(id);
    stage.step();
    ASSERT_TRUE(stage.out.nodes.empty()) << text;
    ASSERT_TRUE(stage.out.behaviors.empty());
    for (const auto& [id, status] : stage.statuses) {
      ASSERT_TRUE(ended(status.state));
      ASSERT_FALSE(status.reason.empty());
      ++ends[status.state];
    }
  }
  // The worlds are rich enough for activity.
  EXPECT_GT(most_seen, 50U);
  EXPECT_GT(ends[v1::GOAL_SUCCEEDED], 200);
  EXPECT_GT(ends[v1::GOAL_FAILED], 200);
}

}  // namespace
}  // namespace saphira::intentions
