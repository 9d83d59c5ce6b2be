#include "saphira/speech/reading.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "saphira/speech/voice.hpp"
#include "trouble.hpp"

namespace saphira::speech {
namespace {

TEST(Reading, EverySpeakerKeepsAVoiceOfTheirOwn) {
  const auto passages = read_aloud(
      "alice: Flakey, stop\nflakey: I stop\n\njohn: Flakey, stop\nalice: Flakey, stop\n");
  ASSERT_EQ(passages.size(), 4U);
  EXPECT_EQ(passages[0].speaker, "alice");
  // flite adds noise of its own to each: a voice is recognized by its duration.
  const auto length = [](const char* voice, const char* text) {
    return Voice(voice).say(text).size();
  };
  EXPECT_EQ(passages[0].sound.size(), length("slt", "Flakey, stop"));
  EXPECT_EQ(passages[1].sound.size(), length("kal16", "I stop"));
  EXPECT_EQ(passages[2].sound.size(), length("rms", "Flakey, stop"));
  EXPECT_EQ(passages[3].sound.size(), passages[0].sound.size());
  EXPECT_NE(passages[2].sound.size(), passages[0].sound.size());
  double alone = 0.0;
  for (const Passage& passage : passages)
    alone += seconds(passage.sound);
  EXPECT_NEAR(seconds(joined(passages)), alone + 4 * 0.5, 0.001);
}

TEST(Reading, ALineWithoutASpeakerIsNamed) {
  const std::string said =
      test::trouble_of<std::invalid_argument>([] { read_aloud("alice: hello\nhello\n"); });
  EXPECT_TRUE(said.starts_with("line 2: ")) << said;
}

}  // namespace
}  // namespace saphira::speech
