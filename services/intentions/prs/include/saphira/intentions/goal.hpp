#pragma once

#include <string>

#include "saphira/base/numbers.hpp"
#include "saphira/idl/goal_words.hpp"
#include "saphira/requests/argument.hpp"

namespace saphira::intentions {

using v1::GoalCode;
using v1::GoalId;
using v1::GoalState;
using v1::GoalStatus;  ///< in the library without a stamp

/// A goal: a wanted state of the world. Writing it again under its id changes it.
struct Goal {
  GoalId id;
  std::string requester;
  std::string functor;
  Arguments arguments;
  int priority = 0;       ///< larger is more important
  double deadline = 0.0;  ///< [s] of robot time from acceptance; 0: none
  v1::WriterLost writer_lost = v1::WRITER_LOST_CANCEL;
  double level = 0.0;  ///< [0..1] sufficient satisfaction; 0: the default

  bool operator==(const Goal&) const = default;
};

}  // namespace saphira::intentions
