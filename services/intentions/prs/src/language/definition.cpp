#include "language/definition.hpp"

namespace saphira::intentions {

const Form* Parts::option(const std::string& key) const {
  const auto it = options.find(key);
  return it == options.end() ? nullptr : it->second;
}

bool starred(std::string_view name) {
  return name.size() > 2 && name.front() == '*' && name.back() == '*';
}

std::string found(const Form& form) {
  return ", found " + quoted(to_text(form));
}

void Definition::complain(const Form& at, std::string message) {
  ++errors_;
  troubles_.push_back(reader_.trouble(at.line, at.column, true, std::move(message)));
}

void Definition::fail(const Form& at, std::string message) {
  complain(at, std::move(message));
  throw Stop();
}

void Definition::warn(const Form& at, std::string message) {
  troubles_.push_back(reader_.trouble(at.line, at.column, false, std::move(message)));
}

Parts Definition::parts(const Form& form, std::size_t from, const std::set<std::string>& known) {
  Parts result;
  for (std::size_t i = from; i < form.items.size(); ++i) {
    const Form& item = form.items[i];
    if (item.kind != Form::Kind::kKeyword) {
      result.items.push_back(&item);
      continue;
    }
    const std::string key = normal(item.text);
    if (!known.contains(key)) {
      std::string names;
      for (const std::string& each : known)
        names += (names.empty() ? ":" : ", :") + each;
      fail(item, known.empty() ? "expected no option" + found(item)
                               : "expected one of " + names + found(item));
    }
    if (i + 1 == form.items.size())
      fail(item, "expected a value after :" + key);
    if (!result.options.emplace(key, &form.items[++i]).second)
      fail(item, ":" + key + " is given twice");
  }
  return result;
}

std::size_t Definition::slot(const Form& name) {
  const std::string key = normal(name.text);
  const auto found = slots_.find(key);
  if (found != slots_.end())
    return found->second;
  const std::size_t index = program_->locals.size();
  slots_[key] = index;
  program_->locals.push_back(name.text);
  return index;
}

void Definition::check_variable(const Form& name) {
  if (name.is("t") || name.is("nil") || functions_.condition(normal(name.text)) != nullptr)
    fail(name, quoted(name.text) + " cannot be set");
}

void Definition::check_locals() {
  for (const auto& [name, use] : pending_) {
    if (!assigned_.contains(name))
      complain(use, "unknown variable " + quoted(use.text) +
                        ": expected a parameter, a variable that = binds, *an-environment-"
                        "variable* or a condition");
  }
}

}  // namespace saphira::intentions
