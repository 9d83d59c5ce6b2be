#pragma once

#include <string>

namespace saphira::authority {

/// Why autonomy waits for a person.
enum class Wait {
  none,
  driven,  ///< a person drove last
  reset,   ///< an emergency stop was reset while autonomy asked to drive, or was not heard
};

/// Stops that hold until a person releases them, whatever happens to the programs.
struct Latches {
  bool estopped = false;
  std::string estop_source;  ///< which program pressed it
  Wait wait = Wait::none;
  bool operator==(const Latches&) const = default;
};

}  // namespace saphira::authority
