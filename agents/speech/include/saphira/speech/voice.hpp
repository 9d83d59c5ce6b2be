#pragma once

#include <memory>
#include <string>
#include <vector>

#include "saphira/speech/sound.hpp"

namespace saphira::speech {

/// The spoken form of a text: "EJ-231" becomes "e j two three one".
std::string spoken(const std::string& text);

/// Text to speech: flite in this process ("slt", "rms", "awb", "kal16"), or espeak-ng as a program
/// ("espeak:en-us", "espeak:en-gb+f3").
class Voice {
 public:
  /// std::invalid_argument lists the voices.
  explicit Voice(const std::string& name);
  ~Voice();
  Voice(Voice&&) noexcept;
  Voice& operator=(Voice&&) noexcept;

  /// std::runtime_error where espeak-ng cannot be run.
  Sound say(const std::string& text) const;

  static const std::vector<std::string>& flite_voices();

 private:
  struct Self;
  std::unique_ptr<Self> self_;
};

}  // namespace saphira::speech
