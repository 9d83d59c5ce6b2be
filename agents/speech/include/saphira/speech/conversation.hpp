#pragma once

#include <optional>
#include <string>
#include <vector>

#include "saphira/agent_interface/grammar.hpp"
#include "saphira/speech/recognizer.hpp"

namespace saphira::speech {

/// Controls when the microphone is heard, and for which words: half duplex, so that the robot does
/// not hear itself, and with replies while it waits for one. Time is that of the sound.
class Conversation {
 public:
  Conversation(Recognizer& recognizer, agent_interface::Grammar grammar);

  void use(agent_interface::Grammar grammar);
  /// Names of the map, beside the grammar's own.
  void names(std::vector<std::string> names);

  /// The robot begins to speak. A question waits for replies.
  void said(const std::string& text);

  struct Outputs {
    bool um = false;                     ///< to be said at once: it has heard, and processes
    std::vector<Recognized> utterances;  ///< for the topic; a keyword alone was not understood
  };
  /// speaking: the robot itself speaks, in this piece of the stream.
  Outputs hear(const Sound& sound, bool speaking);
  /// The stream is at its end.
  Outputs end();

 private:
  void listen();
  std::string missed_stop(const Recognized& heard) const;
  Outputs take(const std::vector<Event>& events);

  Recognizer& recognizer_;
  agent_interface::Grammar grammar_;
  std::vector<std::string> names_;
  double deaf_ = 0.0;     ///< [s] remaining time of its own echo
  double replies_ = 0.0;  ///< [s] remaining time in which a reply needs no keyword
  std::optional<bool> listens_for_replies_;
};

}  // namespace saphira::speech
