#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "language/compiler.hpp"
#include "saphira/base/text.hpp"

namespace saphira::intentions {
namespace {

/// The error of one mention in an activity of a schema; nothing where it is right.
void check_mention(const Schema& activity, const Mention& mention, const Registry& registry,
                   std::vector<Diagnostic>& troubles, std::set<std::string>& told) {
  const auto trouble = [&](bool error, int line, int column, std::string message,
                           const std::string& text) {
    troubles.push_back({error, activity.source, line, column, std::move(message), text});
  };
  std::vector<std::string> names;
  std::vector<std::string> required;
  if (const auto schema = registry.intended(mention.schema)) {
    for (const Parameter& parameter : schema->parameters) {
      names.push_back(parameter.name);
      if (parameter.required)
        required.push_back(parameter.name);
    }
  } else if (const BehaviorSignature* const behavior = registry.behavior(mention.schema)) {
    if (activity.concurrent)
      trouble(true, mention.line, mention.column,
              quoted(mention.schema) + " is a behavior: a concurrent activity does not drive",
              mention.line_text);
    for (const Parameter& parameter : behavior->parameters) {
      names.push_back(parameter.name);
      if (parameter.required)
        required.push_back(parameter.name);
    }
  } else if (registry.knows_behaviors()) {
    trouble(true, mention.line, mention.column,
            "unknown schema " + quoted(mention.schema) + ": neither an activity nor a behavior",
            mention.line_text);
    return;
  } else {
    if (told.insert(normal(mention.schema)).second)
      trouble(false, mention.line, mention.column,
              quoted(mention.schema) +
                  " is no activity: whether it is a behavior is known when they are",
              mention.line_text);
    return;
  }
  const std::string list = joined(names);
  for (std::size_t i = 0; i < mention.arguments.size(); ++i) {
    const bool known = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return normal(name) == normal(mention.arguments[i]);
    });
    if (!known)
      trouble(true, mention.lines[i], mention.columns[i],
              mention.schema + " has no parameter " + quoted(mention.arguments[i]) + ": expected " +
                  (list.empty() ? "none" : list),
              mention.argument_texts[i]);
  }
  for (const std::string& name : required) {
    const bool given =
        std::any_of(mention.arguments.begin(), mention.arguments.end(),
                    [&](const std::string& argument) { return normal(name) == normal(argument); });
    if (!given)
      trouble(true, mention.line, mention.column,
              mention.schema + " needs the parameter " + quoted(name), mention.line_text);
  }
}

}  // namespace

std::string Diagnostic::text() const {
  return FileError(file, line, column, (error ? "" : "warning: ") + message, line_text).what();
}

bool Loaded::ok() const {
  return std::none_of(troubles.begin(), troubles.end(),
                      [](const Diagnostic& trouble) { return trouble.error; });
}

Loaded load_activities(const std::vector<ActivityFile>& files, const Functions& functions,
                       const Registry& known) {
  struct Each {
    std::vector<Schema> schemas;
    std::vector<Diagnostic> troubles;
    bool broken() const {
      return std::any_of(troubles.begin(), troubles.end(),
                         [](const Diagnostic& trouble) { return trouble.error; });
    }
  };
  std::vector<Each> each(files.size());
  std::map<std::string, std::string> defined;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (const std::string_view other = other_format(files[i].content); !other.empty()) {
      each[i].troubles.push_back(
          {true, files[i].name, 1, 1,
           "this is " + std::string(other) + ", and not a file of activities", ""});
      continue;
    }
    Reader reader(files[i].name, files[i].content, each[i].troubles);
    const std::vector<Form> forms = reader.read();
    // Some editors empty a file before they write it.
    if (forms.empty() && each[i].troubles.empty())
      each[i].troubles.push_back(reader.trouble(
          1, 1, true, "expected (defintention :name ...); there is no activity in this file"));
    for (const Form& form : forms) {
      std::optional<Schema> schema =
          compile_activity(form, files[i].name, reader, functions, each[i].troubles);
      if (!schema)
        continue;
      const auto [first, fresh] = defined.emplace(normal(schema->name), files[i].name);
      const Schema* const there = known.find(schema->name);
      if (!fresh)
        each[i].troubles.push_back(reader.trouble(
            form.line, form.column, true,
            "the activity " + quoted(schema->name) + " is in " + first->second + " already"));
      else if (there != nullptr && there->source.empty())
        each[i].troubles.push_back(reader.trouble(form.line, form.column, true,
                                                  quoted(schema->name) + " is built in already"));
      else
        each[i].schemas.push_back(std::move(*schema));
    }
  }
  // A file that uses names of a broken file is not wrong for that: all names count. But a broken
  // file's own schemas are missing, so that those of an earlier version still count.
  Registry all = known;
  for (const Each& file : each) {
    for (const Schema& schema : file.schemas)
      all.add(schema);
  }
  Loaded loaded;
  for (Each& file : each) {
    std::set<std::string> told;
    for (const Schema& schema : file.schemas) {
      for (const Mention& mention : schema.program->mentions)
        check_mention(schema, mention, all, file.troubles, told);
    }
    if (!file.broken())
      std::move(file.schemas.begin(), file.schemas.end(), std::back_inserter(loaded.schemas));
    std::stable_sort(file.troubles.begin(), file.troubles.end(),
                     [](const Diagnostic& a, const Diagnostic& b) {
                       return std::pair(a.line, a.column) < std::pair(b.line, b.column);
                     });
    std::move(file.troubles.begin(), file.troubles.end(), std::back_inserter(loaded.troubles));
  }
  return loaded;
}

std::vector<Diagnostic> check_references(const Registry& registry) {
  std::vector<Diagnostic> troubles;
  std::set<std::string> told;
  for (const Schema* const schema : registry.all()) {
    if (!schema->program)
      continue;
    for (const Mention& mention : schema->program->mentions)
      check_mention(*schema, mention, registry, troubles, told);
  }
  return troubles;
}

}  // namespace saphira::intentions
