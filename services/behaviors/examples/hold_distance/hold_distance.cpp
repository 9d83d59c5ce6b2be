// A plug-in: a behavior in C++ that saphira-behaviors --plugin FILE loads. It keeps a distance from
// the obstacle ahead, to and fro; intended below AvoidCollision, it follows a person who walks
// away.

#include <cmath>

#include "saphira/behaviors/plugin.hpp"

namespace {

using namespace saphira;
using namespace saphira::behaviors;

class HoldDistance : public Behavior {
 public:
  Evaluation update(const Parameters& parameters, const Context& context) override {
    const double wanted = parameters.number("distance");
    const double most = parameters.number("speed");
    // From the robot's centre to the nearest reading of the front sonars, as wide as the robot.
    const double half = context.model.radius;
    const lps::Occupancy ahead =
        context.lps.plane(lps::Direction::front, lps::Source::front, 0.0, half, half);
    const double off = ahead.distance - context.model.radius - wanted;
    const Fuzzy too_far = straight_up(off, 0.0, 0.5);
    const Fuzzy too_near = straight_up(-off, 0.0, 0.5);
    Evaluation evaluation;
    evaluation.rules = {
        {"too far", too_far, Action::speed, most},
        {"too near", too_near, Action::speed, -most},
        {"just right", f_not(f_or(too_far, too_near)), Action::speed, 0.0},
    };
    // Without an obstacle ahead there is nobody to follow.
    evaluation.activity.speed = ahead.point ? 1.0 : 0.0;
    evaluation.activity.goal = ahead.point ? down_straight(std::abs(off), 0.1, 0.3) : 0.0;
    evaluation.variables = {{"too_far", too_far}, {"too_near", too_near}};
    return evaluation;
  }
};

}  // namespace

extern "C" {

// NOLINTNEXTLINE(readability-identifier-naming): the name belongs to the interface
const int saphira_behaviors_plugin = kPluginVersion;

void saphira_register_behaviors(Registry& registry) {
  Schema schema;
  schema.name = "HoldDistance";
  schema.summary = "keeps a distance from an obstacle ahead";
  schema.parameters = {number_parameter("distance", "m, from the hull", 0.2, 3.0, 0.8),
                       number_parameter("speed", "m/s, at most", 0.0, 1.0, 0.2)};
  schema.rules = {{"too far", "too_far", "Speed speed"},
                  {"too near", "too_near", "Speed -speed"},
                  {"just right", "Not (too_far Or too_near)", "Speed 0"}};
  schema.make = [] { return std::make_unique<HoldDistance>(); };
  registry.add(std::move(schema));
}
}
