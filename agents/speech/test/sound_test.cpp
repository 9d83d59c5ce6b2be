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
  EXPECT_EQ(read_sound(wav(sound), "a.wav"), sound);
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

/// A WAV file at kRate; `coding`: 1 PCM, 3 floating point.
std::string wav_of(int coding, int bits, int channels, const std::string& samples,
                   bool extensible) {
  const auto put = [](std::size_t value, int count) {
    std::string bytes;
    for (int i = 0; i < count; ++i)
      bytes += static_cast<char>((value >> (8 * i)) & 0xffU);
    return bytes;
  };
  const auto frame = static_cast<std::size_t>(channels * bits / 8);
  std::string format = put(extensible ? 0xfffe : static_cast<std::size_t>(coding), 2) +
                       put(static_cast<std::size_t>(channels), 2) + put(kRate, 4) +
                       put(kRate * frame, 4) + put(frame, 2) +
                       put(static_cast<std::size_t>(bits), 2);
  if (extensible)
    format += put(22, 2) + put(static_cast<std::size_t>(bits), 2) + put(3, 4) +
              put(static_cast<std::size_t>(coding), 2) +
              std::string("\x00\x00\x00\x00\x10\x00\x80\x00\x00\xaa\x00\x38\x9b\x71", 14);
  const std::string body =
      "WAVEfmt " + put(format.size(), 4) + format + "data" + put(samples.size(), 4) + samples;
  return "RIFF" + put(body.size(), 4) + body;
}

TEST(Sounds, OfUsualRecordersAreRead) {
  const std::string stereo("\x00\x00\x00\x00\x34\x12\x01\x00\x00\x00\x00\xc0", 12);
  const std::string three_bytes("\x00\x34\x12\x00\x00\xc0", 6);
  const std::string floats("\x00\x00\x00\x3f\x00\x00\x00\xbf", 8);  // 0.5, -0.5
  for (const bool extensible : {false, true}) {
    const Sound second = read_sound(wav_of(1, 24, 2, stereo, extensible), "stereo.wav");
    EXPECT_EQ(second, (Sound{0x1234, -0x4000})) << "the loudest channel";
    EXPECT_EQ(read_sound(wav_of(1, 24, 1, three_bytes, extensible), "24.wav"),
              (Sound{0x1234, -0x4000}));
    const Sound half = read_sound(wav_of(3, 32, 1, floats, extensible), "float.wav");
    ASSERT_EQ(half.size(), 2u);
    EXPECT_NEAR(half[0], 0x4000, 1);
    EXPECT_NEAR(half[1], -0x4000, 1);
  }
}

TEST(Sounds, WhatIsNoneIsRefusedWithTheReason) {
  const std::string good = wav(Sound(10, 5));
  for (std::size_t cut = 0; cut < 44; ++cut)
    EXPECT_THROW(read_sound(good.substr(0, cut), "cut.wav"), std::runtime_error) << cut;
  EXPECT_TRUE(test::has(
      test::trouble_of<std::runtime_error>([] { read_sound("\x89PNG and more", "picture.png"); }),
      "picture.png: "));
  std::string telephone = good;
  telephone[24] = 0x40;  // 8000 samples a second
  telephone[25] = 0x1f;
  EXPECT_TRUE(test::has(
      test::trouble_of<std::runtime_error>([&] { read_sound(telephone, "telephone.wav"); }),
      "expected 11025 to 200000 samples a second, found 8000"));
  // A stream of unknown length, and one that was cut.
  std::string endless = good;
  for (std::size_t i = 40; i < 44; ++i)
    endless[i] = static_cast<char>(0xff);
  EXPECT_EQ(read_sound(endless, "endless.wav").size(), 10u);
  EXPECT_EQ(read_sound(good.substr(0, good.size() - 5), "cut.wav").size(), 7u);
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
