// The arbiter: the cases of drivers.txt.
#include <gtest/gtest.h>

#include "lines.hpp"
#include "saphira/authority/arbiter.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"

namespace saphira::authority {
namespace {

WriterId writer(int n) {
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
  void wait(int cycles) {
    now += 0.1 * cycles;
    cycle += static_cast<std::uint64_t>(cycles);
  }
  Grant grant() { return arbiter.decide(now, cycle); }
  Role driver() { return grant().role; }
};

Role role_of(const std::string& word) {
  const auto* const found =
      std::ranges::find_if(kRoles, [&](Role role) { return word == name(role); });
  return found == kRoles.end() ? throw std::invalid_argument("no role: " + word) : *found;
}

/// One case.
class Drivers : public saphira::test::LinePlayer {
 public:
  Drivers() {
    events_ = {
      ON("anew", s_ = Scene()),
      ON("quiet", s_ = Scene({.quiet = read<double>(in)})),
      ON("wait", s_.wait(read<int>(in))),
      ON("pass", s_.now += read<double>(in)),
      ON("look", s_.driver()),
      ON("connect", s_.arbiter.connect(read<std::uint64_t>(in))),
      ON("cycle", s_.cycle = read<std::uint64_t>(in)),
      ON("deaf", deaf(in)),
      ON("lost", const Role role = role_of(read<std::string>(in));
         s_.arbiter.lost(role, writer(read<int>(in)), s_.now)),
      {"restart",
       [this](auto&) {
         const Latches latches = s_.arbiter.latches();
         s_ = Scene();
         s_.arbiter.restore(latches);
       }},
      ON("late", late_ = command(in)),
      ON("comes", offer(late_, true))
    };
    for (const Role role : kRoles)
      events_[name(role)] = [this, role](auto& in) {
        std::istringstream whole(name(role) + (" " + rest(in)));
        const Command given = command(whole);
        offer(given, !refused_);
      };
    facts_ = {IS("drives", drives()),
              IS("because", grant_.reason),
              IS("expires", format("%g", grant_.expires_in)),
              IS("age", format("%g", grant_.command_age)),
              IS("pressed by", grant_.estop_source),
              IS("stop", std::to_string(grant_.stop.number)),
              IS("stopped by", grant_.stop_source),
              IS("refusals", refusals()),
              IS("reset", s_.arbiter.reset("keyboard", s_.now))};
    for (std::uint64_t id = 1; id <= 3; ++id)
      facts_["stop " + std::to_string(id)] = [this, id] {
        return joined(s_.arbiter.stop({7, id}, "a person", s_.now, s_.cycle));
      };
  }

 private:
  /// "ROLE WRITER released hands-back again blind cycle=-1 epoch=2 number=3 heeds heeds=1 refused".
  Command command(std::istringstream& in) {
    const Role role = role_of(read<std::string>(in));
    Command made = s_.command(role, read<int>(in));
    refused_ = false;
    for (std::string word; in >> word;) {
      const std::string value = word.substr(std::min(word.find('='), word.size() - 1) + 1);
      const std::uint64_t number = value.empty() ? 0 : std::stoull(value);
      if (word == "released" || word == "hands-back") {
        made.active = false;
        made.hand_back = word == "hands-back";
      } else if (word == "again") {
        made.number = --s_.number;
      } else if (word == "blind") {
        made.epoch = made.cycle = 0;
      } else if (word == "heeds") {  // the newest stop
        made.heeds = s_.grant().stop;
      } else if (word == "refused") {
        refused_ = true;
      } else if (word.starts_with("cycle=")) {
        const bool relative = value[0] == '+' || value[0] == '-';
        made.cycle = relative ? made.cycle + number : number;
      } else if (word.starts_with("epoch=")) {
        made.epoch = number;
      } else if (word.starts_with("number=")) {
        made.number = number;
      } else if (word.starts_with("heeds=")) {
        made.heeds = {7, number};
      } else {
        throw std::invalid_argument("not understood: " + word);
      }
    }
    return made;
  }
  void offer(Command given, bool accepted) {
    given.received = s_.now;
    EXPECT_EQ(s_.arbiter.offer(given, s_.cycle), accepted) << given.source;
  }
  /// "deaf SECONDS [CYCLES]", from now on, and to cycles before the present one.
  void deaf(std::istringstream& in) {
    const auto seconds = read<double>(in);
    std::uint64_t before = 0;
    in >> before;
    s_.arbiter.forget(s_.cycle - before, s_.now + seconds);
  }
  std::string drives() {
    grant_ = s_.grant();
    EXPECT_EQ(grant_.estopped, grant_.role == Role::estop);
    return (grant_.role == Role::none || grant_.role == Role::estop ? name(grant_.role)
                                                                    : grant_.source) +
           (grant_.waits_for_hand_back ? std::string(", waits") : "");
  }
  std::string refusals() {
    return joined(s_.arbiter.take_refused(), " | ",
                  [](const Refusal& each) { return each.source + ", " + each.reason; });
  }

  Scene s_;
  Grant grant_;  // of the newest "drives"
  Command late_;
  bool refused_ = false;  // the newest command is to be
};

TEST(Drivers, AreAsWritten) {
  EXPECT_EQ(saphira::test::play<Drivers>("bridge/authority/test/drivers.txt"), 63);
}

TEST(Arbiter, ThreeCyclesAreWithinALeaseOfThreeCycles) {
  for (int start = 0; start < 1000; ++start) {
    Scene s;
    s.now = 0.1 * start;
    s.offer(Role::behaviors, 1);
    s.now = 0.1 * (start + 3);
    ASSERT_EQ(s.driver(), Role::behaviors) << start;
    s.now = 0.1 * (start + 4);
    ASSERT_EQ(s.driver(), Role::none) << start;
  }
}

TEST(Arbiter, WhoHasNotBeenHeardForLongestIsForgotten) {
  Scene s;
  const Command first = s.command(Role::teleop, 1);
  s.arbiter.offer(first, s.cycle);
  for (int i = 0; i < 2000; ++i) {
    Command other = s.command(Role::behaviors, 2);
    other.writer[1] = static_cast<std::uint8_t>(i % 256);
    other.writer[2] = static_cast<std::uint8_t>(i / 256);
    s.arbiter.offer(other, s.cycle);
    if (i < 1200)
      s.offer(Role::teleop, 1);
  }
  EXPECT_FALSE(s.arbiter.offer(first, s.cycle)) << "an old command again";
}

TEST(Arbiter, RefusalsAreToldOnceAndBounded) {
  Scene s;
  s.offer(Role::direct, 0);
  for (int i = 1; i < 100; ++i) {
    s.offer(Role::direct, i % 50 + 1);
    s.offer(Role::direct, i % 50 + 1);
  }
  EXPECT_EQ(s.arbiter.take_refused().size(), 16U);
  EXPECT_EQ(s.arbiter.take_refused().size(), 0U);
  EXPECT_EQ(s.arbiter.refused_count(), 198U);
}

}  // namespace
}  // namespace saphira::authority
