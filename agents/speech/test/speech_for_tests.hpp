#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/speech/recognizer.hpp"
#include "saphira/speech/voice.hpp"

namespace saphira::speech {

inline bool has_model() {
  return std::filesystem::exists(RecognizerSettings{}.model + "/en-us");
}

inline Sound silence(double seconds) {
  return Sound(static_cast<std::size_t>(seconds * kRate), 0);
}

inline Sound joined(std::initializer_list<Sound> parts) {
  Sound all;
  for (const Sound& part : parts)
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// As from a microphone: some silence before and after.
inline Sound said_by(const std::string& voice, const std::string& text) {
  return joined({silence(0.4), Voice(voice).say(text), silence(0.6)});
}

inline agent_interface::Grammar shipped_grammar() {
  const std::string file = test::source("config/grammars/flakey.grammar");
  return {read_file(file), file};
}

/// Tests that need the recognizer's model, which is in a separate Debian package.
class WithModel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_model())
      GTEST_SKIP() << "the Debian package pocketsphinx-en-us is not installed";
  }
  static std::string pronunciations() {
    return read_file(test::source("config/speech/pronunciations.dict"));
  }
};

class WithRecognizer : public WithModel {
 protected:
  void SetUp() override {
    WithModel::SetUp();
    if (!IsSkipped())
      recognizer =
          std::make_unique<Recognizer>(RecognizerSettings{}, pronunciations(), "pronunciations");
  }
  using Texts = std::vector<std::string>;

  std::unique_ptr<Recognizer> recognizer;
};

}  // namespace saphira::speech
