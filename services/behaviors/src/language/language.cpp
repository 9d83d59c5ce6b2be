#include "saphira/behaviors/language.hpp"

#include <algorithm>
#include <tuple>

#include "program.hpp"

namespace saphira::behaviors {
namespace {

Schema schema_of(const language::ParsedBehavior& parsed,
                 std::shared_ptr<const language::Program> program, const std::string& file) {
  Schema schema;
  schema.name = parsed.name;
  schema.summary = parsed.summary;
  schema.source = file;
  for (const language::ParsedParameter& parameter : parsed.parameters)
    schema.parameters.push_back(parameter.spec);
  for (const language::ParsedRule& rule : parsed.rules)
    schema.rules.push_back({rule.name, rule.antecedent_text, rule.action_text});
  schema.make = [program = std::move(program)] { return language::make_instance(program); };
  return schema;
}

void in_order(std::vector<FileError>& messages) {
  std::stable_sort(messages.begin(), messages.end(), [](const FileError& a, const FileError& b) {
    return std::tuple(a.line(), a.column()) < std::tuple(b.line(), b.column());
  });
}

}  // namespace

Compiled compile(std::string_view text, const std::string& file) {
  constexpr std::size_t most_bytes = 1'000'000;
  language::Messages messages(file, text);
  Compiled out;
  if (text.size() > most_bytes) {
    messages.error({}, "expected a file of at most a million bytes");
  } else if (const std::string_view other = other_format(text); !other.empty()) {
    messages.errors.emplace_back(file, 1, 1,
                                 "this is " + std::string(other) + ", and not a file of behaviors");
  } else {
    const std::vector<language::Token> tokens = language::tokenize(text, messages);
    std::vector<language::ParsedBehavior> parsed;
    if (messages.errors.empty())
      parsed = language::parse(tokens, messages);
    if (parsed.empty() && messages.errors.empty())
      messages.error({}, "expected \"BeginBehavior\"; there is no behavior in this file");
    for (const language::ParsedBehavior& behavior : parsed) {
      const auto twice = std::any_of(out.schemas.begin(), out.schemas.end(),
                                     [&](const Schema& s) { return s.name == behavior.name; });
      if (twice)
        messages.error(behavior.place, "the behavior \"" + behavior.name + "\" is there twice");
      else if (auto program = language::compile_behavior(behavior, messages))
        out.schemas.push_back(schema_of(behavior, std::move(program), file));
    }
  }
  out.errors = std::move(messages.errors);
  out.warnings = std::move(messages.warnings);
  in_order(out.errors);
  in_order(out.warnings);
  if (!out.errors.empty())
    out.schemas.clear();
  return out;
}

}  // namespace saphira::behaviors
