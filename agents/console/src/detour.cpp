#include "saphira/console/detour.hpp"

namespace saphira::console {

namespace {

constexpr std::uint64_t kOldCycles = 4;   // there and back
constexpr std::uint64_t kCutCycles = 30;  // what is sent now would only queue up
constexpr double kDetour = 10.0;          // [s] after an old cycle

}  // namespace

void Detour::shows(std::uint64_t cycle, std::uint64_t newest, double now) {
  const std::uint64_t behind = newest > cycle ? newest - cycle : 0;
  cut_ = behind > kCutCycles;
  if (behind >= kOldCycles)
    late_ = now;
}

bool Detour::wanted(double now) const {
  return !cut_ && now < late_ + kDetour;
}

}  // namespace saphira::console
