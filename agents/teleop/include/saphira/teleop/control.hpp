#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "saphira/teleop/pilot.hpp"

namespace saphira::teleop {

/// The operator among the people at the browsers, and the operator's commands. Times are seconds of
/// any clock that does not jump.
///
/// One operator holds control. The operator's page sends at least ten samples a second, also
/// without a command. Missing, late or repeated samples mean a lost link, and the robot stands.
/// After a short gap it stands until the stick has been let go; after a long one the operator
/// watches, and has to take control again.
class Control {
 public:
  struct Settings {
    double hold = 0.4;  ///< [s] validity of the newest sample after its arrival
    double lose = 1.0;  ///< [s] after this silence control is lost
    double late = 0.4;  ///< [s] a sample with this delay over the quickest is refused
  };

  /// One sample of the operator's page.
  struct Sample {
    std::uint64_t number = 0;  ///< counts the page's samples
    double device_time = 0.0;  ///< [s] by the operator's device, any origin
    bool active = false;       ///< the dead-man: a stick or a key is held
    double velocity = 0.0;     ///< [m/s]
    double rotation = 0.0;     ///< [rad/s]
    std::uint64_t cycle = 0;   ///< of the robot state on the operator's screen
  };

  using OperatorId = std::uint64_t;
  struct Operator {
    OperatorId id = 0;
    std::string name;
  };
  struct State {
    OperatorId holder = 0;  ///< 0: nobody
    std::string name;
    std::vector<Operator> asked;  ///< who ask for control
    std::string note;             ///< the newest change of control, for people
    std::string let_go;           ///< why the stick must be let go first [empty: it need not]
  };
  /// The reason for refusing a sample that was overtaken by a newer one, or repeated.
  static constexpr const char* kRepeated = "a repeated sample";

  Control() = default;
  explicit Control(Settings settings) : settings_(settings) {}

  void join(OperatorId id, const std::string& name);
  void leave(OperatorId id);
  /// Takes control; `force` also from another holder. Returns the reason of a failure, in words;
  /// empty: done.
  std::string take(OperatorId id, bool force, double now);
  /// Asks the holder for control. Returns the reason of a failure, in words.
  std::string ask(OperatorId id);
  /// The holder's control passes to somebody who asked for it. Returns the reason of a failure, in
  /// words.
  std::string give(OperatorId id, OperatorId to, double now);
  void release(OperatorId id);
  /// The reason for refusing the sample, in words; empty where it counts.
  std::string drive(OperatorId id, const Sample& sample, double now);

  /// The present order. Call it at least ten times a second: it detects missing samples.
  Order order(double now);

  OperatorId holder() const { return holder_; }
  State state() const;

 private:
  void drop(const std::string& note);
  void hand_to(OperatorId id, const std::string& note, double now);
  void lose_silent(double now);
  void notice_gap(double now);
  std::string name_of(OperatorId id) const;

  Settings settings_;
  std::map<OperatorId, std::string> operators_;
  OperatorId holder_ = 0;
  std::vector<OperatorId> asked_;
  std::string note_;
  Sample newest_;
  double came_ = 0.0;          ///< [s] of the newest sample
  double quickest_ = 0.0;      ///< [s] the smallest difference of the two clocks
  bool any_ = false;           ///< a sample has come since control was taken
  std::uint64_t counted_ = 0;  ///< the newest sample that counted
  std::string let_go_;         ///< why the stick must be let go first [empty: it need not]
  /// The sample since which it must be let go. A release counts also where a later press has
  /// overtaken it, on another connection.
  std::uint64_t held_since_ = 0;
};

}  // namespace saphira::teleop
