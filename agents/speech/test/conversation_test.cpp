#include "saphira/speech/conversation.hpp"

#include "speech_for_tests.hpp"

namespace saphira::speech {
namespace {

class ConversationTest : public WithRecognizer {
 protected:
  void SetUp() override {
    WithRecognizer::SetUp();
    if (recognizer)
      conversation = std::make_unique<Conversation>(*recognizer, shipped_grammar());
  }
  /// In pieces of 0.1 s, as from a device.
  std::vector<std::string> hear(const Sound& sound, bool speaking = false) {
    std::vector<std::string> all;
    ums = 0;
    for (std::size_t at = 0; at < sound.size(); at += kRate / 10) {
      const auto end = std::min(sound.size(), at + kRate / 10);
      const Conversation::Outputs out =
          conversation->hear(Sound(sound.begin() + static_cast<std::ptrdiff_t>(at),
                                   sound.begin() + static_cast<std::ptrdiff_t>(end)),
                             speaking);
      for (const Recognized& one : out.utterances)
        all.push_back(one.text);
      ums += out.um ? 1 : 0;
    }
    return all;
  }

  std::unique_ptr<Conversation> conversation;
  int ums = 0;
};

TEST_F(ConversationTest, ItSaysUmToWhatIsForTheRobotOnly) {
  EXPECT_EQ(hear(said_by("slt", "flakey turn left")), Texts{"flakey turn left"});
  EXPECT_EQ(ums, 1);
  EXPECT_EQ(hear(said_by("slt", "turn left")), Texts{});
  EXPECT_EQ(ums, 0);
  EXPECT_EQ(hear(said_by("slt", "flakey sing a song about elephants")), Texts{"flakey"});
  EXPECT_EQ(ums, 1);
}

TEST_F(ConversationTest, AStopByItselfNeedsNoKeyword) {
  for (const char* const voice : {"slt", "awb"}) {
    for (const char* const text : {"Stop!", "stop stop stop", "please stop", "Hey, stop!",
                                   "stop moving", "stop right there"}) {
      EXPECT_EQ(hear(said_by(voice, text)), Texts{"stop"}) << voice << ": " << text;
      EXPECT_EQ(ums, 1);
    }
    EXPECT_EQ(hear(said_by(voice, "Freeze!")), Texts{"freeze"}) << voice;
  }
  conversation->said("Karen, do you have the report?");
  EXPECT_EQ(hear(said_by("slt", "stop")), Texts{"stop"}) << "no reply";
}

TEST_F(ConversationTest, WordsNearAStopAreNone) {
  for (const char* const text : {"don't stop", "stop talking", "the bus stop is over there", "shop",
                                 "the weather is nice today"})
    EXPECT_EQ(hear(said_by("rms", text)), Texts{}) << text;
}

TEST_F(ConversationTest, AFileMayEndWithItsLastWord) {
  EXPECT_EQ(hear(Voice("slt").say("Flakey, stop")), Texts{});
  const Conversation::Outputs last = conversation->end();
  ASSERT_EQ(last.utterances.size(), 1U);
  EXPECT_EQ(last.utterances[0].text, "flakey stop");
}

TEST_F(ConversationTest, ItDoesNotHearItself) {
  EXPECT_EQ(hear(said_by("slt", "flakey turn left"), true), Texts{});
  EXPECT_EQ(hear(said_by("slt", "flakey turn right")), Texts{"flakey turn right"});
}

TEST_F(ConversationTest, AReplyNeedsNoKeywordForAWhileAfterAQuestion) {
  const Sound yes = said_by("slt", "yes please");
  EXPECT_EQ(hear(yes), Texts{});
  conversation->said("Karen, do you have the report?");
  EXPECT_EQ(hear(yes), Texts{"yes please"});
  hear(silence(25.0));
  EXPECT_EQ(hear(yes), Texts{});
  conversation->said("what?");
  EXPECT_EQ(hear(yes), Texts{}) << "that asks for the command";
}

TEST_F(ConversationTest, NamesOfTheMapCanBeSpoken) {
  conversation->names({"EJ-231", "Machine Room"});
  EXPECT_EQ(hear(said_by("slt", "flakey drive to the machine room")),
            Texts{"flakey drive to the machine room"});
  EXPECT_EQ(hear(said_by("slt", "flakey drive to EJ-231")), Texts{"flakey drive to ej-231"});
}

}  // namespace
}  // namespace saphira::speech
