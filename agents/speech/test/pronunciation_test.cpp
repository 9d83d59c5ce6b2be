#include "saphira/speech/pronunciation.hpp"

#include <gtest/gtest.h>

#include "saphira/base/text.hpp"
#include "saphira/speech/voice.hpp"
#include "trouble.hpp"

namespace saphira::speech {
namespace {

/// A dictionary of a few words.
Phones few(const std::string& word) {
  static const std::map<std::string, Phones> known{
      {"two", {"T UW"}},          {"three", {"TH R IY"}},
      {"one", {"W AH N"}},        {"e", {"IY"}},
      {"j", {"JH EY"}},           {"a", {"AH", "EY"}},
      {"thirty", {"TH ER T IY"}}, {"hundred", {"HH AH N D R AH D"}},
      {"and", {"AE N D"}},        {"forty", {"F AO R T IY"}},
      {"five", {"F AY V"}}};
  const auto found = known.find(word);
  return found == known.end() ? Phones{} : found->second;
}

TEST(Pronunciations, AreThoseOfTheFileFirstThenOfTheDictionary) {
  const Pronunciations all(
      "# how we say it\nflakey F L EY K IY\nflakey F L AE K IY # or so\ntwo T UW UW\n", "f", few);
  EXPECT_EQ(all.of("flakey"), (Phones{"F L EY K IY", "F L AE K IY"}));
  EXPECT_EQ(all.of("two"), Phones{"T UW UW"});
  EXPECT_EQ(all.of("three"), Phones{"TH R IY"});
  EXPECT_EQ(all.of("a"), (Phones{"AH", "EY"}));
}

TEST(Pronunciations, OfAWordThatNobodyKnowsAreGuessed) {
  const Pronunciations all("", "f", few);
  EXPECT_EQ(all.of("flakey"), Phones{"F L EY K IY"});
  EXPECT_EQ(all.of("konolige").size(), 1u);
  EXPECT_EQ(all.of("forty-five"), Phones{"F AO R T IY F AY V"});
}

TEST(Pronunciations, OfACodeAreItsLettersAndTheWaysToSayItsNumber) {
  const Pronunciations all("", "f", few);
  EXPECT_EQ(all.of("ej-231"),
            (Phones{"IY JH EY T UW TH R IY W AH N", "IY JH EY T UW TH ER T IY W AH N",
                    "IY JH EY T UW HH AH N D R AH D TH ER T IY W AH N",
                    "IY JH EY T UW HH AH N D R AH D AE N D TH ER T IY W AH N"}));
  EXPECT_EQ(all.of("a1"), Phones{"EY W AH N"});
}

TEST(Pronunciations, AMistakeInTheFileIsNamedWithItsLine) {
  const auto error = [](const char* text) {
    return test::trouble_of<FileError>([&] { Pronunciations(text, "names.dict", few); });
  };
  EXPECT_NE(error("two T UW\nkurt K UR T\n").find("names.dict:2:8"), std::string::npos)
      << error("two T UW\nkurt K UR T\n");
  EXPECT_NE(error("kurt\n").find("expected the phones of kurt"), std::string::npos);
}

TEST(Spoken, CodesAreSpelledAndWordsAreNot) {
  EXPECT_EQ(spoken("I go to EJ-231."), "I go to e j two three one.");
  EXPECT_EQ(spoken("Karen's office, half-open"), "Karen's office, half-open");
  EXPECT_EQ(spoken("I turn 90 degrees"), "I turn 90 degrees");
}

}  // namespace
}  // namespace saphira::speech
