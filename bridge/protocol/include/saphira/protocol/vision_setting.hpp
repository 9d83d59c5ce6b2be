#pragma once

#include <string>

#include "saphira/protocol/server_packet.hpp"

namespace saphira::protocol {

/// A setting of the Fast Track Vision System, from the text of a VISION_COM (manual 9.1).
struct VisionSetting {
  enum class What {
    mode,         ///< "pioneer_X_mode=N": of the channel X, a, b or c; 0 blob, 1 line, 2 its box
    color,        ///< "pioneer_X_color=NAME": of simulators; stands for the training of a channel
    bottom_row,   ///< "line_bottom_row=N": the first row for lines
    slices,       ///< "line_num_slices=N": how many rows are processed
    slice_size,   ///< "line_slice_size=N": how many pixels thick each row is
    minimum_mass  ///< "line_min_mass=N": pixels that make a segment
  };
  What what = What::mode;
  int channel = 0;    ///< of mode and color: 0, 1, 2 for a, b, c
  int value = 0;      ///< of all but color
  std::string color;  ///< of color
};

/// std::invalid_argument with the expected form for any other text.
VisionSetting parse_vision_setting(const std::string& text);

}  // namespace saphira::protocol
