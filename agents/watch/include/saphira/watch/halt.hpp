#pragma once

#include "saphira/idl/request.hpp"

namespace saphira::watch {

/// The course of a stop, by the answers of the bridges that it is for: confirmed by each of them,
/// then the robots at rest; or given up. Pure.
class Halt {
 public:
  static constexpr double kConfirm = 2.0;  ///< [s] after which a missing confirmation is told
  static constexpr double kRest = 5.0;     ///< [s] in which a robot is at rest
  static constexpr double kMost = 30.0;    ///< [s] after which the wait for its rest is given up

  enum class News {
    none,
    not_confirmed,  ///< for another kConfirm: it goes on trying
    not_at_rest,    ///< confirmed, and that for kRest, then for another kConfirm
    given_up        ///< confirmed for kMost; from then on
  };

  /// confirmed: by each bridge that is known. now: [s] of a clock that never goes back, 0 at first.
  News update(bool confirmed, double now);
  /// [s] since it is confirmed; where it is not, since it is not.
  double lasts(double now) const { return now - since_; }

  /// The end that a bridge gave.
  void end(v1::AnswerCode code);
  /// False: a bridge did not see its robot at rest.
  bool well() const { return well_; }

 private:
  bool confirmed_ = false;
  bool well_ = true;
  double since_ = 0.0;  ///< [s] of the clock
  double told_ = 0.0;   ///< likewise
};

}  // namespace saphira::watch
