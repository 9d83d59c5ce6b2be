#include "saphira/speech/sound.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/base/text.hpp"

namespace saphira::speech {
namespace {

std::uint32_t number(const std::string& bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes.at(at + i))) << (8 * i);
  return value;
}

void put(std::string& bytes, std::uint32_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    bytes += static_cast<char>((value >> (8 * i)) & 0xffU);
}

}  // namespace

double seconds(const Sound& sound) {
  return static_cast<double>(sound.size()) / kRate;
}

Sound resampled(const Sound& sound, int rate) {
  if (rate == kRate || sound.empty())
    return sound;
  Sound out(sound.size() * static_cast<std::size_t>(kRate) / static_cast<std::size_t>(rate));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double at = static_cast<double>(i) * rate / kRate;
    const auto before = std::min(static_cast<std::size_t>(at), sound.size() - 1);
    const std::size_t after = std::min(before + 1, sound.size() - 1);
    const double part = at - std::floor(at);
    out[i] =
        static_cast<std::int16_t>(std::lround((1.0 - part) * sound[before] + part * sound[after]));
  }
  return out;
}

Sound read_wav(const std::string& bytes, const std::string& file) {
  const auto fail = [&](const std::string& what) {
    throw UnusableFile(file + ": " + what + " (expected a WAV file with 16 bits a sample)");
  };
  if (bytes.size() < 12 || bytes.compare(0, 4, "RIFF") != 0 || bytes.compare(8, 4, "WAVE") != 0)
    fail("it does not begin as a WAV file");
  std::uint32_t channels = 0;
  std::uint32_t rate = 0;
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    const std::string chunk = bytes.substr(at, 4);
    // A stream of unknown length has a length beyond its end.
    const std::size_t length =
        std::min<std::size_t>(number(bytes, at + 4, 4), bytes.size() - at - 8);
    at += 8;
    if (chunk == "fmt " && length >= 16) {
      channels = number(bytes, at + 2, 2);
      rate = number(bytes, at + 4, 4);
      if (number(bytes, at, 2) != 1 || number(bytes, at + 14, 2) != 16)
        fail("its samples are of another kind");
      if (channels < 1 || channels > 16 || rate < 4000 || rate > 200000)
        fail("its number of channels or its rate makes no sense");
    } else if (chunk == "data") {
      if (channels == 0)
        fail("samples come before their form is told");
      Sound sound;
      const std::size_t frame = 2 * static_cast<std::size_t>(channels);
      for (std::size_t i = 0; i + frame <= length; i += frame)
        sound.push_back(static_cast<std::int16_t>(number(bytes, at + i, 2)));
      return resampled(sound, static_cast<int>(rate));
    }
    at += length + length % 2;
  }
  fail("it has no samples");
  return {};
}

std::string wav(const Sound& sound) {
  const auto length = static_cast<std::uint32_t>(2 * sound.size());
  std::string bytes = "RIFF";
  put(bytes, 36 + length, 4);
  bytes += "WAVEfmt ";
  put(bytes, 16, 4);
  put(bytes, 1, 2);
  put(bytes, 1, 2);
  put(bytes, kRate, 4);
  put(bytes, 2 * kRate, 4);
  put(bytes, 2, 2);
  put(bytes, 16, 2);
  bytes += "data";
  put(bytes, length, 4);
  for (const std::int16_t sample : sound)
    put(bytes, static_cast<std::uint16_t>(sample), 2);
  return bytes;
}

}  // namespace saphira::speech
