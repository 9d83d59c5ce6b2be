#include "saphira/bus/cycle.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <set>
#include <utility>

namespace saphira::bus {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kIdle = std::chrono::milliseconds(500);
// No more often than this does a node that has nothing to step look around.
constexpr auto kSpin = std::chrono::microseconds(200);
constexpr auto kLook = std::chrono::milliseconds(5);
// Seconds without a step before the status says what is waited for.
constexpr double kQuietLive = 0.5;
constexpr double kQuietLockstep = 2.0;
// A step that was late shows in the state for so many steps.
constexpr std::uint64_t kDegradedSteps = 10;
// RobotStates that wait: more than a bridge in lockstep can be ahead.
constexpr std::size_t kPending = 32;
constexpr std::uint64_t kAny = std::numeric_limits<std::uint64_t>::max();

double since(Clock::time_point time) {
  return std::chrono::duration<double>(Clock::now() - time).count();
}

}  // namespace

struct Cycle::Impl {
  explicit Impl(Node& the_node)
      : node(the_node),
        status(the_node.status()),
        lockstep(the_node.options().lockstep),
        robot(the_node.reader(topics::kRobotState)) {}

  bool left_before(std::uint64_t other) const { return left.contains(other); }

  void refuse(const char* topic, const v1::Stamp& stamp, const char* why) {
    ++status.refused_samples();
    trouble(std::string("refuses samples of ") + topic + " " + why);
    if (told.insert({topic, stamp.epoch()}).second)
      node.warn(std::string("refused a sample of ") + topic + ", epoch " +
                std::to_string(stamp.epoch()) + " cycle " + std::to_string(stamp.cycle()) + ", " +
                why);
  }

  void trouble(std::string text) {
    degraded = std::move(text);
    degraded_until = status.steps() + kDegradedSteps;
  }

  void adopt(std::uint64_t next_epoch) {
    if (epoch != 0) {
      left.insert(epoch);
      for (auto& slot : inputs)
        slot->forget(epoch);
    }
    epoch = next_epoch;
    last = 0;
    joining = true;
    fresh = true;
    pending.clear();
    node.info("epoch " + std::to_string(epoch));
  }

  void drain() {
    robot.visit([&](const v1::RobotState& state, const SampleInfo& info) {
      const v1::Stamp& stamp = state.stamp();
      if (info.disposed)
        return;
      if (stamp.epoch() == 0 || stamp.cycle() == 0)
        return refuse(topics::kRobotState.name, stamp, "without epoch or cycle");
      if (stamp.epoch() != epoch) {
        if (left_before(stamp.epoch()))
          return refuse(topics::kRobotState.name, stamp, "of an epoch that was left");
        adopt(stamp.epoch());
      }
      if (stamp.cycle() <= (pending.empty() ? last : pending.back().stamp().cycle()))
        return refuse(topics::kRobotState.name, stamp, "behind the newest one");
      if (pending.empty()) {
        waiting_since = Clock::now();
        quiet = false;
      }
      pending.push_back(state);
      if (pending.size() > kPending)
        pending.pop_front();
    });
    for (auto& slot : inputs)
      slot->drain([&](const v1::Stamp& stamp) {
        // An epoch that is not known yet is kept: its first RobotState may still be on the way.
        const bool good = stamp.epoch() != 0 && !left_before(stamp.epoch());
        if (!good)
          refuse(slot->name(), stamp,
                 stamp.epoch() == 0 ? "without epoch" : "of an epoch that was left");
        return good;
      });
  }

  // Live: the newest state, at once.
  std::optional<Step> due_live() {
    if (pending.empty())
      return {};
    Step step;
    step.robot = std::move(pending.back());
    pending.clear();
    const std::uint64_t cycle = step.robot.stamp().cycle();
    if (!joining && cycle > last + 1) {
      status.late_cycles() += cycle - last - 1;
      trouble("skipped a cycle");
    }
    for (auto& slot : inputs) {
      const std::uint64_t found = slot->newest(epoch, cycle - 1);
      slot->select(epoch, found);
      if (found + 1 == cycle)
        continue;
      step.stale = true;
      // Its writers may be starting as well: the first step blames nobody.
      if (!joining)
        trouble(std::string(found == 0 ? "runs without " : "runs on an old sample of ") +
                slot->name());
    }
    if (step.stale && !joining)
      ++status.late_cycles();
    return step;
  }

  enum class Inputs { here, missing, gone };

  Inputs inputs_for(std::uint64_t cycle) const {
    Inputs result = Inputs::here;
    for (const auto& slot : inputs) {
      if (cycle == 1 || slot->newest(epoch, cycle - 1) == cycle - 1)
        continue;
      // Samples of a writer come in order: one that is later says that this one will not come.
      if (slot->newest(epoch, kAny) >= cycle)
        return Inputs::gone;
      if (joining && quiet && slot->newest(epoch, kAny) == 0)
        continue;
      result = Inputs::missing;
    }
    return result;
  }

  // Lockstep: each state in its order, with every input.
  std::optional<Step> due_lockstep() {
    while (!pending.empty()) {
      const std::uint64_t cycle = pending.front().stamp().cycle();
      if (!joining && cycle > last + 1) {
        status.late_cycles() += cycle - last - 1;
        trouble("lost a state of the robot");
        node.warn("lockstep: no robot/state between cycles " + std::to_string(last) + " and " +
                  std::to_string(cycle));
        joining = true;
      }
      const Inputs ready = inputs_for(cycle);
      if (ready == Inputs::missing)
        return {};
      Step step;
      step.robot = std::move(pending.front());
      pending.pop_front();
      if (ready == Inputs::gone) {
        // Only who comes late into a running lockstep may pass a cycle over.
        if (!joining) {
          ++status.late_cycles();
          trouble("lost an input");
          node.warn("lockstep: an input for cycle " + std::to_string(cycle) + " will not come");
          joining = true;
        }
        continue;
      }
      for (auto& slot : inputs) {
        const bool there = cycle > 1 && slot->newest(epoch, cycle - 1) == cycle - 1;
        slot->select(epoch, there ? cycle - 1 : 0);
        step.stale |= cycle > 1 && !there;
      }
      if (step.stale)
        node.warn("lockstep: begins at cycle " + std::to_string(cycle) +
                  " without the inputs of the cycle before, which nobody has");
      return step;
    }
    return {};
  }

  // Who and what is waited for.
  std::string awaited() const {
    const auto nobody = [](std::size_t matched) {
      return matched == 0 ? ": nobody writes it" : "";
    };
    if (pending.empty())
      return std::string("waits for ") + topics::kRobotState.name +
             (last > 0 ? " of cycle " + std::to_string(last + 1) : "") + nobody(robot.matched());
    const std::uint64_t cycle = pending.front().stamp().cycle();
    for (const auto& slot : inputs)
      if (slot->newest(epoch, cycle - 1) + 1 != cycle)
        return std::string("waits for ") + slot->name() + " of cycle " + std::to_string(cycle - 1) +
               nobody(slot->matched());
    return "waits";
  }

  void note_waiting() {
    quiet = since(waiting_since) > (lockstep ? kQuietLockstep : kQuietLive);
    if (!quiet)
      return;
    status.state() = v1::SERVICE_WAITING;
    status.reason() = awaited();
  }

  void note_step(const Step& step) {
    status.stamp() = step.robot.stamp();
    ++status.steps();
    if (!degraded.empty() && status.steps() >= degraded_until)
      degraded.clear();
    status.state() = degraded.empty() ? v1::SERVICE_RUNNING : v1::SERVICE_DEGRADED;
    status.reason() = degraded;
  }

  void publish_status() {
    status.step_ms_mean() = timed > 0 ? total_ms / static_cast<double>(timed) : 0.0;
    status.step_ms_max() = max_ms;
    if (node.publish_status()) {
      timed = 0;
      total_ms = 0.0;
      max_ms = 0.0;
    }
  }

  Node& node;
  v1::ServiceStatus& status;
  const bool lockstep;
  Reader<v1::RobotState> robot;
  std::vector<std::unique_ptr<detail::InputSlot>> inputs;
  std::deque<v1::RobotState> pending;  // of this epoch, not yet stepped, in order
  std::uint64_t epoch = 0;
  std::uint64_t last = 0;  // cycle of this epoch that was stepped last
  bool joining = true;     // no step of this epoch yet
  bool fresh = true;       // the next step is the first of its epoch
  bool quiet = false;      // nothing was due for so long that it should be said
  std::set<std::uint64_t> left;
  std::set<std::pair<std::string, std::uint64_t>> told;
  std::string degraded;
  std::uint64_t degraded_until = 0;
  Clock::time_point waiting_since = Clock::now();
  Clock::time_point began;
  Clock::time_point looked;  // around, by a step or by `idle`
  std::uint64_t timed = 0;
  double total_ms = 0.0;
  double max_ms = 0.0;
};

Cycle::Cycle(Node& node) : node_(node), impl_(std::make_unique<Impl>(node)) {}
Cycle::~Cycle() = default;

void Cycle::add(std::unique_ptr<detail::InputSlot> slot) {
  impl_->inputs.push_back(std::move(slot));
}

std::optional<Step> Cycle::next(const Stop& stop, const std::function<void()>& idle) {
  Impl& self = *impl_;
  self.waiting_since = Clock::now();
  self.quiet = false;
  while (!stop.requested()) {
    if (self.lockstep)
      self.node.rouse();
    self.drain();
    auto step = self.lockstep ? self.due_lockstep() : self.due_live();
    if (step) {
      step->new_epoch = std::exchange(self.fresh, false);
      self.joining = false;
      self.last = step->robot.stamp().cycle();
      self.note_step(*step);
      self.began = Clock::now();
      return step;
    }
    if (self.lockstep && self.node.spin(kSpin)) {
      self.node.clear_wake();
      continue;
    }
    // Samples come one by one: who looks around after each of them does little else in lockstep.
    const auto rest =
        std::chrono::ceil<std::chrono::milliseconds>(self.looked + kLook - Clock::now());
    if (rest.count() > 0) {
      self.node.wait(rest, &stop);
      continue;
    }
    self.note_waiting();
    self.publish_status();
    if (idle)
      idle();
    self.looked = Clock::now();
    self.node.wait(kIdle, &stop);
  }
  return {};
}

void Cycle::done() {
  const double ms = 1e3 * since(impl_->began);
  ++impl_->timed;
  impl_->total_ms += ms;
  impl_->max_ms = std::max(impl_->max_ms, ms);
  // After the step, not before it: what it costs must not delay the robot.
  impl_->publish_status();
  impl_->looked = Clock::now();
}

bool Cycle::connected() const {
  return impl_->robot.matched() > 0 &&
         std::all_of(impl_->inputs.begin(), impl_->inputs.end(),
                     [](const auto& slot) { return slot->matched() > 0; });
}

const v1::Stamp& Cycle::stamp() const {
  return impl_->status.stamp();
}

}  // namespace saphira::bus
