#include "speech/shell/speech_shell.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "node_options.hpp"
#include "speech_for_tests.hpp"

namespace saphira::speech {
namespace {

/// Speech on a bus in memory: from a sound file, and to the sound of an answer.
class SpeechOnTheBus : public WithModel {
 protected:
  SpeechOptions options() {
    return {.grammar = test::source("config/grammars/flakey.grammar"),
            .pronunciations = test::source("config/speech/pronunciations.dict"),
            .microphone = folder.path("heard.wav"),
            .speaker = folder.path(""),
            .person = "Alice"};
  }
  void speak(const std::string& text) {
    std::ofstream(folder.path("heard.wav"), std::ios::binary) << wav(said_by("rms", text));
  }

  test::TempDir folder;
  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node person{test::memory_options("person"), memory};
  bus::Reader<v1::Utterance> heard = person.reader(bus::topics::kHeard);
  bus::Node service{test::memory_options("speech"), memory};
};

TEST_F(SpeechOnTheBus, AFileIsHeardOnceAndThenTheProgramEnds) {
  speak("flakey turn left");
  SpeechOptions once = options();
  once.speaker = "none";
  SpeechShell speech(service, once);
  speech.run(bus::Stop{});
  const auto utterances = heard.take();
  ASSERT_EQ(utterances.size(), 1U);
  EXPECT_EQ(utterances[0].data.text, "flakey turn left");
}

TEST_F(SpeechOnTheBus, AFileWithoutSoundEndsTheProgram) {
  std::ofstream(folder.path("heard.wav")) << "no sound";
  EXPECT_THROW(SpeechShell(service, options()), UnusableFile);
}

TEST_F(SpeechOnTheBus, WhatIsSpokenBecomesAnUtteranceAndTheAnswerIsSpoken) {
  speak("flakey turn left");
  SpeechShell speech(service, options());
  std::vector<v1::Utterance> utterances;
  ASSERT_TRUE(test::wait_until([&] {
    speech.step();
    for (const auto& sample : heard.take())
      utterances.push_back(sample.data);
    return !utterances.empty();
  }));
  EXPECT_EQ(utterances[0].text, "flakey turn left");
  EXPECT_EQ(utterances[0].speaker, "Alice");
  EXPECT_EQ(utterances[0].means, v1::UTTERANCE_SPOKEN);
  v1::Utterance answer{.id = {7, 1}, .text = "I turn 90 degrees to the left"};
  person.writer(bus::topics::kSaid).write(answer);
  const auto spoken = [&](const char* file) {
    try {
      return seconds(read_sound(read_bytes(folder.path(file)), file)) > 0.3;
    } catch (const std::runtime_error&) {
      return false;  // not written yet
    }
  };
  EXPECT_TRUE(test::wait_until([&] {
    speech.step();
    return spoken("0001.wav") && spoken("0002.wav");
  })) << "um, and the answer";
}

TEST_F(SpeechOnTheBus, WithoutASoundCardItSaysSoAndGoesOn) {
  SpeechOptions none = options();
  none.microphone = "no-such-device";
  none.speaker = "no-such-speaker";
  bus::Reader<v1::ServiceStatus> statuses = person.reader(bus::topics::kStatus);
  SpeechShell speech(service, none);
  bus::Stop stop;
  std::thread thread([&] { speech.run(stop); });
  std::string reason;
  EXPECT_TRUE(test::wait_until([&] {
    for (const auto& sample : statuses.take())
      if (sample.data.state == v1::SERVICE_DEGRADED)
        reason = sample.data.reason;
    return reason.find("no-such-device") != std::string::npos &&
           reason.find("no-such-speaker") != std::string::npos;
  })) << reason;
  stop.request();
  thread.join();
}

/// A loudspeaker that ALSA waits for, since nobody reads from its pipe.
TEST(SoundDevices, OneThatHangsIsNotSpeaking) {
  test::TempDir folder;
  const std::string pipe = folder.path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string file = folder.path("asound.conf");
  std::ofstream(file) << "</usr/share/alsa/alsa.conf>\n"
                         "pcm.hanging { type file slave.pcm null format raw file \"" +
                             pipe + "\" }\n";
  setenv("ALSA_CONFIG_PATH", file.c_str(), 1);
  {
    Speaker speaker("hanging", [](const std::string&) {});
    speaker.play(silence(0.1));
    EXPECT_TRUE(speaker.speaking());
    EXPECT_TRUE(test::wait_until([&] { return speaker.hangs(); }));
    EXPECT_FALSE(speaker.speaking());
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    EXPECT_TRUE(test::wait_until([&] { return !speaker.hangs(); })) << "it goes on";
    close(reader);
  }
  unsetenv("ALSA_CONFIG_PATH");
}

TEST_F(SpeechOnTheBus, OnlyADeviceCanBeMissing) {
  for (const std::string& name : {std::string("none"), std::string("-"), folder.path("")}) {
    EXPECT_EQ(microphone_trouble(name), "");
    EXPECT_EQ(speaker_trouble(name), "");
  }
  const std::string head = "the sound device \"no-such-device\" cannot be opened: ";
  const std::string microphone = microphone_trouble("no-such-device");
  EXPECT_TRUE(microphone.starts_with(head)) << microphone;
  EXPECT_NE(microphone.find(". Connect a microphone, or name one with --microphone"),
            std::string::npos)
      << microphone;
  const std::string speaker = speaker_trouble("no-such-device");
  EXPECT_TRUE(speaker.starts_with(head)) << speaker;
  EXPECT_NE(speaker.find(". Connect a loudspeaker, or name one with --speaker"), std::string::npos)
      << speaker;
}

}  // namespace
}  // namespace saphira::speech
