#pragma once

#include <string>
#include <vector>

namespace saphira::speech {

/// The share of a command's sounds that differ from a second hearing of the same utterance, by a
/// decoder that knows no grammar. 0: the same; 1 and more: nothing in common. The beginning of the
/// second hearing may have some sounds of the keyword.
double difference(const std::vector<std::string>& heard, const std::vector<std::string>& command);

/// True where the second hearing has a word that turns the meaning of a sentence, such as "not" or
/// "until", and the command has not.
bool is_turned(const std::vector<std::string>& heard, const std::vector<std::string>& command);

}  // namespace saphira::speech
