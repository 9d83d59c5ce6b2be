#pragma once

#include <optional>
#include <string>
#include <vector>

#include "saphira/cli/words.hpp"

namespace saphira::cli {

/// That two deployments have this robot, and what to do about it: each program that has found
/// another one of its name says so in its status. Empty where none does.
std::string second_deployment(const std::vector<SeenProcess>& processes);

/// Tells a person who follows something else when two deployments have this robot, and when that is
/// over. Pure: time is given to it.
class SecondDeployment {
 public:
  /// [s] A program that was killed and started again finds the one before it for less than this.
  static constexpr double kCertain = 2.0;

  /// A message for the person, where there is a new one. `now` [s] is the time of any clock.
  std::optional<std::string> news(const std::vector<SeenProcess>& processes, double now);
  /// True where something was seen that is not certain yet.
  bool doubtful() const { return seen_ != told_; }

 private:
  bool seen_ = false;
  double since_ = 0.0;
  bool told_ = false;
};

}  // namespace saphira::cli
