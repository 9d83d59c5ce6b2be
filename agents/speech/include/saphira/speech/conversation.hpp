#pragma once

#include <optional>
#include <string>
#include <vector>

#include "saphira/agent_interface/grammar.hpp"
#include "saphira/speech/recognizer.hpp"

namespace saphira::speech {

/// The words that the microphone is listened for, and when: half duplex, so that the robot does not
/// hear itself, and with replies while it waits for one. Time is that of the sound.
class Conversation {
 public:
  Conversation(Recognizer& recognizer, agent_interface::Grammar grammar);

  void use(agent_interface::Grammar grammar);
  /// Of the map: what may be spoken of beside the grammar's own names.
  void names(std::vector<std::string> names);

  /// The robot begins to say something. A question waits for replies.
  void said(const std::string& text);

  struct Outputs {
    bool um = false;                      ///< to be said at once: it has heard, and thinks
    std::vector<std::string> utterances;  ///< for the topic; a keyword alone was not understood
  };
  /// speaking: the robot itself, in this piece of the stream.
  Outputs hear(const Sound& sound, bool speaking);
  /// The stream is at its end.
  Outputs end();

 private:
  void listen();
  Outputs take(const std::vector<Event>& events);

  Recognizer& recognizer_;
  agent_interface::Grammar grammar_;
  std::vector<std::string> names_;
  double deaf_ = 0.0;     ///< [s] for how long still it would hear its own echo
  double replies_ = 0.0;  ///< [s] for how long still a reply needs no keyword
  std::optional<bool> listens_for_replies_;
};

}  // namespace saphira::speech
