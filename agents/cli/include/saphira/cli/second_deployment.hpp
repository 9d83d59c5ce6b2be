#pragma once

#include <optional>
#include <string>
#include <vector>

#include "saphira/cli/words.hpp"

namespace saphira::cli {

/// The message that two deployments have this robot, with advice: each program with a namesake
/// reports that in its status. Empty without such a report.
std::string second_deployment(const std::vector<SeenProcess>& processes);

/// Tells a person, in any command, when two deployments have this robot, and when that is over.
/// Pure: the time is an argument.
class SecondDeployment {
 public:
  /// [s] A restarted program may see its killed predecessor for less than this.
  static constexpr double kCertain = 2.0;

  /// A new message for the person, if any. `now` [s] is the time of any clock.
  std::optional<std::string> news(const std::vector<SeenProcess>& processes, double now);
  /// True where an observation is not certain yet.
  bool doubtful() const { return seen_ != told_; }

 private:
  bool seen_ = false;
  double since_ = 0.0;
  bool told_ = false;
};

}  // namespace saphira::cli
