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

/// A dialogue, "speaker: what is said" a line, read with a voice for each: the robot's is kal16,
/// people have the other voices of flite in the order in which they speak first.
/// std::invalid_argument that names the line where one has no speaker.
std::vector<Passage> read_aloud(std::string_view dialogue, const std::string& robot = "flakey");

/// All of it, with a pause after each.
Sound joined(const std::vector<Passage>& passages);

}  // namespace saphira::speech
