#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace saphira::speech {

constexpr int kRate = 16000;  ///< [samples/s] of all that is heard and said here

/// One channel, 16 bits, kRate.
using Sound = std::vector<std::int16_t>;

double seconds(const Sound& sound);

/// From another rate, by straight lines between samples: enough for speech.
Sound resampled(const Sound& sound, int rate);

/// Of a RIFF file with 16 bits, any rate and any number of channels; the first channel counts.
/// std::runtime_error that says what is wrong with it.
Sound read_wav(const std::string& bytes, const std::string& file);
std::string wav(const Sound& sound);

}  // namespace saphira::speech
