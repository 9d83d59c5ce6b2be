#include <algorithm>
#include <array>
#include <string_view>

#include "protocol.hpp"

namespace saphira::mcp {
namespace {

struct Argument {
  std::string_view name{};  ///< $name in the text [empty: none]
  std::string_view description{};
};
struct Prompt {
  std::string_view name;
  std::string_view description;
  std::array<Argument, 2> arguments{};
  std::string_view text;
};

constexpr std::array kPrompts{
    Prompt{"look-around",
           "go to a place and tell what is there",
           {{{"place", "a place of the robot's map"}}},
           "Send the robot to $place. If it does not arrive, tell me its reason and ask me what to "
           "do. There, look, and tell me in a few sentences what is seen and heard: people, doors, "
           "things in the way. Leave the robot there."},
    Prompt{
        "fetch",
        "have the robot fetch a thing and bring it to a person",
        {{{"thing", "what to fetch, such as the report"}, {"person", "who gets it"}}},
        "Have the robot fetch $thing and bring it to $person: tell it so in one sentence, with "
        "the tool say. Follow its progress. If it asks something, ask me, and pass my answer on. "
        "Tell me at the end who has it, by the robot's own words."},
    Prompt{"rounds",
           "visit several places and report on each",
           {{{"places", "places of the map, with commas"}}},
           "Send the robot to these places, one after the other: $places. At each, look and note "
           "what is different from what its map says. If a place cannot be reached, note the "
           "reason and go on with the next. Then bring the robot back to where it began, and give "
           "me the notes as a table."},
    Prompt{"explain",
           "explain what the robot is doing now and why",
           {},
           "Ask the robot why it does what it does now, and what its status is. Explain it to me "
           "in a few sentences, without its internal names. Do not move it."}};

}  // namespace

Json prompts() {
  Json all = Json::array();
  for (const Prompt& each : kPrompts) {
    Json arguments = Json::array();
    for (const Argument& argument : each.arguments)
      if (!argument.name.empty())
        arguments.push_back(
            {{"name", argument.name}, {"description", argument.description}, {"required", true}});
    all.push_back(
        {{"name", each.name}, {"description", each.description}, {"arguments", arguments}});
  }
  return {{"prompts", std::move(all)}};
}

Json prompt(const Json& name, const Json& arguments) {
  const auto* const found = std::ranges::find_if(
      kPrompts, [&](const Prompt& each) { return name.is_string() && name == each.name; });
  if (found == kPrompts.end())
    return "there is no such prompt; prompts/list has their names";
  std::string text(found->text);
  for (const Argument& argument : found->arguments) {
    if (argument.name.empty())
      continue;
    const auto given = arguments.find(argument.name);
    if (given == arguments.end() || !given->is_string() || given->empty())
      return "expected a text for the argument " + std::string(argument.name) + ": " +
             std::string(argument.description);
    const std::string mark = "$" + std::string(argument.name);
    text.replace(text.find(mark), mark.size(), given->get<std::string>());
  }
  const Json content{{"type", "text"}, {"text", text}};
  return {{"description", found->description},
          {"messages", Json::array({{{"role", "user"}, {"content", content}}})}};
}

}  // namespace saphira::mcp
