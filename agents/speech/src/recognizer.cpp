#include "saphira/speech/recognizer.hpp"

#include <pocketsphinx.h>
#include <sphinxbase/err.h>
#include <sphinxbase/fsg_model.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "saphira/base/text.hpp"
#include "saphira/speech/agreement.hpp"

namespace saphira::speech {
namespace {

// Phones after the keyword that are no word: breath, or room noise.
constexpr int kBreath = 4;
constexpr double kAddressed = 0.5;       // confidence of a keyword alone
constexpr const char* kFree = "free";    // the search of the second decoder without a grammar
constexpr const char* kSpots = "spots";  // its search for single words
constexpr const char* kSpotted =
    "1e-1";  // likelihood ratio of a spotted word; README.md, "Measured"
constexpr std::array<std::string_view, 3> kAtOnce{"stop", "halt", "freeze"};
constexpr double kMostDifference = 0.45;  // README.md, "Measured"
constexpr const char* kPhone = "p_";      // begins the token of a phone; words are w0, w1, ...

Phones in_dictionary(ps_decoder_t* decoder, const std::string& word) {
  Phones out;
  for (int i = 1; i < 6; ++i) {
    const std::string name = i == 1 ? word : word + "(" + std::to_string(i) + ")";
    char* const found = ps_lookup_word(decoder, name.c_str());
    if (found == nullptr)
      break;
    out.emplace_back(found);
    ckd_free(found);
  }
  return out;
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream parts(text);
  return {std::istream_iterator<std::string>(parts), std::istream_iterator<std::string>()};
}

/// A stop is not heard once more: nobody waits for that.
bool is_at_once(const std::string& command) {
  const std::vector<std::string> words = words_of(command);
  return std::ranges::any_of(kAtOnce, [&](std::string_view word) {
    return std::ranges::find(words, word) != words.end();
  });
}

/// Adds the search for the words of kAtOnce, which the library reads from a file.
bool add_spots(ps_decoder_t* decoder) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), &std::fclose);
  if (!file)
    return false;
  for (const std::string_view word : kAtOnce)
    std::fprintf(file.get(), "%s /%s/\n", std::string(word).c_str(), kSpotted);
  std::fflush(file.get());
  const std::string path = "/proc/self/fd/" + std::to_string(fileno(file.get()));
  return ps_set_kws(decoder, kSpots, path.c_str()) == 0;
}

struct FreeDecoder {
  void operator()(ps_decoder_t* decoder) const { ps_free(decoder); }
};

}  // namespace

const char* word(Outcome outcome) {
  return outcome == Outcome::command     ? "command"
         : outcome == Outcome::addressed ? "addressed"
                                         : "not for it";
}

struct Recognizer::Self {
  RecognizerSettings settings;
  std::unique_ptr<ps_decoder_t, FreeDecoder> decoder;
  /// It hears the same sound otherwise: as a whole, and with the noise in it.
  std::unique_ptr<ps_decoder_t, FreeDecoder> second;
  Sound recent;  ///< of this utterance, and a little before it
  std::set<std::string> keywords;
  std::unique_ptr<Pronunciations> pronunciations;
  std::map<std::string, std::string> tokens;  ///< of the words
  std::map<std::string, std::string> words;   ///< of the tokens
  bool listens = false;                       ///< an utterance has begun
  bool in_speech = false;
  int grammars = 0;
  std::string keyword;   ///< a keyword alone: further words belong to it
  double attends = 0.0;  ///< [s] remaining time for that

  std::string token(const std::string& word);
  std::string name_of(bool continued) const {
    return (continued ? "continued" : "grammar") + std::to_string(grammars);
  }
  void take(const agent_interface::WordGraph& graph, bool continued);
  void search(bool continued);
  Recognized result(ps_decoder_t* from) const;
  /// The second decoder hears the utterance once more.
  bool hears_again() const;
  /// The words that it hears with another of its searches.
  std::vector<std::string> heard_by(const char* search) const;
  bool is_sure(const Recognized& heard) const;
  bool is_doubted(const std::string& command) const;
  void finish(std::vector<Event>& events);
  void give_up_attention(std::vector<Event>& events);
};

Recognizer::Recognizer(RecognizerSettings settings, std::string_view text, const std::string& file)
    : self_(std::make_unique<Self>()) {
  self_->settings = std::move(settings);
  err_set_logfp(nullptr);
  const std::string model = self_->settings.model;
  const auto decoder_with = [&](const char* remove) {
    cmd_ln_t* const config = cmd_ln_init(
        nullptr, ps_args(), TRUE, "-hmm", (model + "/en-us").c_str(), "-dict",
        (model + "/cmudict-en-us.dict").c_str(), "-remove_silence", remove, "-remove_noise", remove,
        "-vad_threshold", std::to_string(self_->settings.least_voice).c_str(), "-vad_postspeech",
        std::to_string(self_->settings.pause).c_str(), nullptr);
    ps_decoder_t* const made = config == nullptr ? nullptr : ps_init(config);
    cmd_ln_free_r(config);
    return made;
  };
  self_->decoder.reset(decoder_with("yes"));
  self_->second.reset(decoder_with("no"));
  if (!self_->decoder || !self_->second ||
      ps_set_lm_file(self_->second.get(), kFree, (model + "/en-us.lm.bin").c_str()) < 0 ||
      !add_spots(self_->second.get()))
    throw std::runtime_error("the model of speech in " + model +
                             " cannot be read: install the Debian package pocketsphinx-en-us");
  ps_decoder_t* const decoder = self_->decoder.get();
  self_->pronunciations = std::make_unique<Pronunciations>(
      text, file, [decoder](const std::string& word) { return in_dictionary(decoder, word); });
  for (const std::string& phone : phones())
    for (ps_decoder_t* const one : {decoder, self_->second.get()})
      ps_add_word(one, (kPhone + phone).c_str(), phone.c_str(), FALSE);
}
Recognizer::~Recognizer() {
  if (self_->listens)
    ps_end_utt(self_->decoder.get());
}

bool Recognizer::in_speech() const {
  return self_->in_speech || !self_->keyword.empty();
}

/// Words with signs or digits are not looked up in the recognizer's dictionary.
std::string Recognizer::Self::token(const std::string& word) {
  const auto known = tokens.find(word);
  if (known != tokens.end())
    return known->second;
  const std::string name = "w" + std::to_string(tokens.size());
  int number = 0;
  for (const std::string& sound : pronunciations->of(word)) {
    ++number;
    const std::string each = number == 1 ? name : name + "(" + std::to_string(number) + ")";
    if (ps_add_word(decoder.get(), each.c_str(), sound.c_str(), FALSE) < 0 ||
        ps_add_word(second.get(), each.c_str(), sound.c_str(), FALSE) < 0)
      throw std::runtime_error("\"" + word + "\" cannot be pronounced as " + sound);
  }
  tokens[word] = name;
  words[name] = word;
  return name;
}

/// continued: the keyword came before.
void Recognizer::Self::take(const agent_interface::WordGraph& graph, bool continued) {
  using agent_interface::WordGraph;
  logmath_t* const log = ps_get_logmath(decoder.get());
  const double weight = cmd_ln_float32_r(ps_get_config(decoder.get()), "-lw");
  const int garbage = graph.states;
  const int behind = graph.states + 1;
  const int instead = graph.states + 2;
  const std::string name = name_of(continued);
  fsg_model_t* const fsg =
      fsg_model_init(name.c_str(), log, static_cast<float>(weight), graph.states + 3);
  fsg->start_state = continued ? WordGraph::kAddressed : WordGraph::kStart;
  fsg->final_state = WordGraph::kEnd;
  for (const WordGraph::Arc& arc : graph.arcs) {
    if (arc.word.empty())
      fsg_model_null_trans_add(fsg, arc.from, arc.to, 0);
    else
      fsg_model_trans_add(fsg, arc.from, arc.to, 0,
                          fsg_model_word_add(fsg, token(arc.word).c_str()));
  }
  const auto likely = [&](double natural) {
    return static_cast<int32>(logmath_ln_to_log(log, natural) * weight);
  };
  for (const std::string& phone : phones()) {
    const int id = fsg_model_word_add(fsg, (kPhone + phone).c_str());
    if (!continued) {
      fsg_model_trans_add(fsg, WordGraph::kStart, garbage, likely(settings.without_keyword), id);
      fsg_model_trans_add(fsg, WordGraph::kStart, instead, likely(settings.instead_of_keyword), id);
    }
    fsg_model_trans_add(fsg, instead, instead, likely(settings.each_phone), id);
    fsg_model_trans_add(fsg, garbage, garbage, likely(settings.each_phone), id);
    fsg_model_trans_add(fsg, WordGraph::kAddressed, behind, likely(settings.behind_keyword), id);
    fsg_model_trans_add(fsg, behind, behind, likely(settings.each_phone), id);
  }
  fsg_model_null_trans_add(fsg, WordGraph::kAddressed, WordGraph::kAlone, 0);
  fsg_model_null_trans_add(fsg, behind, WordGraph::kAlone, likely(settings.alone_behind));
  for (const int state : {garbage, behind, WordGraph::kAddressed})
    fsg_model_null_trans_add(fsg, state, WordGraph::kEnd, 0);
  fsg_model_null_trans_add(fsg, instead, WordGraph::kAddressed, 0);
  glist_free(fsg_model_null_trans_closure(fsg, nullptr));
  const bool taken = ps_set_fsg(decoder.get(), name.c_str(), fsg) == 0 &&
                     ps_set_fsg(second.get(), name.c_str(), fsg) == 0;
  fsg_model_free(fsg);
  if (!taken)
    throw std::runtime_error("the recognizer of speech does not take the grammar");
}

void Recognizer::Self::search(bool continued) {
  if (ps_set_search(decoder.get(), name_of(continued).c_str()) != 0 ||
      ps_set_search(second.get(), name_of(continued).c_str()) != 0)
    throw std::runtime_error("the recognizer of speech does not take the grammar");
}

void Recognizer::listen_for(const agent_interface::WordGraph& graph) {
  if (self_->listens)
    ps_end_utt(self_->decoder.get());
  self_->listens = self_->in_speech = false;
  self_->keyword.clear();
  self_->keywords.clear();
  for (const auto& arc : graph.arcs)
    if (arc.from == agent_interface::WordGraph::kStart &&
        arc.to == agent_interface::WordGraph::kAddressed)
      self_->keywords.insert(arc.word);
  const std::vector<std::string> old{self_->name_of(false), self_->name_of(true)};
  ++self_->grammars;
  self_->take(graph, true);
  self_->take(graph, false);
  self_->search(false);
  if (self_->grammars > 1)
    for (const std::string& name : old)
      for (ps_decoder_t* const one : {self_->decoder.get(), self_->second.get()})
        ps_unset_search(one, name.c_str());
}

Recognized Recognizer::Self::result(ps_decoder_t* from) const {
  const char* const hypothesis = ps_get_hyp(from, nullptr);
  Recognized heard;
  if (hypothesis == nullptr)
    return heard;
  std::istringstream parts(hypothesis);
  bool begins = false;
  bool ends_with_word = false;
  int phones_too = 0;
  for (std::string part; parts >> part;) {
    part = part.substr(0, part.find('('));
    if (part.rfind(kPhone, 0) == 0) {
      if (!begins)
        return {};  // no keyword
      ++phones_too;
      ends_with_word = false;
      continue;
    }
    const auto word = words.find(part);
    if (word == words.end())
      continue;
    ends_with_word = phones_too > 0;  // an urgent order behind other words
    begins = true;
    const bool owner = word->second == "'s";
    heard.text += (heard.text.empty() || owner ? "" : " ") + word->second;
  }
  if (begins)
    heard.outcome = phones_too > kBreath && !ends_with_word ? Outcome::addressed : Outcome::command;
  return heard;
}

bool Recognizer::Self::hears_again() const {
  ps_decoder_t* const from = second.get();
  if (ps_start_utt(from) < 0)
    return false;
  ps_process_raw(from, recent.data(), recent.size(), FALSE, TRUE);
  ps_end_utt(from);
  return true;
}

/// The second decoder hears the same command.
bool Recognizer::Self::is_sure(const Recognized& heard) const {
  if (!hears_again())
    return false;
  const Recognized again = result(second.get());
  return again.outcome == heard.outcome && again.text == heard.text && !is_doubted(heard.text);
}

std::vector<std::string> Recognizer::Self::heard_by(const char* search) const {
  ps_decoder_t* const from = second.get();
  const std::string before = ps_get_search(from);
  ps_set_search(from, search);
  const char* const hypothesis = hears_again() ? ps_get_hyp(from, nullptr) : nullptr;
  std::vector<std::string> heard = words_of(hypothesis == nullptr ? "" : hypothesis);
  ps_set_search(from, before.c_str());
  return heard;
}

/// Without the grammar it is something else.
bool Recognizer::Self::is_doubted(const std::string& command) const {
  ps_decoder_t* const from = second.get();
  const std::vector<std::string> freely = heard_by(kFree);
  std::vector<std::string> said = words_of(command);
  if (!said.empty() && keywords.contains(said.front()))
    said.erase(said.begin());
  const auto sounds = [](const std::vector<std::string>& spoken, const auto& pronounced) {
    std::vector<std::string> all;
    for (const std::string& word : spoken)
      if (const Phones phones = pronounced(word); !phones.empty())
        for (std::string& sound : words_of(phones.front()))
          all.push_back(std::move(sound));
    return all;
  };
  return is_turned(freely, said) ||
         difference(
             sounds(freely, [&](const std::string& word) { return in_dictionary(from, word); }),
             sounds(said, [&](const std::string& word) { return pronunciations->of(word); })) >
             kMostDifference;
}

/// The utterance has ended. A keyword alone waits for further words.
void Recognizer::Self::finish(std::vector<Event>& events) {
  if (!listens)
    return;
  ps_end_utt(decoder.get());
  listens = false;
  if (!std::exchange(in_speech, false))
    return;
  Recognized heard = result(decoder.get());
  const std::vector<std::string> said = words_of(heard.text);
  const bool is_named = !keyword.empty() || (!said.empty() && keywords.contains(said.front()));
  if (heard.outcome == Outcome::command)
    heard.confidence = is_at_once(heard.text) || is_sure(heard) ? kCertain : kUncertain;
  const bool is_order = is_named && heard.confidence >= kCertain && !keywords.contains(heard.text);
  if (!is_order && seconds(recent) < settings.longest_alone)
    if (heard.spotted = heard_by(kSpots); !heard.spotted.empty())
      heard.freely = heard_by(kFree);
  recent.clear();
  if (!keyword.empty()) {
    heard.text = std::exchange(keyword, {}) + (heard.text.empty() ? "" : " ") + heard.text;
    if (heard.outcome == Outcome::not_for_it)
      heard.outcome = Outcome::addressed;
    search(false);
  } else if (heard.outcome == Outcome::command && keywords.contains(heard.text) &&
             heard.spotted.empty()) {
    keyword = heard.text;
    attends = settings.attention;
    search(true);
    return;
  }
  events.push_back({Event::Kind::ends});
  if (keywords.contains(heard.text))
    heard.outcome = Outcome::addressed;
  if (heard.outcome == Outcome::addressed)
    heard.confidence = kAddressed;
  events.push_back({Event::Kind::heard, heard});
}

/// No further words came.
void Recognizer::Self::give_up_attention(std::vector<Event>& events) {
  if (keyword.empty() || in_speech)
    return;
  if (listens)
    ps_end_utt(decoder.get());
  listens = false;
  search(false);
  events.push_back({Event::Kind::ends});
  events.push_back(
      {Event::Kind::heard, {Outcome::addressed, std::exchange(keyword, {}), kAddressed}});
}

std::vector<Event> Recognizer::end() {
  std::vector<Event> events;
  self_->finish(events);
  self_->give_up_attention(events);
  return events;
}

std::vector<Event> Recognizer::hear(const Sound& sound) {
  constexpr std::size_t kBlock = kRate / 50;
  constexpr std::ptrdiff_t kBefore = kRate / 2;  // heard before its beginning is noticed
  std::vector<Event> events;
  ps_decoder_t* const decoder = self_->decoder.get();
  for (std::size_t at = 0; at < sound.size(); at += kBlock) {
    const std::size_t count = std::min(kBlock, sound.size() - at);
    if (!self_->listens) {
      if (self_->grammars == 0 || ps_start_utt(decoder) < 0)
        throw std::runtime_error("the recognizer of speech does not begin: it has no grammar");
      self_->listens = true;
    }
    ps_process_raw(decoder, sound.data() + at, count, FALSE, FALSE);
    Sound& kept = self_->recent;
    kept.insert(kept.end(), sound.begin() + static_cast<std::ptrdiff_t>(at),
                sound.begin() + static_cast<std::ptrdiff_t>(at + count));
    const bool speaks = ps_get_in_speech(decoder) != 0;
    if (speaks && !self_->in_speech && self_->keyword.empty())
      events.push_back({Event::Kind::begins});
    if (!speaks && self_->in_speech)
      self_->finish(events);
    else
      self_->in_speech = speaks;
    if (!self_->in_speech && kept.size() > 2U * kBefore)
      kept.erase(kept.begin(), kept.end() - kBefore);
    self_->attends -= static_cast<double>(count) / kRate;
    if (!self_->in_speech && self_->attends <= 0.0)
      self_->give_up_attention(events);
  }
  return events;
}

}  // namespace saphira::speech
