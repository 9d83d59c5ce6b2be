#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>

#include "saphira/base/watched_folder.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/bus/topics.hpp"
#include "saphira/speech/conversation.hpp"
#include "saphira/speech/voice.hpp"
#include "speech/shell/audio.hpp"

namespace saphira::speech {

struct SpeechOptions {
  std::string grammar;         ///< a file
  std::string pronunciations;  ///< a file
  std::string microphone = "default";
  std::string speaker = "default";
  std::string voice = "slt";
  std::string person;  ///< the speaker, if known
};

/// Speech on the bus: recognized speech becomes utterances, and the robot's utterances are spoken.
class SpeechShell {
 public:
  /// FileError, std::runtime_error or std::invalid_argument for a wrong file, model or voice.
  SpeechShell(bus::Node& node, const SpeechOptions& options);

  void step();
  void run(const bus::Stop& stop);

 private:
  void tell(const Conversation::Outputs& out);
  void reload();
  void report();

  bus::Node& node_;
  SpeechOptions options_;
  Recognizer recognizer_;
  Conversation conversation_;
  Voice voice_;
  Sound um_;
  WatchedFolder folder_;
  bus::Reader<v1::FloorMap> maps_ = node_.reader(bus::topics::kMap);
  bus::Reader<v1::Utterance> said_ = node_.reader(bus::topics::kSaid);
  bus::Writer<v1::Utterance> heard_ = node_.writer(bus::topics::kHeard);
  std::uint64_t number_ = 0;
  std::mutex mutex_;
  std::string microphone_trouble_;  ///< of the threads; guarded, with the next
  std::string speaker_trouble_;
  std::string told_ = "?";
  std::optional<std::chrono::steady_clock::time_point> ended_{};  ///< the sound of a file or pipe
  Microphone microphone_;
  Speaker speaker_;
};

}  // namespace saphira::speech
