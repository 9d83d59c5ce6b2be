#include "saphira/speech/sound.hpp"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "saphira/base/text.hpp"

namespace saphira::speech {
namespace {

constexpr int kLeastRate = 11'025;  // [samples/s] words of a telephone are taken for others
constexpr int kMostRate = 200'000;

/// A file in memory, for libsndfile.
struct Memory {
  std::string bytes;
  sf_count_t at = 0;
};

SF_VIRTUAL_IO io_of_memory() {
  SF_VIRTUAL_IO io{};
  io.get_filelen = [](void* user) {
    return static_cast<sf_count_t>(static_cast<Memory*>(user)->bytes.size());
  };
  io.seek = [](sf_count_t offset, int whence, void* user) {
    auto& memory = *static_cast<Memory*>(user);
    const auto size = static_cast<sf_count_t>(memory.bytes.size());
    const sf_count_t from = whence == SEEK_CUR ? memory.at : whence == SEEK_END ? size : 0;
    memory.at = std::clamp<sf_count_t>(from + offset, 0, size);
    return memory.at;
  };
  io.read = [](void* to, sf_count_t count, void* user) {
    auto& memory = *static_cast<Memory*>(user);
    const auto rest = static_cast<sf_count_t>(memory.bytes.size()) - memory.at;
    count = std::min(count, rest);
    memory.bytes.copy(static_cast<char*>(to), static_cast<std::size_t>(count),
                      static_cast<std::size_t>(memory.at));
    memory.at += count;
    return count;
  };
  io.write = [](const void* from, sf_count_t count, void* user) {
    auto& memory = *static_cast<Memory*>(user);
    const auto end = static_cast<std::size_t>(memory.at + count);
    memory.bytes.resize(std::max(memory.bytes.size(), end));
    memory.bytes.replace(static_cast<std::size_t>(memory.at), static_cast<std::size_t>(count),
                         static_cast<const char*>(from), static_cast<std::size_t>(count));
    memory.at += count;
    return count;
  };
  io.tell = [](void* user) { return static_cast<Memory*>(user)->at; };
  return io;
}

struct Close {
  void operator()(SNDFILE* file) const { sf_close(file); }
};
using File = std::unique_ptr<SNDFILE, Close>;

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

Sound read_sound(const std::string& bytes, const std::string& file) {
  Memory memory{bytes};
  SF_VIRTUAL_IO io = io_of_memory();
  SF_INFO info{};
  const File opened(sf_open_virtual(&io, SFM_READ, &info, &memory));
  if (!opened)
    throw UnusableFile(
        file + ": it is empty, damaged or of an unknown kind. Expected sound, such as WAV or FLAC");
  if (info.samplerate < kLeastRate || info.samplerate > kMostRate)
    throw UnusableFile(file + ": expected " + std::to_string(kLeastRate) + " to " +
                       std::to_string(kMostRate) + " samples a second, found " +
                       std::to_string(info.samplerate));
  const auto channels = static_cast<std::size_t>(info.channels);
  std::vector<Sound> all(channels);
  std::vector<double> loudness(channels);
  constexpr std::size_t kBlock = 4096;
  std::vector<float> block(kBlock * channels);
  while (const auto frames = static_cast<std::size_t>(
             sf_readf_float(opened.get(), block.data(), static_cast<sf_count_t>(kBlock))))
    for (std::size_t i = 0; i < frames * channels; ++i) {
      constexpr float kFull = 32768.0F;
      all[i % channels].push_back(
          static_cast<std::int16_t>(std::clamp(std::lround(kFull * block[i]), -32768L, 32767L)));
      loudness[i % channels] += std::abs(block[i]);
    }
  const auto loudest = std::ranges::max_element(loudness) - loudness.begin();
  if (all.empty() || all.front().empty())
    throw UnusableFile(file + ": it has no samples");
  return resampled(all[static_cast<std::size_t>(loudest)], info.samplerate);
}

std::string wav(const Sound& sound) {
  Memory memory;
  SF_VIRTUAL_IO io = io_of_memory();
  SF_INFO info{};
  info.samplerate = kRate;
  info.channels = 1;
  info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
  {
    const File opened(sf_open_virtual(&io, SFM_WRITE, &info, &memory));
    sf_writef_short(opened.get(), sound.data(), static_cast<sf_count_t>(sound.size()));
  }
  return memory.bytes;
}

}  // namespace saphira::speech
