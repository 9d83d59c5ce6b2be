#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "saphira/speech/sound.hpp"

namespace saphira::speech {

/// One line of a dialogue, as sound.
struct Passage {
  std::string speaker;
  Sound sound;
};

/// A dialogue, "speaker: text" a line, read with a voice for each: the robot's is kal16, people
/// have the other voices of flite in the order of their first lines. std::invalid_argument names a
/// line without a speaker.
std::vector<Passage> read_aloud(std::string_view dialogue, const std::string& robot = "flakey");

/// All passages, with a pause after each.
Sound joined(const std::vector<Passage>& passages);

}  // namespace saphira::speech
