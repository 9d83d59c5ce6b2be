#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/identity.hpp"
#include "saphira/base/withdraw.hpp"
#include "saphira/idl/common.hpp"
#include "saphira/requests/functor.hpp"

namespace saphira {

/// A request, for one action.
struct Request {
  std::string functor;
  Arguments arguments{};
  std::string source{};   ///< name of the asker, for people
  std::string service{};  ///< the program; empty: each that knows the functor
  v1::Stamp stamp{};      ///< of the asker's step; cycle 0: none
  std::uint64_t asker = 0;
  std::uint64_t number = 0;  ///< unique together with the asker; 0: not
  double deadline = 0.0;     ///< [s] after which an end is of no use; 0: none
  Checked person{};          ///< who asks

  friend bool operator==(const Request&, const Request&) = default;
};

enum class AnswerCode {
  underway,
  done,
  sent,  ///< to a robot, whose packets do not show it
  refused,
  unknown_functor,
  bad_argument,
  nobody,
  too_late,
  given_up,
  lost
};

inline bool ended(AnswerCode code) {
  return code != AnswerCode::underway;
}
/// True for a good end, or one under way.
inline bool well(AnswerCode code) {
  return code <= AnswerCode::sent;
}

/// The state of a request.
struct Answer {
  AnswerCode code = AnswerCode::done;
  std::string text{};  ///< in words; empty: the code says all
  Arguments results{};

  friend bool operator==(const Answer&, const Answer&) = default;
};

/// "place position=(1, 2, 0)"
std::string describe(const Request& request);

/// The answer to a request that none of the functors can take; nothing where one can. Then missing
/// arguments have been filled with their defaults.
std::optional<Answer> refusal(const std::vector<Functor>& functors, Request& request);

/// True where a request may be acted on in a step of `now` so that every run acts in the same step.
/// In lockstep a request from a service's step N is certain to be here in step N+2, since that step
/// needs other services' results from its outputs of N.
bool is_due(const Request& request, const v1::Stamp& now);

}  // namespace saphira
