#pragma once

#include <memory>
#include <string>
#include <vector>

#include "saphira/agent_interface/grammar.hpp"
#include "saphira/speech/pronunciation.hpp"
#include "saphira/speech/sound.hpp"

namespace saphira::speech {

/// The result of recognizing an utterance.
enum class Outcome {
  command,     ///< the grammar accepts all of it
  addressed,   ///< it began with the keyword, and the rest is not understood
  not_for_it,  ///< no keyword
};
const char* word(Outcome outcome);

inline constexpr double kCertain = 1.0;
inline constexpr double kUncertain = 0.6;  // the dialogue asks back before it acts

struct Recognized {
  Outcome outcome = Outcome::not_for_it;
  std::string text;  ///< in the grammar's form: "flakey turn left"; for `addressed` the keyword
  double confidence = 0.0;  ///< [0..1] kCertain: a second hearing has the same text
  /// Of a short utterance that is no certain command: orders such as "stop" that its sound
  /// contains,
  std::vector<std::string> spotted{};
  /// and then its words, heard without the grammar.
  std::vector<std::string> freely{};
};

/// The result for a stretch of sound.
struct Event {
  enum class Kind {
    begins,  ///< speech has begun
    ends,    ///< speech has stopped: the moment for an "um"
    heard,   ///< the utterance
  };
  Kind kind = Kind::begins;
  Recognized heard{};
};

struct RecognizerSettings {
  std::string model = "/usr/share/pocketsphinx/model/en-us";  ///< folder of Debian's
                                                              ///< pocketsphinx-en-us
  /// Natural logarithms of the likelihood of beginning, and of each phone of, words outside of the
  /// grammar: without the keyword and after it. Lower: more utterances count as commands.
  double without_keyword = -2.0;
  double behind_keyword = -7.0;
  /// The same for other words in place of the keyword: "please follow me" is not far from "flakey
  /// follow me".
  double instead_of_keyword = -5.0;
  /// The same for an urgent order, such as a stop, behind such words after the keyword.
  double alone_behind = -4.0;
  double each_phone = -1.0;
  double least_voice = 3.0;  ///< [1] of the energy of the noise: -vad_threshold
  int pause = 40;            ///< [10 ms] of silence that ends an utterance
  /// [s] after the keyword alone in which further words belong to it: "Flakey, ... turn left".
  double attention = 1.5;
  double longest_alone = 5.0;  ///< [s] of an order without the keyword, with the silence around it
};

/// Speech to words, by pocketsphinx with a grammar between two loops of phones. Words outside of
/// the grammar match these loops, so that they do not become a command (measured before: of 175
/// utterances without the keyword, the grammar alone took 115 for commands). Not thread-safe.
class Recognizer {
 public:
  /// `pronunciations`: the text of a file, see Pronunciations. std::runtime_error for an unreadable
  /// model.
  Recognizer(RecognizerSettings settings, std::string_view pronunciations, const std::string& file);
  ~Recognizer();

  /// Used from the next utterance on.
  void listen_for(const agent_interface::WordGraph& graph);

  /// The next piece of one stream of sound.
  std::vector<Event> hear(const Sound& sound);
  /// The stream has ended, or is interrupted: returns the speech so far.
  std::vector<Event> end();

  /// True while a person speaks, or has addressed the robot a moment ago.
  bool in_speech() const;

 private:
  struct Self;
  std::unique_ptr<Self> self_;
};

}  // namespace saphira::speech
