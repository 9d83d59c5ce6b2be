#include "saphira/speech/sound.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "saphira/speech/voice.hpp"
#include "trouble.hpp"

namespace saphira::speech {
namespace {

TEST(Sounds, AWavFileHoldsWhatWasPutIntoIt) {
  const Sound sound{0, 1, -1, 32767, -32768, 1234};
  EXPECT_EQ(read_wav(wav(sound), "a.wav"), sound);
}

TEST(Sounds, OfAnotherRateKeepTheirLength) {
  Sound sound(22050);
  for (std::size_t i = 0; i < sound.size(); ++i)
    sound[i] = static_cast<std::int16_t>(
        10000 * std::sin(2.0 * 3.14159265 * 100.0 * static_cast<double>(i) / 22050));
  const Sound here = resampled(sound, 22050);
  EXPECT_NEAR(seconds(here), 1.0, 0.001);
  EXPECT_NEAR(here[40], 10000 * std::sin(2.0 * 3.14159265 * 100.0 * 40 / kRate), 20);
}

TEST(Sounds, WhatIsNoWavFileIsRefusedWithWhy) {
  const std::string good = wav(Sound(10, 5));
  for (std::size_t cut = 0; cut < 44; ++cut)
    EXPECT_THROW(read_wav(good.substr(0, cut), "cut.wav"), std::runtime_error) << cut;
  std::string eight = good;
  eight[34] = 8;
  EXPECT_TRUE(test::has(test::trouble_of<std::runtime_error>([&] { read_wav(eight, "eight.wav"); }),
                        "eight.wav: its samples are of another kind"));
  // A stream of unknown length, and one that was cut.
  std::string endless = good;
  for (std::size_t i = 40; i < 44; ++i)
    endless[i] = static_cast<char>(0xff);
  EXPECT_EQ(read_wav(endless, "endless.wav").size(), 10u);
  EXPECT_EQ(read_wav(good.substr(0, good.size() - 5), "cut.wav").size(), 7u);
}

TEST(Voices, SpeakAtTheRateOfTheRecognizer) {
  for (const std::string& name : Voice::flite_voices()) {
    const double length = seconds(Voice(name).say("I turn left"));
    EXPECT_GT(length, 0.4) << name;
    EXPECT_LT(length, 3.0) << name;
  }
}

TEST(Voices, OneThatIsNotThereIsRefusedWithThoseThatAre) {
  for (const char* const name : {"bob", "espeak:", "espeak:x;rm", ""})
    EXPECT_THROW(Voice{name}, std::invalid_argument) << name;
}

}  // namespace
}  // namespace saphira::speech
