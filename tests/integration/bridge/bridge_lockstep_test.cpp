// Single step: the bridge steps the simulator when the driver has answered the cycle and the permit
// covers it; the run is the same every time, and as fast as the machine allows.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>

#include "saphira/base/text.hpp"
#include "scene.hpp"

namespace saphira::test {
namespace {

constexpr std::uint64_t kCycles = 300;

/// Drives a figure by the cycle's number alone; returns the trace of the run.
std::string run(std::uint64_t cycles, double* seconds) {
  Scene scene(true);
  scene.start_simulator();
  scene.start_bridge();
  EXPECT_TRUE(scene.until([&] { return scene.description.has_value(); }));
  EXPECT_TRUE(scene.description->lockstep());
  scene.watch(std::chrono::milliseconds(300));
  EXPECT_EQ(scene.state.stamp().cycle(), 0U) << "no permit, no step";

  const auto begin = std::chrono::steady_clock::now();
  scene.permit(cycles);
  const bool done = scene.until(
      [&] {
        const std::uint64_t cycle = scene.state.stamp().cycle();
        const double phase = 0.05 * static_cast<double>(cycle);
        scene.command.active(cycle % 50 < 45);
        scene.command.translation(v1::TRANSLATION_VELOCITY);
        scene.command.velocity(0.2 + 0.1 * std::sin(phase));
        scene.command.rotation(v1::ROTATION_HEADING);
        scene.command.heading(std::sin(0.3 * phase));
        return cycle == cycles;
      },
      std::chrono::seconds(60));
  EXPECT_TRUE(done) << "stuck at cycle " << scene.state.stamp().cycle() << "\n"
                    << scene.bridge_log();
  *seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  // Without a permit nothing moves.
  scene.watch(std::chrono::milliseconds(300));
  EXPECT_EQ(scene.state.stamp().cycle(), cycles);
  scene.bridge->signal(SIGTERM);
  EXPECT_EQ(scene.bridge->wait(), 0);
  scene.simulator->signal(SIGTERM);
  EXPECT_EQ(scene.simulator->wait(), 0);
  return read_file(scene.folder.path("trace.csv"));
}

TEST(BridgeLockstep, IsTheSameEveryTime) {
  double seconds = 0.0;
  const std::string first = run(kCycles, &seconds);
  std::printf("%.0f times real time\n", static_cast<double>(kCycles) * 0.1 / seconds);
  const std::string second = run(kCycles, &seconds);
  EXPECT_EQ(first, second);
  EXPECT_NE(first.find("\n300,"), std::string::npos);
}

}  // namespace
}  // namespace saphira::test
