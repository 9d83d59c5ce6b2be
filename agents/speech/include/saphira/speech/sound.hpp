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

/// A file of sound as libsndfile reads it: WAV of any kind, FLAC, Ogg and others. Of several
/// channels it takes the loudest. UnusableFile gives the error.
Sound read_sound(const std::string& bytes, const std::string& file);
std::string wav(const Sound& sound);

}  // namespace saphira::speech
