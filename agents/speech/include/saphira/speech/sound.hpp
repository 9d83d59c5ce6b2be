#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace saphira::speech {

constexpr int kRate = 16000;  ///< [samples/s] of all sound here

/// One channel, 16 bits, kRate.
using Sound = std::vector<std::int16_t>;

double seconds(const Sound& sound);

/// From another rate, with linear interpolation: enough for speech.
Sound resampled(const Sound& sound, int rate);

/// Sound of a RIFF file with 16 bits, any rate and any number of channels; the first channel
/// counts. std::runtime_error gives the error.
Sound read_wav(const std::string& bytes, const std::string& file);
std::string wav(const Sound& sound);

}  // namespace saphira::speech
