// The recognition of spoken commands: voices of flite and espeak-ng say the utterances of
// services/agent_interface/test/utterances.txt, clean and with noise, with the keyword and without.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "agent_interface/test/utterances.hpp"
#include "bench/study.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/random.hpp"
#include "saphira/base/text.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/speech/conversation.hpp"
#include "saphira/speech/voice.hpp"
#include "support/guarded.hpp"

namespace {

using namespace saphira;
using namespace saphira::speech;
using agent_interface::SaidAndMeant;

struct Options {
  std::string utterances = "services/agent_interface/test/utterances.txt";
  std::vector<std::string> seen{"slt", "rms", "awb", "kal16"};
  std::vector<std::string> unseen{"espeak:en-us+f2", "espeak:en-us+m3"};
  std::vector<std::string> sounds{"clean", "white", "babble"};
  int every = 2;
  double noise_db = 10.0;
  int seed = 7;
  bool each = false;
  bool json = false;
};

/// True where the recognizer listens for these words: a way leads through the graph.
bool is_listened_for(const agent_interface::WordGraph& graph,
                     const std::vector<std::string>& words) {
  std::vector<std::pair<int, std::size_t>> open{{agent_interface::WordGraph::kStart, 0}};
  std::set<std::pair<int, std::size_t>> seen;
  while (!open.empty()) {
    const auto [state, at] = open.back();
    open.pop_back();
    if (state == agent_interface::WordGraph::kEnd && at == words.size())
      return true;
    if (!seen.insert({state, at}).second)
      continue;
    for (const auto& arc : graph.arcs)
      if (arc.from == state && (arc.word.empty() || (at < words.size() && arc.word == words[at])))
        open.emplace_back(arc.to, arc.word.empty() ? at : at + 1);
  }
  return false;
}

/// The phrases of the file with the keyword, without its section of replies: commands that the
/// recognizer listens for, and sentences without a meaning, which is empty.
std::vector<SaidAndMeant> phrases(const std::string& file,
                                  const agent_interface::WordGraph& graph) {
  std::vector<SaidAndMeant> all;
  for (SaidAndMeant& phrase : agent_interface::read_utterances(read_file(file))) {
    if (phrase.reply || phrase.meaning == "nothing")
      continue;
    if (phrase.meaning == "what?" || phrase.meaning == "ambiguous")
      phrase.meaning.clear();
    else if (!is_listened_for(graph, agent_interface::words_of(phrase.text)))
      continue;
    all.push_back(phrase);
  }
  return all;
}

/// Names in the utterances that are not in a shipped list.
std::vector<std::string> names(const agent_interface::Grammar& grammar) {
  std::vector<std::string> all = grammar.names();
  for (const char* const name : {"ej-231", "ej-241", "ej-243", "ej-245", "ej-247", "bob", "mr alda",
                                 "conference room", "file"})
    all.emplace_back(name);
  return all;
}

/// A wrong command that costs little.
constexpr const char* kStop = "stop()";

/// Stops that need no keyword.
constexpr std::array kLoneStops{
    "Stop!",          "Stop, stop!", "Stop stop stop",   "Hey, stop!",  "Please stop", "Stop now",
    "Stop it",        "No, stop",    "Stop right there", "Help! Stop!", "Halt!",       "Freeze!",
    "Emergency stop", "Stop moving", "Watch out, stop",  "Stop, please"};
/// Speech to other people, most of it near such a stop.
constexpr const char* kOtherSpeech =
    "Shop; Top; Stock; Step; Stopped; Start; Start now; Stuff; Star; Spot; Don't stop; "
    "Never stop; Stop talking; Did it stop; It stopped; A stop sign; "
    "The bus stop is over there; We can stop here and have lunch; The top shelf; Hold; "
    "Hall; Three; Breeze; Please; Hello; Good morning; Okay; Not now; Yes; No; "
    "The shop is closed; The weather is nice today; I was at the station on Tuesday";

double power(const Sound& sound) {
  double sum = 0.0;
  for (const std::int16_t sample : sound)
    sum += static_cast<double>(sample) * sample;
  return sum / static_cast<double>(std::max<std::size_t>(1, sound.size()));
}

constexpr std::size_t kBefore = kRate * 2 / 5;  // samples of silence before the voice

enum class Noise { none, white, babble };
constexpr std::array kNoises{Noise::none, Noise::white, Noise::babble};
constexpr std::array kNames{"clean", "white", "babble"};

/// Several people who talk at once about something else.
Sound babble_of_people() {
  const std::vector<std::string>& voices = Voice::flite_voices();
  constexpr const char* kTalk =
      "The meeting on the budget of the laboratory was moved to the afternoon, since nobody had "
      "read the paper by then. She told them about her holidays at the lake and the weather, which "
      "had been awful until Sunday. Please put two sandwiches and an apple into the box, and close "
      "the window on your right when you leave. In this chapter we turn to the question of how an "
      "agent finds its way through a large building.";
  Sound all;
  for (std::size_t i = 0; i < voices.size(); ++i) {
    Sound one = Voice(voices[i]).say(kTalk);
    std::rotate(one.begin(),
                one.begin() + static_cast<std::ptrdiff_t>(i * one.size() / voices.size()),
                one.end());
    all.resize(i == 0 ? one.size() : std::min(all.size(), one.size()));
    for (std::size_t k = 0; k < all.size(); ++k)
      all[k] = static_cast<std::int16_t>(all[k] + one[k] / static_cast<int>(voices.size()));
  }
  return all;
}

/// Noise at this level below the voice: white noise over the whole sound, babble while the person
/// speaks.
void add_noise(Sound& sound, Noise noise, const Sound& babble, double voice_power,
               std::size_t voice_ends, double decibels, Random& random) {
  const bool white = noise == Noise::white;
  const double sigma =
      std::sqrt(voice_power / std::pow(10.0, decibels / 10.0) / (white ? 1.0 : power(babble)));
  std::size_t at =
      white ? 0
            : static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(babble.size() - 1)));
  const std::size_t end = white ? sound.size() : voice_ends;
  for (std::size_t i = white ? 0 : kBefore; i < end; ++i)
    sound[i] = static_cast<std::int16_t>(
        std::clamp(sound[i] + sigma * (white ? random.normal() : babble[at++ % babble.size()]),
                   -32768.0, 32767.0));
}

/// Nearly silent samples at the end.
std::size_t silent_end(const Sound& sound) {
  std::size_t count = 0;
  while (count < sound.size() && std::abs(sound[sound.size() - 1 - count]) < 300)
    ++count;
  return count;
}

/// Counts by name. Wrong: taken for another command than a stop, and certain. Asked back: a command
/// that is not certain. Near misses have the keyword, and meaningless words. Others: all that is no
/// stop.
using bench::Tally;

class Bench {
 public:
  explicit Bench(const Options& options)
      : options_(options),
        grammar_(read_file(config_folder() + "/grammars/flakey.grammar"), "flakey.grammar"),
        phrases_(phrases(options.utterances, grammar_.graph(names(grammar_), false))),
        babble_(babble_of_people()) {}

  Tally run(const std::string& name, Noise noise) {
    const std::string file = config_folder() + "/speech/pronunciations.dict";
    Recognizer recognizer({}, read_file(file), file);
    Conversation conversation(recognizer, grammar_);
    conversation.names(names(grammar_));
    const Voice voice(name);
    Random random(static_cast<std::uint64_t>(options_.seed));
    Tally tally;
    const auto hear = [&](const std::string& text) {
      const Sound said = voice.say(text);
      Sound sound(kBefore, 0);
      sound.insert(sound.end(), said.begin(), said.end());
      const std::size_t end = sound.size() - silent_end(said);
      sound.resize(sound.size() + static_cast<std::size_t>(2.2 * kRate), 0);
      if (noise != Noise::none)
        add_noise(sound, noise, babble_, power(said), end, options_.noise_db, random);
      std::string heard = understood(conversation, sound, end, noise == Noise::none);
      if (options_.each)
        std::fprintf(stderr, "%s: %s => %s%s\n", name.c_str(), text.c_str(), heard.c_str(),
                     heard.empty() || certain_ ? "" : "?");
      return heard;
    };
    const auto hear_other = [&](const std::string& text) {
      const std::string heard = hear(text);
      ++tally["others"];
      tally["false_stops"] += heard == kStop ? 1 : 0;
      return heard;
    };
    for (const char* const text : kLoneStops) {
      ++tally["lone_stops"];
      tally["lone_stops_right"] += hear(text) == kStop ? 1 : 0;
    }
    std::istringstream others(kOtherSpeech);
    for (std::string text; std::getline(others >> std::ws, text, ';');)
      hear_other(text);
    ++tally["others"];
    tally["false_stops"] += understood(conversation, babble_, 0, false) == kStop ? 1 : 0;
    for (std::size_t i = 0; i < phrases_.size(); i += static_cast<std::size_t>(options_.every)) {
      const SaidAndMeant& phrase = phrases_[i];
      if (phrase.meaning.empty() && noise != Noise::none)
        continue;
      const std::string heard =
          phrase.meaning == kStop ? hear(phrase.text) : hear_other(phrase.text);
      if (phrase.meaning.empty()) {
        ++tally["near_misses"];
        tally["near_misses_taken"] += !heard.empty() && heard != kStop && certain_ ? 1 : 0;
        tally["near_misses_asked"] += !heard.empty() && heard != kStop && !certain_ ? 1 : 0;
        continue;
      }
      tally["named_stops"] += phrase.meaning == kStop ? 1 : 0;
      tally["named_stops_right"] += phrase.meaning == kStop && heard == kStop ? 1 : 0;
      ++tally["commands"];
      const bool other = !heard.empty() && heard != phrase.meaning && heard != kStop;
      const bool asks = !certain_ && !heard.empty() && heard != kStop;
      tally["right"] += heard == phrase.meaning && !asks ? 1 : 0;
      tally["wrong"] += other && !asks ? 1 : 0;
      tally["asked_back"] += asks ? 1 : 0;
      tally["asked_wrong"] += asks && other ? 1 : 0;
      if (noise != Noise::none || phrase.meaning == kStop)
        continue;  // a stop needs no keyword
      ++tally["keyless"];
      tally["keyless_taken"] +=
          hear_other(phrase.text.substr(phrase.text.find(' ') + 1)).empty() ? 0 : 1;
    }
    return tally;
  }

  std::vector<double> um;  ///< [s] from the end of the voice, in the sound's own time

 private:
  /// The meaning of the first command in it; empty: none.
  std::string understood(Conversation& conversation, const Sound& sound, std::size_t voice_ends,
                         bool times) {
    constexpr std::size_t kBlock = kRate / 50;
    std::string meaning;
    for (std::size_t at = 0; at < sound.size(); at += kBlock) {
      const std::size_t to = std::min(sound.size(), at + kBlock);
      for (const Recognized& heard :
           conversation
               .hear(Sound(sound.begin() + static_cast<std::ptrdiff_t>(at),
                           sound.begin() + static_cast<std::ptrdiff_t>(to)),
                     false)
               .utterances) {
        if (heard.outcome != Outcome::command || !meaning.empty())
          continue;
        const auto what = grammar_.understand(heard.text);
        certain_ = heard.confidence >= kCertain;
        meaning = what.meanings.size() == 1 ? describe(what.meanings.front()) : "several meanings";
        if (times && to > voice_ends)
          um.push_back(static_cast<double>(to - voice_ends) / kRate);
      }
    }
    conversation.end();
    return meaning;
  }

  Options options_;
  agent_interface::Grammar grammar_;
  std::vector<SaidAndMeant> phrases_;
  Sound babble_;
  bool certain_ = false;  ///< of the newest command
};

int run(const Options& options) {
  Bench bench(options);
  Tally seen;
  Tally all[3];  // by kNoises
  nlohmann::json voices = nlohmann::json::array();
  const auto tell = [&](const std::string& voice, const char* how, const Tally& one) {
    nlohmann::json told(one.counts);
    told["voice"] = voice;
    told["sound"] = how;
    std::fprintf(stderr, "%s\n", told.dump().c_str());
    voices.push_back(told);
  };
  for (const bool unseen : {false, true})
    for (const std::string& voice : unseen ? options.unseen : options.seen)
      for (std::size_t i = 0; i < kNoises.size(); ++i) {
        if (std::find(options.sounds.begin(), options.sounds.end(), kNames[i]) ==
            options.sounds.end())
          continue;
        const Tally one = bench.run(voice, kNoises[i]);
        all[i].add(one);
        if (!unseen && kNoises[i] == Noise::none)
          seen.add(one);
        tell(voice, kNames[i], one);
      }
  auto& [clean, white, babble] = all;
  Tally noise = white;
  noise.add(babble);
  Tally unseen = clean;
  for (const auto& [name, count] : seen.counts)
    unseen[name] -= count;
  Tally any = clean;
  any.add(noise);
  const nlohmann::json result{
      {"named_stops", clean.share("named_stops_right", "named_stops")},
      {"named_stops_in_noise", noise.share("named_stops_right", "named_stops")},
      {"lone_stops", clean.share("lone_stops_right", "lone_stops")},
      {"lone_stops_in_noise", noise.share("lone_stops_right", "lone_stops")},
      {"false_stops", any.share("false_stops", "others")},
      {"accept_seen", seen.share("right", "commands")},
      {"accept_unseen", unseen.share("right", "commands")},
      {"false_accept", clean.share("keyless_taken", "keyless")},
      {"near_misses_asked", clean.share("near_misses_asked", "near_misses")},
      {"near_misses_taken", clean.share("near_misses_taken", "near_misses")},
      {"wrong_in_white_noise", white.share("wrong", "commands")},
      {"accept_in_white_noise", white.share("right", "commands")},
      {"wrong_in_babble", babble.share("wrong", "commands")},
      {"accept_in_babble", babble.share("right", "commands")},
      {"um_s_p50", test::quantile(bench.um, 0.5)},
      {"um_s_p95", test::quantile(bench.um, 0.95)},
      {"voices", voices}};
  bench::print(result, options.json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine app{"How well spoken commands are understood"};
  app.add_option("--utterances", options.utterances, "a file of what is said, and its meanings");
  app.add_option("--seen", options.seen, "voices that the recognizer was tuned with");
  app.add_option("--unseen", options.unseen, "other voices");
  app.add_option("--sound", options.sounds, "clean, white, babble: in which the voices are heard")
      .one_of({kNames.begin(), kNames.end()})
      .separated_by(',');
  app.add_option("--every", options.every, "takes one of so many utterances").in_range(1, 100);
  app.add_option("--noise", options.noise_db, "[dB] by which the noise is below the voice");
  app.add_option("--seed", options.seed, "of the noise");
  app.add_flag("--each", options.each, "each utterance and its meaning, on stderr");
  app.add_flag("--json", options.json, "one JSON object; progress goes to stderr");
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] { return run(options); });
}
