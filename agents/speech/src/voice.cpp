#include "saphira/speech/voice.hpp"

#include <flite/flite.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <mutex>
#include <stdexcept>

#include "saphira/speech/pronunciation.hpp"

extern "C" {
cst_voice* register_cmu_us_slt(const char* folder);
cst_voice* register_cmu_us_rms(const char* folder);
cst_voice* register_cmu_us_awb(const char* folder);
cst_voice* register_cmu_us_kal16(const char* folder);
}

namespace saphira::speech {
namespace {

constexpr const char* kEspeak = "espeak:";

bool is_safe(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '+' || c == '_';
}

/// The standard output of a command. `words` have passed is_safe().
std::string output_of(const std::string& command) {
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr)
    throw std::runtime_error("cannot run " + command);
  std::string out;
  std::array<char, 4096> block{};
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
    out.append(block.data(), n);
  if (pclose(pipe) != 0)
    throw std::runtime_error("failed: " + command + " (is espeak-ng installed?)");
  return out;
}

}  // namespace

std::string spoken(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) != 0 ||
                                 (text[end] == '-' && end + 1 < text.size())))
      ++end;
    const std::string word = text.substr(i, end - i);
    if (is_code(word)) {
      out += spelled(word);
    } else if (end > i) {
      out += word;
    } else {
      out += text[end++];
    }
    i = end;
  }
  return out;
}

struct Voice::Self {
  cst_voice* flite = nullptr;
  std::string espeak;
};

const std::vector<std::string>& Voice::flite_voices() {
  static const std::vector<std::string> names{"slt", "rms", "awb", "kal16"};
  return names;
}

Voice::Voice(const std::string& name) : self_(std::make_unique<Self>()) {
  static std::once_flag once;
  std::call_once(once, [] { flite_init(); });
  if (name.rfind(kEspeak, 0) == 0) {
    self_->espeak = name.substr(std::string(kEspeak).size());
    if (self_->espeak.empty() || !std::ranges::all_of(self_->espeak, is_safe))
      throw std::invalid_argument("voice \"" + name + "\": expected a name such as espeak:en-us");
    return;
  }
  self_->flite = name == "slt"     ? register_cmu_us_slt(nullptr)
                 : name == "rms"   ? register_cmu_us_rms(nullptr)
                 : name == "awb"   ? register_cmu_us_awb(nullptr)
                 : name == "kal16" ? register_cmu_us_kal16(nullptr)
                                   : nullptr;
  if (self_->flite == nullptr)
    throw std::invalid_argument("there is no voice \"" + name +
                                "\": there are slt, rms, awb, kal16 and espeak:NAME");
}
Voice::~Voice() = default;
Voice::Voice(Voice&&) noexcept = default;
Voice& Voice::operator=(Voice&&) noexcept = default;

Sound Voice::say(const std::string& text) const {
  const std::string words = spoken(text);
  if (self_->flite == nullptr) {
    std::string safe;
    for (const char c : words)
      safe +=
          is_safe(c) || c == '\'' || c == ',' || c == '.' || c == '?' ? (c == '\'' ? ' ' : c) : ' ';
    return read_sound(
        output_of("espeak-ng -v " + self_->espeak + " --stdout -- '" + safe + "' 2>/dev/null"),
        "espeak-ng");
  }
  cst_wave* const wave = flite_text_to_wave(words.c_str(), self_->flite);
  if (wave == nullptr)
    throw std::runtime_error("flite has no sound for \"" + words + "\"");
  const Sound sound(wave->samples, wave->samples + wave->num_samples);
  const int rate = wave->sample_rate;
  delete_wave(wave);
  return resampled(sound, rate);
}

}  // namespace saphira::speech
