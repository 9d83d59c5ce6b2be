// The CPU time of behaviors: a thousand of them.

#include <ctime>
#include <stdexcept>

#include "behaviors/test/pioneer.hpp"
#include "executive_bench.hpp"
#include "saphira/base/random.hpp"
#include "saphira/behaviors/language.hpp"

namespace saphira::bench {
namespace {

using namespace behaviors;

/// The CPU time of this process [s]; other processes on the machine do not count.
double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Random readings of the seven sonars, as in a cluttered room.
std::vector<lps::SonarReading> readings(Random& random) {
  std::vector<lps::SonarReading> out;
  for (int i = 0; i < 7; ++i)
    out.push_back({i, random.uniform(0.5, 2.0), true});
  return out;
}

Argument place(double x, double y) {
  return {"goal", PlacedPoint{{x, y, 0.0}, Frame::odom}};
}

const char* const kFiveRules = R"(
BeginBehavior Load
  Params
    sfPTR goal
    sfFLOAT speed = 300 from 0 to 2000 mm/s
  Rules
    too_right  If goal_left And Not at_goal Then Turn Left turn
    too_left   If Not goal_left And Not at_goal Then Turn Right turn
    on_course  If Not (off_course Or ahead) Then Speed speed
    off_course If off_course Then Speed 0.0
    near       If ahead Then Speed slow
  Init
    int cycles = 0;
  Update
    float phi = sfPointPhi(goal);
    float dist = sfPointDist(goal);
    cycles += 1;
    at_goal = straight_down(dist, 100, 200);
    off_course = straight_up(fabs(phi), 0.3, 1.0);
    ahead = straight_down(sfOccPlane(sfFRONT, sfFRONT, 0, 300, 300), 500, 1000);
    goal_left = phi > 0;
    float turn = min(fabs(phi), 0.7);
    float slow = cycles < 10 ? 50 : 100;
  Activity
    Turn Not at_goal
    Speed Not at_goal
    Goal at_goal
EndBehavior
)";

/// [ms] of CPU a step, of `count` behaviors with five rules each. One parameter of each changes
/// every cycle, as with points of the map.
double step_ms(std::size_t count, int steps) {
  Compiled compiled = compile(kFiveRules, "load.beh");
  if (!compiled.errors.empty())
    throw compiled.errors.front();
  Registry registry;
  registry.add(std::move(compiled.schemas.front()));
  Executive executive(std::move(registry), pioneer());
  Random random(1);
  Intent intent{0, true, {}};
  for (std::size_t i = 0; i < count; ++i)
    intent.behaviors.push_back({"behavior " + std::to_string(i),
                                "Load",
                                static_cast<int>(i % 10),
                                true,
                                {place(0.0, 0.0), {"speed", 0.2}}});
  double begin = 0.0;
  for (int step = -5; step < steps; ++step) {
    if (step == 0)
      begin = cpu_seconds();
    Inputs inputs;
    inputs.cycle = static_cast<std::uint64_t>(step + 10);
    inputs.robot.pose_in_odom = {0.03 * step, 0.0, 0.01 * step};
    inputs.sonars = readings(random);
    intent.cycle = inputs.cycle;
    for (std::size_t i = 0; i < count; ++i)
      intent.behaviors[i].parameters[0] = place(5.0 + static_cast<double>(i % 100), 0.001 * step);
    inputs.intent = &intent;
    const Output output = executive.step(inputs);
    if (output.behaviors.size() != count || !output.trouble.empty())
      throw std::logic_error("the behaviors do not run: " + output.trouble);
  }
  return (cpu_seconds() - begin) * 1000.0 / steps;
}

}  // namespace

double behaviors_1000_ms() {
  return step_ms(1000, 100);
}

double behaviors_10_ms() {
  return step_ms(10, 2000);
}

}  // namespace saphira::bench
