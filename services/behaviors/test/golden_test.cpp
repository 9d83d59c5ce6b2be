#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "pioneer.hpp"
#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/behaviors/folder.hpp"

// The output of each shipped behavior in a scripted world, cycle by cycle, compared with
// test/golden. A change there must be intended: SAPHIRA_GOLDEN=renew rewrites the files.
namespace saphira::behaviors {
namespace {

constexpr int kCycles = 60;

/// The robot drives ahead in a long bow; an obstacle comes near on its right, then ahead, and
/// leaves again.
Inputs scripted(int step) {
  Inputs inputs;
  inputs.cycle = static_cast<std::uint64_t>(step + 1);
  const double t = 0.1 * step;
  inputs.robot.pose_in_odom = {0.25 * t, 0.1 * std::sin(t), 0.3 * std::sin(0.8 * t)};
  inputs.robot.velocity = 0.25;
  for (int i = 0; i < 7; ++i) {
    double range = 3.0;
    if (step >= 15 && step < 45)
      range = i >= 3 ? 2.0 - 0.055 * (step - 15) : 2.5;
    if (step >= 30 && step < 45)
      range = i >= 1 && i <= 5 ? std::min(range, 0.9 - 0.05 * (step - 30)) : range;
    inputs.sonars.push_back({i, std::max(range, 0.15), range < 2.9});
  }
  return inputs;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", std::abs(value) < 0.0005 ? 0.0 : value);
  return text;
}

std::string trace(const Registry& registry, const Schema& schema) {
  Intended intended{"it", schema.name, 0, true, {}};
  // Points that make each behavior active: ahead and to the left.
  for (const ParameterSpec& spec : schema.parameters)
    if (spec.kind == Kind::point)
      intended.parameters.push_back(
          {spec.name, PlacedPoint{{spec.name == "goal" || spec.name == "goal_pt" ? 2.0 : 1.0, 0.3,
                                   spec.name == "door" ? kPi : 0.2},
                                  Frame::odom}});
    else if (spec.required)
      intended.parameters.push_back({spec.name, 300.0});
  Intent intent{0, true, {intended, {"wish", "GoToPos", 5, true, {}}}};
  intent.behaviors[1].parameters = {{"goal", PlacedPoint{{4.0, 1.0, 0.0}, Frame::odom}}};
  Executive executive(registry, pioneer());
  std::string out = "# cycle: turn speed goal progress; rule strength value ...\n";
  for (int step = 0; step < kCycles; ++step) {
    Inputs inputs = scripted(step);
    inputs.intent = &intent;
    intent.cycle = inputs.cycle;
    const Output output = executive.step(inputs);
    EXPECT_EQ(output.trouble, "");
    const Evaluation& evaluation = output.behaviors[0].blended.evaluation;
    const Activity& a = evaluation.activity;
    out += std::to_string(inputs.cycle) + ": " + number(a.turn) + " " + number(a.speed) + " " +
           number(a.goal) + " " + number(a.progress);
    for (const Rule& rule : evaluation.rules)
      if (rule.strength > 0.0)
        out += "; " + rule.name + " " + number(rule.strength) + " " + number(rule.value);
    out += "\n";
  }
  return out;
}

TEST(Golden, EachBehaviorDoesWhatItDid) {
  const char* const wanted = std::getenv("SAPHIRA_GOLDEN");
  const bool renew = wanted != nullptr && std::string(wanted) == "renew";
  const Registry registry = load_behaviors(test::source("config/behaviors"));
  ASSERT_GE(registry.names().size(), 11U);
  for (const std::string& name : registry.names()) {
    const std::string path = test::source("services/behaviors/test/golden/" + name + ".txt");
    const std::string now = trace(registry, *registry.find(name));
    if (renew) {
      std::ofstream(path) << now;
      continue;
    }
    std::string stored;
    ASSERT_NO_THROW(stored = read_file(path));
    EXPECT_EQ(now, stored) << name << ": SAPHIRA_GOLDEN=renew writes test/golden anew";
  }
}

}  // namespace
}  // namespace saphira::behaviors
