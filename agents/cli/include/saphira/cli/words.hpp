#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "saphira/situation/situation.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::cli {

// The same wording for the robot and its programs in every command.
using situation::describe;
using situation::kLostAge;
using situation::latched;
using situation::name_of;
using SeenProcess = situation::Program;

/// Text in aligned columns; numbers (a leading digit) to the right. The first row is the heading.
/// The last column is not padded. Ends with a line break.
std::string table(const std::vector<std::vector<std::string>>& rows);

/// The text on two lines of at most that many characters, divided at a word.
std::array<std::string, 2> two_lines(const std::string& text, std::size_t width);

/// The table of processes, sorted by name; after them those of `unheard` that are not among them.
std::string status_table(std::vector<SeenProcess> processes,
                         const std::vector<std::string>& unheard = {});

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

/// std::invalid_argument unless the file to be written has the ending of its content.
void expect_ending(const std::string& path, const std::string& ending);

}  // namespace saphira::cli
