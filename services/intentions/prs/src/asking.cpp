#include "saphira/intentions/functions.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::intentions {
namespace {

/// The answer to the question of that number; nullptr: none yet.
const Answer* answer_to(const World& world, Values arguments, std::string_view function) {
  const double number = number_of(arguments, 0, function);
  if (world.around.answers == nullptr || !(number >= 0.0))
    return nullptr;
  const auto found = world.around.answers->find(static_cast<std::uint64_t>(number));
  return found == world.around.answers->end() ? nullptr : &found->second;
}

Value ask_agents(Effects& effects, Values arguments) {
  Request request;
  request.functor = text_of(arguments, 0, "ask-agents");
  for (std::size_t i = 1; i + 1 < arguments.size(); i += 2) {
    const std::string& name = text_of(arguments, i, "ask-agents");
    Argument argument;
    argument.name = name;
    argument.kind = ArgumentKind::unbound;
    if (!arguments[i + 1].nil() && !to_argument(name, arguments[i + 1], argument))
      throw ActivityError("ASK: " + name + " expected a number, a text or a point, got " +
                          kind_of(arguments[i + 1]));
    request.arguments.push_back(std::move(argument));
  }
  return static_cast<double>(effects.ask(std::move(request)));
}

}  // namespace

void add_asking(Functions& functions) {
  functions.add(Action{"ask-agents", 1, 63, ask_agents,
                       "(ask-agents 'functor 'slot value ...) asks; the number of the question"});
  functions.add("answered", 1, 1, "(answered QUESTION): whether an agent has answered",
                [](const World& world, Values arguments) {
                  return Value::truth(answer_to(world, arguments, "answered") != nullptr);
                });
  functions.add("answered-well", 1, 1, "(answered-well QUESTION): whether it could and did",
                [](const World& world, Values arguments) {
                  const Answer* const answer = answer_to(world, arguments, "answered-well");
                  return Value::truth(answer != nullptr && well(answer->code));
                });
  functions.add("answer-text", 1, 1, "(answer-text QUESTION): the answer in words",
                [](const World& world, Values arguments) {
                  const Answer* const answer = answer_to(world, arguments, "answer-text");
                  return Value(answer == nullptr ? "nobody has answered" : answer->text);
                });
  functions.add("answer", 2, 2, "(answer QUESTION 'slot): what the answer has there, or nil",
                [](const World& world, Values arguments) {
                  const std::string& slot = text_of(arguments, 1, "answer");
                  if (const Answer* const answer = answer_to(world, arguments, "answer"))
                    for (const Argument& one : answer->results)
                      if (normal(one.name) == normal(slot))
                        return value_of(one);
                  return Value();
                });
}

}  // namespace saphira::intentions
