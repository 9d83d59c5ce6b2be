#include "ping.hpp"

#include <stdexcept>

#include "support/quantile.hpp"

namespace saphira::bench {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

bus::NodeOptions ping_options(const std::string& program, const std::string& security) {
  bus::NodeOptions options;
  options.name = program;
  options.program = program;
  options.robot = security == bus::kOpenBus ? "open" : "secured";
  options.domain = kDomain;
  options.security = security;
  return options;
}

void echo(const std::string& security) {
  bus::Node node(ping_options("bridge", security));
  auto commands = node.reader(bus::topics::kDriveTeleop);
  auto states = node.writer(bus::topics::kRobotState);
  v1::RobotState state;
  for (;;) {
    node.wait(milliseconds(1000));
    commands.visit([&](const v1::MotorCommand& command, const bus::SampleInfo&) {
      state.stamp.cycle = command.number;
      states.write(state);
    });
  }
}

RoundTrip::RoundTrip(const std::string& security)
    : node_(ping_options("bench", security)),
      commands_(node_.writer(bus::topics::kDriveTeleop)),
      states_(node_.reader(bus::topics::kRobotState)) {
  const auto end = Clock::now() + std::chrono::seconds(30);
  while (!ping(milliseconds(50)))
    if (Clock::now() > end)
      throw std::runtime_error("no answer over the bus with security " + security);
}

void RoundTrip::measure() {
  if (const auto time = ping(milliseconds(500)))
    times_.push_back(*time);
}

double RoundTrip::quantile(double share) const {
  return test::quantile(times_, share);
}

std::optional<double> RoundTrip::ping(milliseconds limit) {
  v1::MotorCommand command{.number = ++number_};
  const auto began = Clock::now();
  commands_.write(command);
  while (Clock::now() - began < limit) {
    node_.wait(limit);
    bool answered = false;
    states_.visit([&](const v1::RobotState& state, const bus::SampleInfo&) {
      answered = answered || state.stamp.cycle == number_;
    });
    if (answered)
      return std::chrono::duration<double, std::micro>(Clock::now() - began).count();
  }
  return std::nullopt;
}

}  // namespace saphira::bench
