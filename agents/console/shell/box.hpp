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
  /// An empty folder: nothing is kept. One that is missing is made.
  Box(std::string folder, bus::NodeOptions options);
  ~Box();
  Box(const Box&) = delete;
  Box& operator=(const Box&) = delete;

  /// Begins some seconds later, so that the recording has what follows, and nobody is disturbed
  /// amid it. An occasion that comes until its end is in the same recording. now: [s].
  void keep(const situation::Occasion& occasion, double now);
  /// The outcome in words, once.
  std::optional<std::string> poll(double now);

 private:
  void start();

  std::string folder_;
  bus::NodeOptions options_;
  std::optional<double> due_;  ///< [s]
  pid_t recorder_ = -1;
  std::string file_;
  std::string text_;
};

}  // namespace saphira::console
