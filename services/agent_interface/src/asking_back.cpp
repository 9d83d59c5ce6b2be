// The part of the dialogue for what the robot asks back, and for the answers.
#include <algorithm>
#include <array>
#include <utility>

#include "saphira/base/text.hpp"
#include "words.hpp"

namespace saphira::agent_interface {
namespace {

/// Slots for places and people.
constexpr std::array kNamed{"place", "from", "to", "person", "owner", "other"};
/// The same, and those for things.
constexpr std::array kNames{"place", "from", "to", "person", "owner", "other", "object", "name"};
constexpr std::size_t kMostQuestions = 16;

/// The end of a free text that may be an order of its own: "and then go home".
std::string order_in_text(const Grammar::Understood& understood) {
  const std::size_t last = understood.then.size();
  const Meaning& whole = last == 0 ? understood.meanings.front() : understood.then.back();
  for (const auto& [name, value] : understood.apart[last].slots)
    if (const std::string all = slot(whole, name); all != value && all.starts_with(value))
      return all.substr(std::min(value.size() + 1, all.size()));
  return "the rest";
}

std::string with_words(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = lowered(text).find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The meaning with a place instead of that of an owner.
Meaning with_place(Meaning meaning, const std::string& place) {
  meaning.slots["owner"] = "";
  meaning.slots[meaning.slots.contains("to") ? "to" : "place"] = place;
  return meaning;
}

/// Puts a name in the place of another in all steps.
void rename(Grammar::Understood& understood, const std::string& from, const std::string& to) {
  for (std::vector<Meaning>* const steps :
       {&understood.meanings, &understood.then, &understood.during})
    for (Meaning& step : *steps)
      for (auto& [slot, value] : step.slots)
        if (value == from)
          value = to;
}

/// "I meant the mail", "no, the mail"; "no problem" is no other name.
bool names_something(const Meaning& instead, const Utterance& utterance) {
  const std::vector<std::string> words = words_of(utterance.text);
  return !slot(instead, "meant").empty() || !slot(instead, "was").empty() ||
         std::find(words.begin(), words.end(), "the") != words.end();
}

/// The places and persons of a meaning.
std::vector<std::string> names_in(const Meaning& meaning) {
  std::vector<std::string> names;
  for (const char* const name : kNamed)
    if (const std::string value = slot(meaning, name); !value.empty() && value != "this")
      names.push_back(value);
  return names;
}

}  // namespace

void Dialogue::ask(Question question, const Utterance& utterance) {
  forget_question(utterance);
  if (questions_.size() >= kMostQuestions)
    questions_.erase(questions_.begin());
  question.raised_by = utterance;
  questions_.push_back(std::move(question));
}

const Dialogue::Question* Dialogue::question_for(const Utterance& utterance) const {
  const auto found =
      std::find_if(questions_.begin(), questions_.end(), [&](const Question& question) {
        return question.asked ? may_answer(utterance, question.raised_by)
                              : same_person(utterance.speaker, question.raised_by.speaker);
      });
  return found == questions_.end() ? nullptr : &*found;
}

void Dialogue::forget_question(const Utterance& utterance) {
  std::erase_if(questions_, [&](const Question& question) {
    return same_person(utterance.speaker, question.raised_by.speaker);
  });
}

void Dialogue::choices(const Grammar::Understood& understood, const Utterance& utterance,
                       Outputs& out) {
  std::vector<std::string> all;
  Question question;
  for (const Meaning& meaning : understood.meanings)
    if (const std::string words = in_words(meaning);
        !words.empty() && std::find(all.begin(), all.end(), words) == all.end()) {
      all.push_back(words);
      question.yes.push_back(understood);
      question.yes.back().meanings = {meaning};
    }
  std::string text;
  for (const std::string& one : all)
    text += (text.empty() ? "\"" : ", or \"") + one + "\"";
  if (all.size() < 2)
    text = "several things";
  text = "what? That may mean " + text;
  refuse(utterance, text, out);
  question.no = kLeft;
  if (all.size() > 1)
    ask(std::move(question), utterance);
}

/// An open question has the first claim on an answer. A stop is one in any case.
void Dialogue::prefer_answer(Grammar::Understood& understood, const Question* question,
                             const Situation& situation) const {
  std::vector<Meaning>& meanings = understood.meanings;
  if (understood.answer && meanings.size() == 1 && meanings.front().functor != "stop" &&
      (is_yes_or_no(*understood.answer) || meanings.front().functor == "to_place" ||
       meanings.front().functor == "talk" || slot(meanings.front(), "object") == "it")) {
    meanings = {*understood.answer};
    understood.then.clear();
    understood.during.clear();
    understood.apart.clear();
  } else if (situation.asked_about.empty() &&
             (question == nullptr || (!question->asked && question->names.empty())) &&
             understood.bare.size() == 1 &&
             !place(slot(understood.bare.front(), "person"), situation).empty()) {
    meanings = {{"to_place", {{"place", slot(understood.bare.front(), "person")}, {"owner", ""}}}};
    understood.bare.clear();
  }
}

/// A recognizer is not certain of the words.
void Dialogue::ask_again(Grammar::Understood understood, const Utterance& utterance, Outputs& out) {
  if (is_yes_or_no(understood.meanings.front())) {
    refuse(utterance, "what?", out);
    return;
  }
  refuse(utterance, "did you say " + quoted(utterance.text) + "?", out);
  Question question;
  question.yes = {std::move(understood)};
  question.no = kLeft;
  ask(std::move(question), utterance);
}

/// The end of a free text may be an order to the robot.
void Dialogue::ask_for_order(Grammar::Understood understood, const Utterance& utterance,
                             Outputs& out) {
  refuse(utterance,
         "\"" + order_in_text(understood) +
             "\": shall I do that myself (yes), or is it what I am to say (no)?",
         out);
  Question question;
  const std::vector<Meaning> steps = std::exchange(understood.apart, {});
  question.yes = {understood};
  question.yes[0].meanings = {steps.front()};
  question.yes[0].then.assign(steps.begin() + 1, steps.end());
  question.sentence = std::move(understood);
  ask(std::move(question), utterance);
}

/// The robot has asked for another name, or does what was said, and its speaker may correct that.
void Dialogue::note_name(Grammar::Understood understood, const Utterance& utterance,
                         const Outputs& out) {
  Question question;
  question.asked =
      std::any_of(out.said.begin(), out.said.end(), [](const Said& one) { return one.refused; });
  if (question.asked ? out.unknown.name.empty() : !understood.then.empty())
    return;
  if (question.asked)
    question.names = {out.unknown.name};
  else if (!out.goals.empty())
    question.names = names_in(understood.meanings.front());
  question.no = kLeft;
  if (question.asked && !out.unknown.meant.empty()) {
    question.yes = {understood};
    rename(question.yes[0], question.names.front(), lowered(out.unknown.meant));
  }
  question.sentence = std::move(understood);
  ask(std::move(question), utterance);
  if (tasks_.task() != nullptr && tasks_.task()->answers == utterance.id)
    order_ = questions_.back();
}

std::vector<std::pair<Meaning, std::string>> Dialogue::corrected(const Question& question,
                                                                 const Meaning& instead, bool names,
                                                                 const Situation& situation) const {
  std::vector<std::pair<Meaning, std::string>> found;
  const std::string words = slot(instead, "name");
  const std::string wrong = slot(instead, "was");
  const std::string wrong_place = place(wrong, situation);
  const Meaning& was = question.sentence.meanings.front();
  const std::string& text = question.raised_by.text;
  if (is_known(words, situation)) {
    // A place rather for a place, and a person for a person.
    const bool is_place = !place(words, situation).empty();
    for (const bool fits : {true, false}) {
      for (const std::string_view name : kNamed) {
        const std::string value = slot(was, std::string(name));
        const bool any = name == "from" || name == "to" || !fits;
        const bool office = name == "owner" && is_place;
        const bool meant = wrong.empty() || value == wrong ||
                           (!wrong_place.empty() && place(value, situation) == wrong_place);
        if (value.empty() || value == "this" || !meant)
          continue;
        if (office)
          found.emplace_back(with_place(was, words), with_words(text, value + "'s office", words));
        else if (any || (name == "place") == is_place)
          found.emplace_back(with(was, std::string(name), words), with_words(text, value, words));
      }
      if (!found.empty())
        return found;
    }
  }
  if (was.slots.contains("message") || was.slots.contains("question"))
    return found;  // any words fit there
  const std::vector<std::string> said = words_of(text);
  const auto& keywords = grammar_.keywords();
  const auto key = std::find_first_of(said.begin(), said.end(), keywords.begin(), keywords.end());
  const auto first = static_cast<std::size_t>(key - said.begin()) + 1;
  constexpr std::size_t kMostWords = 4;
  std::size_t work = 0;
  for (std::size_t length = 1; length <= kMostWords && found.empty(); ++length)
    for (std::size_t at = first; at + length <= said.size(); ++at) {
      std::string changed = keywords.front();
      for (std::size_t i = first; i < said.size(); ++i) {
        if (i == at)
          changed += " " + words;
        if (i < at || i >= at + length)
          changed += (said[i] == "'s" ? "" : " ") + said[i];
      }
      const Grammar::Understood again = grammar_.understand(changed);
      if ((work += again.work) > Grammar::kMostWork)
        return {};
      if (again.meanings.size() != 1 || !again.then.empty())
        continue;
      const Meaning& now = again.meanings.front();
      // "EJ-233 kitchen" is no name, but another name may be unknown.
      const bool mixed = std::any_of(kNames.begin(), kNames.end(), [&](const char* name) {
        const std::string value = slot(now, name);
        return !value.empty() && value != slot(was, name) && (value != words || !names) &&
               !is_known(value, situation);
      });
      if (now.functor == was.functor && now != was && !mixed &&
          std::none_of(found.begin(), found.end(),
                       [&](const auto& one) { return one.first == now; }))
        found.emplace_back(now, changed);
    }
  const auto unknown = [&](const auto& one) { return names_unknown(one.first, situation); };
  if (!std::all_of(found.begin(), found.end(), unknown))
    std::erase_if(found, unknown);
  return found;
}

bool Dialogue::names_unknown(const Meaning& meaning, const Situation& situation) const {
  return std::any_of(kNamed.begin(), kNamed.end(), [&](const char* name) {
    const std::string value = slot(meaning, name);
    return !value.empty() && value != "this" && value != "me" && !is_known(value, situation);
  });
}

std::string Dialogue::named(const Grammar::Understood& understood, const Utterance& utterance,
                            const Situation& situation) const {
  const bool bare = understood.meanings.empty();
  const Meaning& said = bare ? understood.bare.front() : understood.meanings.front();
  const bool instead = said.functor == kInstead;
  const std::string name = slot(said, instead ? "name" : "person");
  if (instead && understood.addressed && words_of(name).size() <= 3)
    return name;
  // Without the keyword it may be a word to somebody else.
  const bool alone = bare || saphira::joined(words_of(utterance.text), " ") == name;
  return (instead || (said.functor == "somebody" && alone)) && is_known(name, situation)
             ? name
             : std::string();
}

std::optional<std::size_t> Dialogue::chosen(const Question& question,
                                            const Grammar::Understood& understood,
                                            const Utterance& utterance) const {
  std::size_t number = question.yes.size();
  if (understood.meanings.size() == 1 && understood.meanings.front().functor == kChoice)
    number = static_cast<std::size_t>(number_of(understood.meanings.front(), "number")) - 1;
  for (std::size_t i = 0; question.yes.size() > 1 && i < question.yes.size(); ++i)
    if (words_of(utterance.text) == words_of(in_words(question.yes[i].meanings.front())))
      number = i;
  return number < question.yes.size() ? std::optional(number) : std::nullopt;
}

bool Dialogue::answered(Question question, const Grammar::Understood& understood,
                        const Utterance& utterance, const Situation& situation, Outputs& out) {
  Utterance again = question.raised_by;
  again.id = utterance.id;
  again.time = utterance.time;
  again.program = utterance.program;
  again.person = utterance.person;
  if (!question.asked)
    again.corrects = utterance.text;
  Grammar::Understood next;
  const bool bare = understood.meanings.empty();
  const std::vector<Meaning>& heard = bare ? understood.bare : understood.meanings;
  if (const auto number = chosen(question, understood, utterance)) {
    next = std::move(question.yes[*number]);
  } else if (heard.size() != 1) {
    return false;
  } else if (const auto other =
                 !question.asked && heard.front().functor == kInstead
                     ? corrected(question, heard.front(), names_something(heard.front(), utterance),
                                 situation)
                     : std::vector<std::pair<Meaning, std::string>>{};
             !other.empty()) {
    next = question.sentence;
    next.meanings.clear();
    for (const auto& [meaning, text] : other)
      next.meanings.push_back(meaning);
    again.text = other.front().second;
  } else if (bare || !is_yes_or_no(heard.front())) {
    const std::string name = named(understood, utterance, situation);
    if (name.empty() || question.names.empty() ||
        (!question.asked && !understood.addressed && situation.asked_about.empty()))
      return false;
    next = question.sentence;
    rename(next, question.names.front(), name);
    // Of several names it asks which one was wrong.
    for (std::size_t i = 1; i < question.names.size(); ++i) {
      Grammar::Understood renamed = question.sentence;
      rename(renamed, question.names[i], name);
      next.meanings.push_back(renamed.meanings.front());
    }
  } else if (!question.asked) {
    return false;
  } else if (heard.front().functor == "no") {
    forget_question(utterance);
    if (!question.no.empty()) {
      say(utterance,
          question.no + (question.drops.empty() ? "" : tasks_.going_on(utterance.speaker)), true,
          out);
      return true;
    }
    next = std::move(question.sentence);
  } else if (question.fact) {
    forget_question(utterance);
    say(utterance, "I know now that " + describe(*question.fact), true, out);
    learn(*question.fact, out);
    return true;
  } else if (!question.drops.empty()) {
    forget_question(utterance);
    begin(std::move(question.drops), true, again, situation, out);
    return true;
  } else if (question.yes.size() == 1) {
    next = std::move(question.yes.front());
  } else if (situation.asked_about.empty()) {
    refuse(utterance, "which one?", out);
    return true;
  } else {
    return false;  // it is for an activity
  }
  forget_question(utterance);
  if (!question.asked && next.meanings.size() == 1)
    for (const Advice& one : std::vector<Advice>(knowledge_.all()))
      if (one.said == question.raised_by.text && one.time == question.raised_by.time &&
          same_person(one.speaker, utterance.speaker))
        withdraw(one.number, out);
  carry_out(std::move(next), again, situation, out);
  // The task that was to be corrected goes on.
  const std::string present = tasks_.going_on(utterance.speaker);
  const Question* const back = question_for(utterance);
  if (!question.asked && !out.said.empty() && out.said.back().refused && out.goals.empty() &&
      !present.empty() && (back == nullptr || !back->asked))
    out.said.back().text += "." + present.substr(1) + "; say stop to end it";
  return true;
}

void Dialogue::leave_out(Grammar::Understood& understood, const Situation& situation) const {
  const bool asked = !situation.asked_about.empty();
  // A name alone at most answers an activity, and a choice alone means nothing.
  std::vector<Meaning>& meanings = understood.meanings;
  std::erase_if(meanings, [](const Meaning& one) { return one.functor == kChoice; });
  const bool instead = meanings.size() == 1 && meanings.front().functor == kInstead;
  if (instead)
    meanings.front() = {"somebody", {{"person", slot(meanings.front(), "name")}}};
  else if (asked && meanings.empty())
    meanings = understood.bare;
  if (instead && is_handover(situation.asked_about))
    meanings.clear();  // a place or person is no answer
  if ((instead || !understood.bare.empty()) &&
      !(asked && meanings.size() == 1 && is_known(slot(meanings.front(), "person"), situation)))
    meanings.clear();
  if (!asked && !understood.addressed)
    std::erase_if(meanings, [](const Meaning& one) { return !is_yes_or_no(one); });
}

}  // namespace saphira::agent_interface
