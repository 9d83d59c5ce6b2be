#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saphira/bus/node.hpp"

namespace saphira::bus {

/// An input that a service declares: another service's cyclic topic, read as of cycle N-1.
template <class T>
class Input {
 public:
  virtual ~Input() = default;
  /// The sample for N-1; live, the newest of this epoch where that one has not come; nullptr before
  /// any has come. T::stamp says how old it is.
  virtual const T* value() const = 0;
};

/// What a step is for.
struct Step {
  v1::RobotState robot;    ///< of cycle N, from the bridge
  bool new_epoch = false;  ///< the first step of a connection: forget what belongs to the last one
  bool stale = false;      ///< live: some input of N-1 had not come, an older one stands in for it
};

/// A service's clockwork: which cycle is to be stepped now, with which inputs. The rules are
/// design.md's: the step for N sees RobotState(N) and the other services' samples for N-1; live, a
/// missing input is replaced by the newest one and counted; in lockstep the step waits for it.
/// Samples of another epoch are refused, counted and logged.
///
///   Cycle cycle(node);
///   auto& intentions = cycle.input(topics::kIntentions);
///   while (auto step = cycle.next(stop)) { ...; motor.write(...); cycle.done(); }
class Cycle {
 public:
  explicit Cycle(Node& node);
  ~Cycle();

  /// Declares an input. Owned by the cycle.
  template <class T>
  Input<T>& input(const Topic<T>& topic);

  /// Waits for the next step; nothing when stop was requested. Publishes the node's status while it
  /// waits. `idle` is called whenever the node woke without a step being due, and at least twice a
  /// second.
  std::optional<Step> next(const Stop& stop, const std::function<void()>& idle = {});
  /// Ends the step that next() began: counts its time.
  void done();

  /// The stamp for what is published in this step.
  const v1::Stamp& stamp() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saphira::bus
