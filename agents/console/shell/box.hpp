#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "saphira/bus/node.hpp"
#include "saphira/situation/occasions.hpp"

namespace saphira::console {

/// Keeps the last minute after an occasion: saphira-record writes it into a folder, so that this
/// program waits for nothing. The newest 20 files stay, of 200 MB at most.
class Box {
 public:
  /// A folder that is missing is made.
  Box(std::string folder, bus::NodeOptions options);
  ~Box();
  Box(const Box&) = delete;
  Box& operator=(const Box&) = delete;

  /// An occasion that comes before the recording ends is in the same recording. now: [s].
  void keep(const situation::Occasion& occasion, double now);
  /// Begins the recording 5 s after the occasion, so that it has what follows; while a person
  /// drives, whom a further program on the bus may disturb, 30 s after it. Returns the outcome in
  /// words, once.
  std::optional<std::string> poll(bool is_driven, double now);

 private:
  void start();

  std::string folder_;
  bus::NodeOptions options_;
  std::optional<double> occasion_;  ///< [s] time of one that is not recorded yet
  pid_t recorder_ = -1;
  std::string file_;
  std::string text_;
};

}  // namespace saphira::console
