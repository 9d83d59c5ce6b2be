#pragma once

#include <string>

#include "saphira/authority/arbiter.hpp"

namespace saphira::authority::test {

inline WriterId writer(int n) {
  WriterId id{};
  id[0] = static_cast<std::uint8_t>(n);
  return id;
}

/// A connected arbiter with a clock and numbered writers.
struct Scene {
  Arbiter arbiter;
  double now = 10.0;
  std::uint64_t cycle = 100;
  std::uint64_t number = 0;

  explicit Scene(Settings settings = {}) : arbiter(settings) { arbiter.connect(1); }
  Command command(Role role, int who, bool active = true) {
    Command c;
    c.role = role;
    c.writer = writer(who);
    c.source = std::string(name(role)) + std::to_string(who);
    c.epoch = 1;
    c.cycle = cycle;
    c.number = ++number;
    c.active = active;
    c.received = now;
    return c;
  }
  bool offer(Role role, int who, bool active = true) {
    return arbiter.offer(command(role, who, active), cycle);
  }
  void hand_back(int who) {
    Command c = command(Role::teleop, who, false);
    c.hand_back = true;
    arbiter.offer(c, cycle);
  }
  void wait(int cycles) {
    now += 0.1 * cycles;
    cycle += static_cast<std::uint64_t>(cycles);
  }
  Grant grant() { return arbiter.decide(now, cycle); }
  Role driver() { return grant().role; }
};

}  // namespace saphira::authority::test
