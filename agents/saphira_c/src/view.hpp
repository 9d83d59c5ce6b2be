#pragma once

#include <array>
#include <cstdint>

#include "saphira.h"

namespace saphira::c {

using ::point;  // not the argument of a request

/// The state of the robot for a C program: one whole cycle.
struct View {
  std::uint64_t cycle = 0;
  struct robot robot {};
  std::array<sdata, SF_MAX_SONARS> sonars{};
  std::array<std::uint64_t, SF_MAX_SONARS> read{};  ///< cycle of each sonar's newest reading
  std::array<cbuf, 3> buffers{};                    ///< front, left, right
  std::array<wall, 2> walls{};                      ///< left, right
  std::array<vinfo, 3> vision{};
};

/// The view of the calling thread. The micro-tasks' thread has that of its cycle; any other has a
/// copy of the newest, taken now: so no thread reads while another one writes.
View& view();
/// The calling thread runs the micro-tasks: its view changes in publish() only.
void own_view();
/// A new cycle, from the thread that runs the micro-tasks.
void publish(const View& next);

}  // namespace saphira::c
