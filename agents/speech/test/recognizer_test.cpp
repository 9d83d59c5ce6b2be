#include "saphira/speech/recognizer.hpp"

#include "speech_for_tests.hpp"
#include "trouble.hpp"

namespace saphira::speech {
namespace {

class RecognizerTest : public WithRecognizer {
 protected:
  void SetUp() override {
    WithRecognizer::SetUp();
    if (!recognizer)
      return;
    std::vector<std::string> names = grammar.names();
    names.emplace_back("ej-231");
    recognizer->listen_for(grammar.graph(names, false));
  }
  /// The outcome and text of each utterance in it, such as "command: flakey turn left".
  std::vector<std::string> heard(const Sound& sound) {
    std::vector<Event> events = recognizer->hear(sound);
    const std::vector<Event> last = recognizer->end();
    events.insert(events.end(), last.begin(), last.end());
    std::vector<std::string> out;
    for (const Event& event : events)
      if (event.kind == Event::Kind::heard)
        out.push_back(word(event.heard.outcome) + std::string(": ") + event.heard.text);
    return out;
  }

  agent_interface::Grammar grammar = shipped_grammar();
};

TEST_F(RecognizerTest, CommandsAreUnderstoodWithTheNamesThatItListensFor) {
  for (const char* const voice : {"slt", "awb"}) {
    EXPECT_EQ(heard(said_by(voice, "flakey turn left")), Texts{"command: flakey turn left"});
    EXPECT_EQ(heard(said_by(voice, "flakey get the report from Karen")),
              Texts{"command: flakey get the report from karen"});
    EXPECT_EQ(heard(said_by(voice, "flakey this is John's office")),
              Texts{"command: flakey this is john's office"});
    EXPECT_EQ(heard(said_by(voice, "flakey drive to EJ-231")),
              Texts{"command: flakey drive to ej-231"});
  }
}

TEST_F(RecognizerTest, WhatBeginsWithoutTheKeywordIsNotForTheRobot) {
  for (const char* const text : {"turn left", "please follow me", "go to the kitchen",
                                 "get the report from Karen", "the weather is nice today"})
    EXPECT_EQ(heard(said_by("slt", text)), Texts{"not for it: "}) << text;
}

TEST_F(RecognizerTest, TheKeywordWithSomethingElseBehindItIsSaidSo) {
  for (const char* const text :
       {"flakey what is the capital of Australia", "flakey sing a song about elephants"})
    EXPECT_EQ(heard(said_by("slt", text)), Texts{"addressed: flakey"}) << text;
}

TEST_F(RecognizerTest, APauseAfterTheKeywordIsPartOfTheUtterance) {
  const Voice voice("slt");
  EXPECT_EQ(heard(joined({silence(0.4), voice.say("flakey"), silence(0.7), voice.say("turn left"),
                          silence(0.6)})),
            Texts{"command: flakey turn left"});
  EXPECT_EQ(heard(joined({silence(0.4), voice.say("flakey"), silence(3.0)})),
            Texts{"addressed: flakey"});
  // Speech after a longer pause is not part of the command.
  EXPECT_EQ(heard(joined({silence(0.4), voice.say("flakey"), silence(3.0), voice.say("turn left"),
                          silence(0.6)})),
            (Texts{"addressed: flakey", "not for it: "}));
}

TEST_F(RecognizerTest, InOneStreamEachUtteranceIsHeardOnceAndItsEndIsTold) {
  Sound stream;
  for (const char* const text :
       {"flakey go forward", "flakey stop", "turn left", "flakey turn right"})
    stream = joined({stream, said_by("slt", text), silence(0.6)});
  EXPECT_EQ(heard(stream), (Texts{"command: flakey go forward", "command: flakey stop",
                                  "not for it: ", "command: flakey turn right"}));
}

TEST_F(RecognizerTest, ACommandIsCertainWhereASecondHearingHasItToo) {
  const auto confidence = [&](const Sound& sound) {
    double newest = -1.0;
    for (const Event& event : recognizer->hear(sound))
      if (event.kind == Event::Kind::heard)
        newest = event.heard.confidence;
    return newest;
  };
  EXPECT_EQ(confidence(said_by("slt", "flakey turn left")), kCertain);
  EXPECT_EQ(confidence(said_by("slt", "flakey sing a song about elephants")), 0.5);
}

TEST_F(RecognizerTest, SilenceIsNoUtterance) {
  EXPECT_EQ(heard(silence(5.0)), Texts{});
}

TEST_F(RecognizerTest, AnotherGrammarTakesTheOldOnesPlace) {
  recognizer->listen_for(
      agent_interface::Grammar("keyword: robot\nwave() \"I wave\"\n  wave your hand\n", "a")
          .graph({}, false));
  EXPECT_EQ(heard(said_by("slt", "robot wave your hand")), Texts{"command: robot wave your hand"});
  EXPECT_NE(heard(said_by("slt", "robot turn left")), Texts{"command: robot turn left"});
}

TEST(RecognizerFiles, AModelThatIsMissingIsNamedWithItsPackage) {
  RecognizerSettings settings{.model = "/nowhere"};
  const std::string said = test::trouble_of<std::runtime_error>(
      [&] { Recognizer recognizer(settings, "", "pronunciations"); });
  EXPECT_TRUE(test::has(said, "/nowhere")) << said;
  EXPECT_TRUE(test::has(said, "pocketsphinx-en-us"));
}

}  // namespace
}  // namespace saphira::speech
