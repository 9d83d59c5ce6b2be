#include "saphira/speech/conversation.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <utility>

#include "saphira/base/text.hpp"
#include "saphira/speech/agreement.hpp"

namespace saphira::speech {
namespace {

constexpr double kEcho = 0.3;       // [s] of a room, after the robot has spoken
constexpr double kPatience = 20.0;  // [s] for a reply; as in the dialogue
/// Words behind "stop" that make it something else.
constexpr std::array<std::string_view, 9> kOtherStops{
    "talking", "laughing", "crying", "shouting", "smoking", "sign", "signs", "light", "lights"};
constexpr std::size_t kMostAround = 3;  // words of a stop by itself that the grammar does not know

}  // namespace

Conversation::Conversation(Recognizer& recognizer, agent_interface::Grammar grammar)
    : recognizer_(recognizer), grammar_(std::move(grammar)) {}

void Conversation::use(agent_interface::Grammar grammar) {
  grammar_ = std::move(grammar);
  listens_for_replies_.reset();
}

void Conversation::names(std::vector<std::string> names) {
  if (names == names_)
    return;
  names_ = std::move(names);
  listens_for_replies_.reset();
}

void Conversation::said(const std::string& text) {
  const bool question = !text.empty() && text.back() == '?' && text != "what?";
  if (question)
    replies_ = kPatience;
}

/// The grammar is changed between two utterances only.
void Conversation::listen() {
  const bool replies = replies_ > 0.0;
  if (listens_for_replies_ == replies)
    return;
  std::vector<std::string> names = grammar_.names();
  for (const std::string& name : names_) {
    std::string text;
    for (const std::string& word : agent_interface::words_of(name))
      text += (text.empty() ? "" : " ") + word;
    if (!text.empty() && std::ranges::find(names, text) == names.end())
      names.push_back(text);
  }
  recognizer_.listen_for(grammar_.graph(names, replies));
  listens_for_replies_ = replies;
}

/// A stop that the grammar of the recognizer has missed: its word; empty: it is none. By itself it
/// needs no keyword. The words around it are often misheard, and may not turn its meaning. Behind
/// the keyword it is one where the grammar has heard the keyword alone.
std::string Conversation::missed_stop(const Recognized& heard) const {
  if (heard.spotted.empty() || grammar_.keywords().empty())
    return {};
  const std::vector<std::string>& words = heard.freely;
  const std::string text = joined(words, " ");
  const bool behind_keyword =
      grammar_.urgent(grammar_.keywords().front() + " " + text).meaning.has_value();
  if (std::ranges::find(grammar_.keywords(), heard.text) != grammar_.keywords().end())
    return behind_keyword || (words.size() <= kMostAround && !is_turned(words, {}))
               ? heard.spotted.front()
               : std::string();
  const auto word = std::ranges::find_first_of(words, heard.spotted);
  if (word == words.end())  // "y'all to" is "halt"
    return heard.spotted.front() != "stop" && words.size() < kMostAround ? heard.spotted.front()
                                                                         : std::string();
  const bool is_stop = grammar_.urgent(text).alone ||
                       (behind_keyword && words.size() <= kMostAround &&
                        std::ranges::find(kOtherStops, words.back()) == kOtherStops.end());
  return is_stop ? *word : std::string();
}

Conversation::Outputs Conversation::take(const std::vector<Event>& events) {
  Outputs out;
  for (const Event& event : events) {
    Recognized heard = event.heard;
    if (const std::string stop = missed_stop(heard); !stop.empty())
      heard = {Outcome::command, stop, kCertain};
    if (event.kind != Event::Kind::heard || heard.outcome == Outcome::not_for_it)
      continue;
    out.um = true;
    if (heard.outcome == Outcome::addressed)
      heard.text.resize(std::min(heard.text.size(), heard.text.find(' ')));
    out.utterances.push_back(std::move(heard));
  }
  return out;
}

Conversation::Outputs Conversation::hear(const Sound& sound, bool speaking) {
  const double length = seconds(sound);
  replies_ = std::max(0.0, replies_ - (speaking ? 0.0 : length));
  deaf_ = speaking ? kEcho : deaf_ - length;
  if (speaking || deaf_ > 0.0) {
    recognizer_.end();  // the robot's own voice covers the present speech
    return {};
  }
  if (!recognizer_.in_speech())
    listen();
  return take(recognizer_.hear(sound));
}

/// A file may end with its last word, which the recognizer hears only in front of a pause.
Conversation::Outputs Conversation::end() {
  Outputs out = hear(Sound(kRate), false);
  Outputs last = take(recognizer_.end());
  out.um = out.um || last.um;
  std::ranges::move(last.utterances, std::back_inserter(out.utterances));
  return out;
}

}  // namespace saphira::speech
