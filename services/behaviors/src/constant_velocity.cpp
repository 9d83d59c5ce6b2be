#include "predefined.hpp"

namespace saphira::behaviors {
namespace {

class ConstantVelocity : public Behavior {
 public:
  Evaluation update(const Parameters& parameters, const Context& context) override {
    const double speed = parameters.number("speed");
    const double off = std::abs(context.robot.velocity - speed);
    return {{{"go", 1.0, Action::speed, speed}},
            {.speed = 1.0, .goal = down_straight(off, 0.02, 0.1)}};
  }
};

class Stop : public Behavior {
 public:
  Evaluation update(const Parameters& /*parameters*/, const Context& context) override {
    return {{{"stop", 1.0, Action::speed, 0.0}},
            {.speed = 1.0, .goal = down_straight(std::abs(context.robot.velocity), 0.01, 0.1)}};
  }
};

}  // namespace

Schema constant_velocity() {
  return {"ConstantVelocity",
          "goes at a speed",
          {number_parameter("speed", "m/s, negative backwards", -2.0, 2.0, 0.2)},
          [] { return std::make_unique<ConstantVelocity>(); }};
}

Schema stop() {
  return {"Stop", "sets the speed to zero", {}, [] { return std::make_unique<Stop>(); }};
}

}  // namespace saphira::behaviors
