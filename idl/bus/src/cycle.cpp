#include "saphira/bus/cycle.hpp"

#include <chrono>
#include <deque>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "epochs.hpp"
#include "internal.hpp"
#include "peers.hpp"
#include "saphira/base/format.hpp"
#include "saphira/bus/namesakes.hpp"

namespace saphira::bus {
namespace {

using internal::Epochs;
using internal::Peers;

using Clock = std::chrono::steady_clock;
constexpr auto kIdle = std::chrono::milliseconds(500);
// The interval of looks. Samples come one by one: a look after each would take most of the time.
constexpr auto kStepSpin = std::chrono::microseconds(200);
constexpr auto kStepLook = std::chrono::milliseconds(5);
// [s] without a step before the status names the missing input.
constexpr double kQuietLive = 0.5;
constexpr double kQuietLockstep = 2.0;
// A late step shows in the state for this number of steps.
constexpr std::uint64_t kDegradedSteps = 10;
// RobotStates that wait: more than a bridge in lockstep can be ahead.
constexpr std::size_t kPending = 32;
// [s] before a state is refused whose writer has described no robot.
constexpr double kUndescribed = 2.0;
// After so many states in a row behind the newest one, the newest one counts as wrong.
constexpr int kBehind = 3;
// [s] without a state of the robot, while other programs step: this program counts as deaf. Also
// the time to the next attempt.
constexpr double kDeaf = 10.0;
constexpr double kDeafAgain = 60.0;
// Maximum number of logged refusals. A larger number is forged.
constexpr std::size_t kMostTold = 1000;
// Descriptions that are kept: of this bridge's last epochs, and of other bridges of this robot.
constexpr std::size_t kDescriptions = 64;
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
        robot(the_node.reader(topics::kRobotState)),
        descriptions(the_node.reader(topics::kRobotDescription)),
        namesakes(the_node) {}

  void refuse(const char* topic, const v1::Stamp& stamp, const std::string& why) {
    ++status.refused_samples;
    refusal = std::string("refuses samples of ") + topic + " " + why;
    refusal_until = status.steps + kDegradedSteps;
    if (told.size() < kMostTold && told.insert(std::string(topic) + why).second)
      node.warn(std::string("refused a sample of ") + topic + ", epoch " +
                std::to_string(stamp.epoch) + " cycle " + std::to_string(stamp.cycle) + ", " + why);
  }

  // The program of a writer, for people.
  std::string program(const WriterId& writer) const {
    for (const EndpointEntry& entry : internal::transport_of(node).endpoints())
      if (entry.id == hex_text(writer))
        return entry.program + " (process " + std::to_string(entry.pid) + " at " + entry.host + ")";
    return "an unknown program";
  }

  void trouble(std::string text) {
    degraded = std::move(text);
    degraded_until = status.steps + kDegradedSteps;
  }

  // Forgets the steps of the epoch, or of a part of it that was wrong.
  void begin_at(std::uint64_t cycle) {
    last = cycle - 1;
    joining = true;
    behind = 0;
    pending.clear();
  }

  void adopt(std::uint64_t left) {
    if (left != 0)
      for (auto& slot : inputs)
        slot->forget(left);
    begin_at(1);
    fresh = true;
    node.info("epoch " + std::to_string(epochs.epoch()));
  }

  // Fast DDS may leave one side of a match deaf for ever. If others hear the robot, begin anew.
  void note_deafness() {
    if (!pending.empty() || since(waiting_since) < kDeaf || since(renewed) < kDeafAgain ||
        !namesakes.stepping_since(waiting_since))
      return;
    renewed = Clock::now();
    node.warn("hears no robot/state, though others of this robot do: begins anew on the bus");
    node.begin_anew();
  }

  void drain() {
    for (const WriterId& gone : robot.take_lost())
      epochs.lose(Peers::program_of(gone));
    descriptions.visit([&](const v1::RobotDescription& description, const SampleInfo& info) {
      if (info.disposed || description.stamp.epoch == 0)
        return;
      epochs.describe(Peers::program_of(info.writer), description.instance,
                      description.stamp.epoch);
      described.push_back(description);
      if (described.size() > kDescriptions)
        described.pop_front();
    });
    // States whose description has not come yet stay, in their order.
    std::erase_if(arrived,
                  [&](const Arrived& one) { return !undecided(one.state, one.writer, one.when); });
    robot.visit([&](const v1::RobotState& state, const SampleInfo& info) {
      if (info.disposed)
        return;
      if (state.stamp.epoch == 0 || state.stamp.cycle == 0)
        return refuse(topics::kRobotState.name, state.stamp, "without epoch or cycle");
      if (const auto now = Clock::now(); undecided(state, info.writer, now))
        arrived.push_back({state, info.writer, now});
    });
    while (arrived.size() > kPending) {
      refuse_stray(arrived.front().state, arrived.front().writer);
      arrived.pop_front();
    }
    for (auto& slot : inputs)
      slot->drain([&](const v1::Stamp& stamp) {
        const bool good = stamp.epoch != 0 && epochs.useful(stamp.epoch);
        if (!good)
          refuse(slot->name(), stamp,
                 stamp.epoch == 0 ? "without epoch"
                                  : "of an epoch that was left, or of another bridge's");
        return good;
      });
  }

  // An epoch is adopted only after its description has come. If the description was displaced by
  // many others meanwhile, the writers of those use this robot's name wrongly.
  v1::RobotDescription description_of(std::uint64_t epoch) const {
    for (auto one = described.rbegin(); one != described.rend(); ++one)
      if (one->stamp.epoch == epoch)
        return *one;
    return robot_now;
  }

  struct Arrived {
    v1::RobotState state;
    WriterId writer;
    Clock::time_point when;
  };

  bool undecided(const v1::RobotState& state, const WriterId& writer, Clock::time_point when) {
    const std::uint64_t before = epochs.epoch();
    switch (epochs.judge(Peers::program_of(writer), state.stamp.epoch)) {
      case Epochs::Verdict::adopt:
        adopt(before);
        robot_now = description_of(epochs.epoch());
        [[fallthrough]];
      case Epochs::Verdict::take:
        take(state);
        return false;
      case Epochs::Verdict::wait:
        if (since(when) < kUndescribed)
          return true;
        refuse_stray(state, writer);
        return false;
      case Epochs::Verdict::foreign:
        refuse(topics::kRobotState.name, state.stamp,
               "of another bridge, " + program(writer) + ", with a robot of the same name");
        return false;
      case Epochs::Verdict::left:
        refuse(topics::kRobotState.name, state.stamp, "of an epoch that was left");
        return false;
    }
    return false;
  }

  void refuse_stray(const v1::RobotState& state, const WriterId& writer) {
    refuse(topics::kRobotState.name, state.stamp,
           "of " + program(writer) + ", which has described no robot for this epoch");
  }

  // Of the bridge and the epoch that are followed.
  void take(const v1::RobotState& state) {
    const std::uint64_t cycle = state.stamp.cycle;
    if (cycle <= (pending.empty() ? last : pending.back().stamp.cycle)) {
      refuse(topics::kRobotState.name, state.stamp, "behind the newest one");
      // The bridge counts up. One wrong number must not block all later states.
      behind = cycle == behind_cycle + 1 ? behind + 1 : 1;
      behind_cycle = cycle;
      if (behind < kBehind)
        return;
      node.warn("goes back to cycle " + std::to_string(cycle) + ": the newest one was wrong");
      begin_at(cycle);
    }
    behind = 0;
    if (pending.empty()) {
      waiting_since = Clock::now();
      quiet = false;
    }
    pending.push_back(state);
    if (pending.size() > kPending)
      pending.erase(pending.begin());
  }

  // Live: the newest state, at once.
  std::optional<Step> due_live() {
    if (pending.empty())
      return {};
    Step step{.robot = std::move(pending.back())};
    pending.clear();
    const std::uint64_t cycle = step.robot.stamp.cycle;
    if (!joining && cycle > last + 1) {
      status.late_cycles += cycle - last - 1;
      trouble("skipped a cycle");
    }
    for (auto& slot : inputs) {
      const std::uint64_t found = slot->newest(epochs.epoch(), cycle - 1);
      slot->select(epochs.epoch(), found);
      if (found + 1 == cycle)
        continue;
      step.stale = true;
      // Its writers may be starting as well: the first step counts no missing input.
      if (!joining)
        trouble(std::string(found == 0 ? "runs without " : "runs on an old sample of ") +
                slot->name());
    }
    if (step.stale && !joining)
      ++status.late_cycles;
    return step;
  }

  enum class Inputs { here, missing, gone };

  Inputs inputs_for(std::uint64_t cycle) const {
    Inputs result = Inputs::here;
    for (const auto& slot : inputs) {
      if (cycle == 1 || slot->newest(epochs.epoch(), cycle - 1) == cycle - 1)
        continue;
      // A writer's samples come in order: a later sample means that this one will not come.
      if (slot->newest(epochs.epoch(), kAny) >= cycle)
        return Inputs::gone;
      if (joining && quiet && slot->newest(epochs.epoch(), kAny) == 0)
        continue;
      result = Inputs::missing;
    }
    return result;
  }

  // Lockstep: each state in its order, with every input.
  std::optional<Step> due_lockstep() {
    while (!pending.empty()) {
      const std::uint64_t cycle = pending.front().stamp.cycle;
      if (!joining && cycle > last + 1) {
        status.late_cycles += cycle - last - 1;
        trouble("lost a state of the robot");
        node.warn("lockstep: no robot/state between cycles " + std::to_string(last) + " and " +
                  std::to_string(cycle));
        joining = true;
      }
      const Inputs ready = inputs_for(cycle);
      if (ready == Inputs::missing)
        return {};
      if (ready == Inputs::gone) {
        pending.erase(pending.begin());
        // Only a service that joins a running lockstep late may skip a cycle.
        if (!joining) {
          ++status.late_cycles;
          trouble("lost an input");
          node.warn("lockstep: an input for cycle " + std::to_string(cycle) + " will not come");
          joining = true;
        }
        continue;
      }
      Step step;
      for (auto& slot : inputs) {
        const bool there = cycle > 1 && slot->newest(epochs.epoch(), cycle - 1) == cycle - 1;
        slot->select(epochs.epoch(), there ? cycle - 1 : 0);
        step.stale |= cycle > 1 && !there;
      }
      missing.clear();
      for (const Gate& gate : gates)
        if (missing = gate(pending.front()); !missing.empty())
          return {};
      step.robot = std::move(pending.front());
      pending.erase(pending.begin());
      if (step.stale)
        node.warn("lockstep: begins at cycle " + std::to_string(cycle) +
                  " without the inputs of the cycle before, which nobody has");
      return step;
    }
    return {};
  }

  // The input that is waited for, in words.
  std::string awaited() const {
    const auto nobody = [](std::size_t matched) {
      return matched == 0 ? ": nobody writes it" : "";
    };
    if (pending.empty() && !arrived.empty())
      return std::string("waits for ") + topics::kRobotDescription.name;
    if (pending.empty())
      return std::string("waits for ") + topics::kRobotState.name +
             (last > 0 ? " of cycle " + std::to_string(last + 1) : "") + nobody(robot.matched());
    const std::uint64_t cycle = pending.front().stamp.cycle;
    for (const auto& slot : inputs)
      if (slot->newest(epochs.epoch(), cycle - 1) + 1 != cycle)
        return std::string("waits for ") + slot->name() + " of cycle " + std::to_string(cycle - 1) +
               nobody(slot->matched());
    return "waits" + (missing.empty() ? "" : " for " + missing);
  }

  void note_waiting() {
    quiet = since(waiting_since) > (lockstep ? kQuietLockstep : kQuietLive);
    if (!quiet)
      return;
    status.state = v1::SERVICE_WAITING;
    status.reason = awaited();
  }

  void note_step(const Step& step) {
    status.stamp = step.robot.stamp;
    ++status.steps;
    if (!degraded.empty() && status.steps >= degraded_until)
      degraded.clear();
    if (!refusal.empty() && status.steps >= refusal_until)
      refusal.clear();
    // A refused sample is worse than a late one, and may be its cause.
    status.reason = refusal.empty() ? degraded : refusal;
    status.state = status.reason.empty() ? v1::SERVICE_RUNNING : v1::SERVICE_DEGRADED;
  }

  void publish_status() {
    status.step_ms_mean = timed > 0 ? total_ms / static_cast<double>(timed) : 0.0;
    status.step_ms_max = max_ms;
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
  Reader<v1::RobotDescription> descriptions;
  Namesakes namesakes;
  Epochs epochs;
  std::deque<Arrived> arrived;  // whose bridge is not known yet
  std::vector<std::unique_ptr<detail::InputSlot>> inputs;
  std::deque<v1::RobotDescription> described;
  v1::RobotDescription robot_now;  // of this epoch
  std::vector<Gate> gates;
  std::string missing;                  // the input that a gate waits for
  std::vector<v1::RobotState> pending;  // of this epoch, not yet stepped, in order
  std::uint64_t last = 0;               // cycle of this epoch that was stepped last
  bool joining = true;                  // no step of this epoch yet
  bool fresh = true;                    // the next step is the first of its epoch
  bool quiet = false;                   // no step was due for so long that the status says it
  int behind = 0;                       // states in a row that were behind the newest one
  std::uint64_t behind_cycle = 0;
  std::set<std::string> told;
  std::string degraded;
  std::uint64_t degraded_until = 0;
  std::string refusal;
  std::uint64_t refusal_until = 0;
  Clock::time_point waiting_since = Clock::now();
  Clock::time_point renewed = Clock::now() - std::chrono::minutes(2);
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

void Cycle::gate(Gate missing) {
  impl_->gates.push_back(std::move(missing));
}

std::optional<Step> Cycle::poll() {
  Impl& self = *impl_;
  if (self.lockstep)
    self.node.rouse();
  self.namesakes.poll();
  self.drain();
  if (self.namesakes.waits() || superseded())
    return {};
  auto step = self.lockstep ? self.due_lockstep() : self.due_live();
  if (!step)
    return {};
  step->description = &self.robot_now;
  step->new_epoch = std::exchange(self.fresh, false);
  self.joining = false;
  self.namesakes.act();
  self.last = step->robot.stamp.cycle;
  self.note_step(*step);
  self.began = Clock::now();
  return step;
}

bool Cycle::idle(const std::function<void()>& idle) {
  Impl& self = *impl_;
  if (Clock::now() - self.looked < kStepLook)
    return false;
  if (!self.namesakes.waits()) {
    self.note_waiting();
    self.note_deafness();
  }
  self.publish_status();
  if (idle && !self.namesakes.waits())
    idle();
  self.looked = Clock::now();
  return true;
}

std::optional<Step> Cycle::next(const Stop& stop, const std::function<void()>& idle) {
  Impl& self = *impl_;
  self.waiting_since = Clock::now();
  self.quiet = false;
  while (!stop.requested()) {
    if (auto step = poll())
      return step;
    if (superseded())
      return {};
    if (self.lockstep && !self.namesakes.waits() && self.node.spin(kStepSpin))
      self.node.clear_wake();
    else if (this->idle(idle))
      self.node.wait(kIdle, &stop);
    else
      self.node.wait(
          std::chrono::ceil<std::chrono::milliseconds>(self.looked + kStepLook - Clock::now()),
          &stop);
  }
  return {};
}

bool Cycle::superseded() const {
  return impl_->namesakes.superseded();
}

void Cycle::done() {
  const double ms = 1e3 * since(impl_->began);
  ++impl_->timed;
  impl_->total_ms += ms;
  impl_->max_ms = std::max(impl_->max_ms, ms);
  impl_->waiting_since = Clock::now();
  impl_->quiet = false;
  // After the step, not before: the cost of publishing must not delay the robot.
  impl_->publish_status();
  impl_->looked = Clock::now();
}

bool Cycle::connected() const {
  return impl_->robot.matched() > 0 &&
         std::all_of(impl_->inputs.begin(), impl_->inputs.end(),
                     [](const auto& slot) { return slot->matched() > 0; });
}

const v1::Stamp& Cycle::stamp() const {
  return impl_->status.stamp;
}

}  // namespace saphira::bus
