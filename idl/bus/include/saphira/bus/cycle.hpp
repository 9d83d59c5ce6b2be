#pragma once

#include <algorithm>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "saphira/bus/node.hpp"

namespace saphira::bus {

/// An input that a service declares: another service's cyclic topic, read as of cycle N-1.
template <class T>
class Input {
 public:
  virtual ~Input() = default;
  /// The sample for N-1; live, the newest of this epoch where that sample has not come; nullptr
  /// before any has come. T::stamp gives its age. Valid until the next call of Cycle::next().
  virtual const T* value() const = 0;
};

/// The cycle that a step is for.
struct Step {
  v1::RobotState robot;  ///< of cycle N, from the bridge
  /// The robot of this epoch, as its bridge describes it. Valid until the next call of the Cycle.
  const v1::RobotDescription* description = nullptr;
  bool new_epoch = false;  ///< the first step of a connection: forget what belongs to the last one
  bool stale = false;      ///< live: an input of N-1 had not come, and an older one replaces it
};

namespace detail {

/// An input without its type, for the clockwork.
class InputSlot {
 public:
  virtual ~InputSlot() = default;
  /// Takes the samples that have come; keeps a sample where `accept` is true.
  virtual void drain(const std::function<bool(const v1::Stamp&)>& accept) = 0;
  /// Forgets the samples of an epoch.
  virtual void forget(std::uint64_t epoch) = 0;
  /// The newest cycle that is here, of an epoch and up to a limit; 0: none.
  virtual std::uint64_t newest(std::uint64_t epoch, std::uint64_t limit) const = 0;
  /// Makes the sample of exactly that cycle the value; 0: none.
  virtual void select(std::uint64_t epoch, std::uint64_t cycle) = 0;
  virtual std::size_t matched() const = 0;
  virtual const char* name() const = 0;
};

template <class T>
class TypedInput final : public Input<T>, public InputSlot {
 public:
  TypedInput(Reader<T> reader, const char* name) : reader_(std::move(reader)), name_(name) {}

  const T* value() const override { return value_; }

  void drain(const std::function<bool(const v1::Stamp&)>& accept) override {
    value_ = nullptr;
    reader_.visit([&](const T& sample, const SampleInfo& info) {
      if (info.disposed || !accept(sample.stamp))
        return;
      if (samples_.size() < kKept) {
        samples_.push_back(sample);
        return;
      }
      // The oldest one's strings and vectors hold the new ones.
      samples_.splice(samples_.end(), samples_, samples_.begin());
      samples_.back() = sample;
    });
  }
  void forget(std::uint64_t epoch) override {
    value_ = nullptr;
    std::erase_if(samples_, [&](const T& sample) { return sample.stamp.epoch == epoch; });
  }
  std::uint64_t newest(std::uint64_t epoch, std::uint64_t limit) const override {
    std::uint64_t best = 0;
    for (const T& sample : samples_)
      if (sample.stamp.epoch == epoch && sample.stamp.cycle <= limit)
        best = std::max<std::uint64_t>(best, sample.stamp.cycle);
    return best;
  }
  void select(std::uint64_t epoch, std::uint64_t cycle) override {
    value_ = nullptr;
    for (const T& sample : samples_)
      if (sample.stamp.epoch == epoch && sample.stamp.cycle == cycle)
        value_ = &sample;
  }
  std::size_t matched() const override { return reader_.matched(); }
  const char* name() const override { return name_; }

 private:
  // As deep as the history of a cyclic topic in lockstep.
  static constexpr std::size_t kKept = 8;

  Reader<T> reader_;
  const char* name_;
  std::list<T> samples_;
  const T* value_ = nullptr;
};

}  // namespace detail

/// A service's clockwork: which cycle is to be stepped now, with which inputs. The rules are
/// design.md's: the step for N sees RobotState(N) and the other services' samples for N-1; live, a
/// missing input is replaced by the newest one and counted; in lockstep the step waits for it.
/// Samples of an epoch that was left are refused, counted and logged; a new epoch is adopted when
/// the bridge's RobotState says it.
///
/// A service that joins a running lockstep late starts at the oldest cycle whose inputs are still
/// available, so that a program waiting for that cycle gets it.
///
///   Cycle cycle(node);
///   auto& intentions = cycle.input(topics::kIntentions);
///   while (auto step = cycle.next(stop)) { ...; motor.write(...); cycle.done(); }
class Cycle {
 public:
  explicit Cycle(Node& node);
  ~Cycle();
  Cycle(const Cycle&) = delete;
  Cycle& operator=(const Cycle&) = delete;

  /// Declares an input, before the first next(). Owned by the cycle.
  template <class T>
  Input<T>& input(const Topic<T>& topic) {
    auto made = std::make_unique<detail::TypedInput<T>>(node_.reader(topic), topic.name);
    auto& result = *made;
    add(std::move(made));
    return result;
  }

  /// Further conditions of a step, for which lockstep waits. Returns the missing input in words;
  /// empty: none. Called when the inputs of that state are there and can be read.
  using Gate = std::function<std::string(const v1::RobotState& state)>;
  void gate(Gate missing);

  /// The step that is due now, or nothing. Never waits.
  std::optional<Step> poll();
  /// Where no step is due: publishes the node's status (the missing input, counters) and calls
  /// `idle`, at most every 5 ms. False where it was too early to do so. `idle` is not called while
  /// another program of this name serves the robot.
  bool idle(const std::function<void()>& idle = {});
  /// Waits for the next step; nothing when stop was requested, or superseded(). Calls idle()
  /// meanwhile: on each wake without a due step, and at least twice a second.
  std::optional<Step> next(const Stop& stop, const std::function<void()>& idle = {});
  /// True when another program of this name has served the robot and is gone: the state of this
  /// one is older, and no step follows. A new Cycle takes its place.
  bool superseded() const;
  /// Ends the step that next() began and counts its time.
  void done();

  /// True where a bridge and a writer of each input have been found.
  bool connected() const;

  /// The stamp for samples that are published in this step.
  const v1::Stamp& stamp() const;

 private:
  void add(std::unique_ptr<detail::InputSlot> slot);

  struct Impl;
  Node& node_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saphira::bus
