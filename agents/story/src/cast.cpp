#include "saphira/story/cast.hpp"

#include <algorithm>
#include <filesystem>

#include "saphira/base/text.hpp"

namespace saphira::story {
namespace {

constexpr const char* kWords = "PERSON, HAS, GETS, KNOWS, SAYS, NEAR, DEPLOYMENT, THINGS or ENDS";

/// The text between two others: "karen" in "Is karen here?".
std::optional<std::string> between(std::string_view text, std::string_view before,
                                   std::string_view after) {
  if (text.size() <= before.size() + after.size() || !text.starts_with(before) ||
      !text.ends_with(after))
    return std::nullopt;
  text.remove_prefix(before.size());
  text.remove_suffix(after.size());
  return std::string(text);
}

/// The rest of the line from a word on, as written.
std::string rest(const saphira::Line& line, std::size_t word) {
  const auto from = static_cast<std::size_t>(line.words[word].column - 1);
  const Word& last = line.words.back();
  const std::size_t to = static_cast<std::size_t>(last.column - 1) + last.text.size();
  return std::string(line.text.substr(from, to - from));
}

std::string without_article(std::string object) {
  return object.starts_with("the ") ? object.substr(4) : object;
}

}  // namespace

Cast::Cast(std::string_view text, const std::string& file) : file_(file) {
  expect_own_format(text, file, "a file of people");
  std::optional<Spot> near;
  const auto knows_person = [this](const std::string& name) {
    return std::ranges::any_of(people_, [&](const Person& one) { return one.name == name; });
  };
  for (const saphira::Line& line : split_lines(text)) {
    LineReader reader(file, line);
    const std::string_view word = reader.word(kWords);
    const auto place = [&](std::size_t at) {
      std::string name(reader.word("a place of the map"));
      places_.push_back({name, std::string(line.text), line.number, line.words[at].column});
      return name;
    };
    if (word == "PERSON") {
      Person person;
      person.name = reader.word("a name");
      if (lowered(person.name) != person.name)
        reader.fail("expected a name in small letters, such as " + lowered(person.name));
      if (knows_person(person.name))
        reader.fail("expected another name: there is a PERSON " + person.name + " above");
      person.place = place(2);
      people_.push_back(std::move(person));
    } else if (word == "SAYS") {
      const std::string speaker(reader.word("a name"));
      if (!knows_person(speaker))
        reader.fail("expected the name of a PERSON above, found " + speaker);
      if (line.words.size() < 3)
        reader.fail("expected what " + speaker + " says");
      lines_.push_back({speaker, rest(line, 2), std::exchange(near, std::nullopt)});
      continue;
    } else if (word == "ENDS") {
      if (line.words.size() < 2)
        reader.fail("expected how the robot's last word begins");
      end_ = rest(line, 1);
      continue;
    } else if (word == "NEAR") {
      if (lines_.empty())
        reader.fail("expected a SAYS above it, which brings the robot there");
      near.emplace().place = place(1);
      near->distance = reader.number("distance in m", 0.1, 100.0);
    } else if (word == "DEPLOYMENT") {
      deployment_ = reader.word("a name of config/deployments");
    } else if (word == "THINGS") {
      things_ = std::filesystem::path(file).replace_filename(reader.word("a file beside this one"));
    } else if (word == "HAS" || word == "GETS" || word == "KNOWS") {
      if (people_.empty())
        reader.fail("expected a PERSON above it");
      if (word == "HAS") {
        people_.back().has.emplace(reader.word("a thing that the person has"));
      } else if (word == "GETS") {
        people_.back().gets.emplace(reader.word("a thing that the person is to have at the end"));
      } else {
        const std::string whom(reader.word("a name"));
        people_.back().knows[whom] = place(2);
      }
    } else {
      reader.fail(std::string("expected ") + kWords);
    }
    reader.expect_end();
  }
  for (const Person& person : people_)
    for (const std::string& object : person.has)
      owners_[object] = person.name;
}

void Cast::check(const std::function<bool(const std::string& place)>& is_place) const {
  if (lines_.empty())
    throw FileError(file_, 1, 1,
                    "expected a line SAYS PERSON SENTENCE: without one the story does not begin");
  for (const Named& named : places_)
    if (!is_place(named.place))
      throw FileError(file_, named.line, named.column,
                      "expected a place of the map, found \"" + named.place + '"', named.text);
}

bool Cast::has(const std::string& person, const std::string& object) const {
  return std::ranges::any_of(
      people_, [&](const Person& one) { return one.name == person && one.has.contains(object); });
}

bool Cast::all_got() const {
  return std::ranges::all_of(people_, [](const Person& one) {
    return std::includes(one.has.begin(), one.has.end(), one.gets.begin(), one.gets.end());
  });
}

std::string Cast::handed_over() const {
  std::string text;
  for (const Person& person : people_)
    for (const std::string& object : person.has)
      if (const auto owner = owners_.find(object);
          owner == owners_.end() || owner->second != person.name)
        text += (text.empty() ? "" : ", ") + person.name + " has the " + object;
  return text;
}

std::optional<Cast::Line> Cast::answer(const std::string& said, const std::string& place) {
  std::vector<Person*> here;
  for (Person& person : people_)
    if (person.place == place)
      here.push_back(&person);
  if (here.empty())
    return std::nullopt;
  if (const auto name = between(said, "Is ", " here?")) {
    for (const Person* const person : here)
      if (person->name == *name)
        return Line{person->name, "yes", {}};
    return Line{here.front()->name, "no, sorry", {}};
  }
  if (const auto name = between(said, "Who knows where ", " is?")) {
    for (const Person* const person : here)
      if (const auto known = person->knows.find(*name); known != person->knows.end())
        return Line{person->name, "in the " + known->second, {}};
    return Line{here.front()->name, "I don't know", {}};
  }
  if (const auto object = between(said, "Please give me ", "")) {
    for (Person* const person : here)
      if (person->has.erase(without_article(*object)) > 0)
        return Line{person->name, "here you are", {}};
    return Line{here.front()->name, "no, sorry", {}};
  }
  if (between(said, "Who has ", "?"))
    return Line{here.front()->name, "I don't know", {}};
  if (const auto object = between(said, "Here is ", ", please take it")) {
    const std::string name = object->substr(0, object->find(" from "));
    Person* taker = here.front();
    for (Person* const person : here)
      if (object->ends_with(" for " + person->name))
        taker = person;
    taker->has.insert(without_article(name));
    return Line{taker->name, "thank you", {}};
  }
  if (const auto question = between(said, "Does ", "?")) {
    const std::size_t have = question->find(" have ");
    if (have != std::string::npos)
      return Line{here.front()->name,
                  has(question->substr(0, have), without_article(question->substr(have + 6)))
                      ? "yes"
                      : "no",
                  {}};
  }
  return std::nullopt;
}

}  // namespace saphira::story
