// The recognition of spoken commands: voices of flite and espeak-ng say the utterances of
// services/agent_interface/test/utterances.txt, clean and with noise, with the keyword and without.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "saphira/base/places.hpp"
#include "saphira/base/random.hpp"
#include "saphira/base/text.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/speech/recognizer.hpp"
#include "saphira/speech/voice.hpp"
#include "support/guarded.hpp"
#include "support/quantile.hpp"

namespace {

using namespace saphira;
using namespace saphira::speech;

struct Options {
  std::string utterances = "services/agent_interface/test/utterances.txt";
  std::vector<std::string> seen{"slt", "rms", "awb", "kal16"};
  std::vector<std::string> unseen{"espeak:en-us+f2", "espeak:en-us+m3"};
  int every = 2;
  double noise_db = 10.0;
  bool json = false;
};

struct Phrase {
  std::string text;
  std::string meaning;  ///< empty: none
};

/// The phrases of the file with the keyword, without its section of replies.
std::vector<Phrase> phrases(const std::string& file) {
  std::vector<Phrase> all;
  std::istringstream lines(read_file(file));
  bool replies = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') {
      replies = line == "# Where the robot has asked";
      continue;
    }
    const std::size_t arrow = line.find(" => ");
    if (replies || arrow == std::string::npos)
      continue;
    const std::string meaning = line.substr(arrow + 4);
    if (meaning == "nothing")
      continue;
    all.push_back({line.substr(0, arrow),
                   meaning == "what?" || meaning == "ambiguous" ? std::string() : meaning});
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

double power(const Sound& sound) {
  double sum = 0.0;
  for (const std::int16_t sample : sound)
    sum += static_cast<double>(sample) * sample;
  return sum / static_cast<double>(std::max<std::size_t>(1, sound.size()));
}

/// White noise at this level below the voice, over the whole sound.
void add_noise(Sound& sound, double voice_power, double decibels, Random& random) {
  const double sigma = std::sqrt(voice_power / std::pow(10.0, decibels / 10.0));
  for (std::int16_t& sample : sound)
    sample =
        static_cast<std::int16_t>(std::clamp(sample + sigma * random.normal(), -32768.0, 32767.0));
}

/// Nearly silent samples at the end.
std::size_t silent_end(const Sound& sound) {
  std::size_t count = 0;
  while (count < sound.size() && std::abs(sound[sound.size() - 1 - count]) < 300)
    ++count;
  return count;
}

struct Tally {
  int commands = 0;
  int right = 0;
  int wrong = 0;
  int near_misses = 0;  ///< with the keyword, and meaningless words
  int taken = 0;        ///< of them, accepted as a command
  int keyless = 0;
  int keyless_taken = 0;
};

class Bench {
 public:
  explicit Bench(const Options& options)
      : options_(options),
        grammar_(read_file(config_folder() + "/grammars/flakey.grammar"), "flakey.grammar"),
        phrases_(phrases(options.utterances)) {}

  /// noise: in decibels below the voice.
  Tally run(const std::string& name, std::optional<double> noise) {
    const std::string file = config_folder() + "/speech/pronunciations.dict";
    Recognizer recognizer({}, read_file(file), file);
    recognizer.listen_for(grammar_.graph(names(grammar_), false));
    const Voice voice(name);
    Random random(7);
    Tally tally;
    const auto hear = [&](const std::string& text) {
      const Sound said = voice.say(text);
      Sound sound(static_cast<std::size_t>(0.4 * kRate), 0);
      sound.insert(sound.end(), said.begin(), said.end());
      const std::size_t end = sound.size() - silent_end(said);
      sound.resize(sound.size() + static_cast<std::size_t>(2.2 * kRate), 0);
      if (noise)
        add_noise(sound, power(said), *noise, random);
      return understood(recognizer, sound, end, !noise);
    };
    for (std::size_t i = 0; i < phrases_.size(); i += static_cast<std::size_t>(options_.every)) {
      const Phrase& phrase = phrases_[i];
      const std::string heard = hear(phrase.text);
      if (phrase.meaning.empty()) {
        ++tally.near_misses;
        tally.taken += heard.empty() ? 0 : 1;
        continue;
      }
      ++tally.commands;
      tally.right += heard == phrase.meaning ? 1 : 0;
      tally.wrong += !heard.empty() && heard != phrase.meaning ? 1 : 0;
      ++tally.keyless;
      tally.keyless_taken += hear(phrase.text.substr(phrase.text.find(' ') + 1)).empty() ? 0 : 1;
    }
    return tally;
  }

  std::vector<double> um;  ///< [s] from the end of the voice, in the sound's own time

 private:
  /// The meaning of the first command in it; empty: none.
  std::string understood(Recognizer& recognizer, const Sound& sound, std::size_t voice_ends,
                         bool times) {
    constexpr std::size_t kBlock = kRate / 50;
    std::string meaning;
    for (std::size_t at = 0; at < sound.size(); at += kBlock) {
      const std::size_t to = std::min(sound.size(), at + kBlock);
      for (const Event& event :
           recognizer.hear(Sound(sound.begin() + static_cast<std::ptrdiff_t>(at),
                                 sound.begin() + static_cast<std::ptrdiff_t>(to)))) {
        if (event.kind != Event::Kind::heard || event.heard.outcome != Outcome::command ||
            !meaning.empty())
          continue;
        const auto what = grammar_.understand(event.heard.text);
        meaning = what.meanings.size() == 1 ? describe(what.meanings.front()) : "several meanings";
        if (times && to > voice_ends)
          um.push_back(static_cast<double>(to - voice_ends) / kRate);
      }
    }
    recognizer.end();
    return meaning;
  }

  Options options_;
  agent_interface::Grammar grammar_;
  std::vector<Phrase> phrases_;
};

double share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : 0.0;
}

int run(const Options& options) {
  Bench bench(options);
  Tally all[2];  // seen, unseen
  Tally noisy;
  nlohmann::json voices = nlohmann::json::array();
  const auto add = [](Tally& sum, const Tally& one) {
    sum.commands += one.commands;
    sum.right += one.right;
    sum.wrong += one.wrong;
    sum.near_misses += one.near_misses;
    sum.taken += one.taken;
    sum.keyless += one.keyless;
    sum.keyless_taken += one.keyless_taken;
  };
  const auto tell = [&](const std::string& voice, const char* how, const Tally& one) {
    std::fprintf(options.json ? stderr : stdout,
                 "%-16s %-12s right %3d of %3d, wrong %2d; taken for a command: %d of %d without "
                 "the keyword, %d of %d near misses\n",
                 voice.c_str(), how, one.right, one.commands, one.wrong, one.keyless_taken,
                 one.keyless, one.taken, one.near_misses);
    std::fflush(stdout);
    voices.push_back({{"voice", voice},
                      {"sound", how},
                      {"commands", one.commands},
                      {"right", one.right},
                      {"wrong", one.wrong},
                      {"keyless_taken", one.keyless_taken},
                      {"near_misses", one.near_misses},
                      {"near_misses_taken", one.taken}});
  };
  for (const bool unseen : {false, true})
    for (const std::string& voice : unseen ? options.unseen : options.seen) {
      const Tally clean = bench.run(voice, std::nullopt);
      add(all[unseen ? 1 : 0], clean);
      tell(voice, unseen ? "clean, new" : "clean", clean);
      const Tally noise = bench.run(voice, options.noise_db);
      add(noisy, noise);
      tell(voice, "with noise", noise);
    }
  const nlohmann::json result{
      {"accept_seen", share(all[0].right, all[0].commands)},
      {"accept_unseen", share(all[1].right, all[1].commands)},
      {"false_accept", share(all[0].keyless_taken + all[1].keyless_taken + noisy.keyless_taken,
                             all[0].keyless + all[1].keyless + noisy.keyless)},
      {"near_misses_taken",
       share(all[0].taken + all[1].taken, all[0].near_misses + all[1].near_misses)},
      {"wrong_at_10db", share(noisy.wrong, noisy.commands)},
      {"accept_at_10db", share(noisy.right, noisy.commands)},
      {"um_s_p50", test::quantile(bench.um, 0.5)},
      {"um_s_p95", test::quantile(bench.um, 0.95)},
      {"voices", voices}};
  std::printf("%s\n", result.dump(options.json ? -1 : 2).c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine app{"How well spoken commands are understood"};
  app.add_option("--utterances", options.utterances, "a file of what is said, and its meanings");
  app.add_option("--seen", options.seen, "voices that the recognizer was tuned with");
  app.add_option("--unseen", options.unseen, "other voices");
  app.add_option("--every", options.every, "takes one of so many utterances").in_range(1, 100);
  app.add_option("--noise", options.noise_db, "[dB] by which the noise is below the voice");
  app.add_flag("--json", options.json, "one JSON object; progress goes to stderr");
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] { return run(options); });
}
