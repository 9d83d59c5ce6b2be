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

/// A sealed line. Empty where nothing is latched.
std::string to_text(const Latches& latches);
/// Reads to_text(). An unreadable text counts as an emergency stop, since there may have been one.
Latches latches_from_text(const std::string& text);

}  // namespace saphira::authority
