#include "saphira/security/roles.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/subject.hpp"

namespace saphira::security {
namespace {

constexpr const char* kAny = "any";

std::string joined(const std::set<std::string>& words) {
  const std::string text = saphira::joined(words);
  return text.empty() ? "nobody" : text;
}

const TopicRule* rule_of(const Roles& roles, std::string_view topic) {
  const auto found = std::find_if(roles.topics.begin(), roles.topics.end(),
                                  [&](const TopicRule& rule) { return rule.topic == topic; });
  return found == roles.topics.end() ? nullptr : &*found;
}

class Parser {
 public:
  Parser(const std::string& text, const std::string& file, const std::vector<std::string>* topics)
      : text_(text), file_(file), topics_(topics) {
    roles_.text = text;
  }

  Roles parse() {
    YAML::Node root;
    try {
      root = YAML::Load(text_);
    } catch (const YAML::Exception& error) {
      fail(error.mark, "not YAML: " + error.msg);
    }
    const YAML::Node roles = member(root, root, "roles", "roles: and topics:");
    const YAML::Node topics = member(root, root, "topics", "roles: and topics:");
    only(root, {"roles", "topics", "seal"});
    if (root["seal"]) {
      if (word(root["seal"], "required") != "required")
        fail(root["seal"].Mark(), "expected seal: required, or no such line");
      roles_.seal_required = true;
    }
    for (const auto& entry : map(roles, "roles"))
      role(entry.first, entry.second);
    for (const auto& entry : map(topics, "topics"))
      topic(entry.first, entry.second);
    if (topics_ != nullptr)
      for (const std::string& one : *topics_)
        if (rule_of(roles_, one) == nullptr)
          fail(topics.Mark(), "the topic " + one + " is missing: which roles write and read it?");
    return std::move(roles_);
  }

 private:
  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& message) const {
    const int line = std::max(mark.line, 0) + 1;
    std::istringstream lines(text_);
    std::string of_it;
    for (int i = 0; i < line; ++i)
      if (!std::getline(lines, of_it))
        of_it.clear();
    throw FileError(file_, line, std::max(mark.column, 0) + 1, message, of_it);
  }

  const YAML::Node& map(const YAML::Node& node, const std::string& what) const {
    if (!node.IsMap())
      fail(node.Mark(), "expected " + what + ", as NAME: and what it has");
    std::set<std::string> seen;
    for (const auto& entry : node)
      if (!seen.insert(word(entry.first, "a name")).second)
        fail(entry.first.Mark(), "\"" + entry.first.Scalar() + "\" is there already");
    return node;
  }

  YAML::Node member(const YAML::Node& node, const YAML::Node& at, const std::string& key,
                    const std::string& expected) const {
    if (!node.IsMap() || !node[key])
      fail(at.Mark(), "expected " + expected);
    return node[key];
  }

  void only(const YAML::Node& node, const std::vector<std::string>& keys) const {
    for (const auto& entry : map(node, "keys"))
      if (std::find(keys.begin(), keys.end(), entry.first.Scalar()) == keys.end())
        fail(entry.first.Mark(), "unknown key \"" + entry.first.Scalar() + "\"" +
                                     did_you_mean(entry.first.Scalar(), keys));
  }

  std::string word(const YAML::Node& node, const std::string& what) const {
    if (!node.IsScalar() || node.Scalar().empty())
      fail(node.Mark(), "expected " + what);
    return node.Scalar();
  }

  std::vector<std::pair<std::string, YAML::Node>> words(const YAML::Node& node,
                                                        const std::string& what) const {
    if (!node.IsSequence())
      fail(node.Mark(), "expected a list of " + what + ", such as [one, other]");
    std::vector<std::pair<std::string, YAML::Node>> all;
    for (const auto& entry : node)
      all.emplace_back(word(entry, "one of the " + what), entry);
    return all;
  }

  void role(const YAML::Node& name, const YAML::Node& node) {
    Role made;
    made.name = name.Scalar();
    if (!is_name(made.name) || made.name == kAny)
      fail(name.Mark(), "expected the name of a role (letters, digits and hyphens; not any)");
    only(node, {"about", "programs"});
    made.about = word(member(node, name, "about", "about: a few words on the role"), "a few words");
    if (node["programs"])
      for (const auto& [program, at] : words(node["programs"], "programs")) {
        if (roles_.of_program(program) != nullptr)
          fail(at.Mark(), program + " has the role " + roles_.of_program(program)->name);
        made.programs.push_back(program);
      }
    roles_.roles.push_back(std::move(made));
  }

  void topic(const YAML::Node& name, const YAML::Node& node) {
    TopicRule made;
    made.topic = name.Scalar();
    if (topics_ != nullptr &&
        std::find(topics_->begin(), topics_->end(), made.topic) == topics_->end())
      fail(name.Mark(),
           "there is no topic \"" + made.topic + "\"" + did_you_mean(made.topic, *topics_));
    only(node, {"write", "read"});
    made.writers = roles_in(member(node, name, "write", "write: [roles]"));
    made.readers = roles_in(member(node, name, "read", "read: [roles]"));
    roles_.topics.push_back(std::move(made));
  }

  std::set<std::string> roles_in(const YAML::Node& node) const {
    std::vector<std::string> known;
    for (const Role& role : roles_.roles)
      known.push_back(role.name);
    std::set<std::string> found;
    for (const auto& [role, at] : words(node, "roles")) {
      if (role == kAny)
        found.insert(known.begin(), known.end());
      else if (roles_.find(role) == nullptr)
        fail(at.Mark(), "there is no role \"" + role + "\"" + did_you_mean(role, known));
      else
        found.insert(role);
    }
    return found;
  }

  const std::string& text_;
  const std::string& file_;
  const std::vector<std::string>* topics_;
  Roles roles_;
};

}  // namespace

const Role* Roles::find(std::string_view role) const {
  const auto found =
      std::find_if(roles.begin(), roles.end(), [&](const Role& one) { return one.name == role; });
  return found == roles.end() ? nullptr : &*found;
}

const Role* Roles::of_program(std::string_view program) const {
  const auto found = std::find_if(roles.begin(), roles.end(), [&](const Role& one) {
    return std::find(one.programs.begin(), one.programs.end(), program) != one.programs.end();
  });
  return found == roles.end() ? nullptr : &*found;
}

bool Roles::may_write(std::string_view role, std::string_view topic) const {
  const TopicRule* const rule = rule_of(*this, topic);
  return rule != nullptr && rule->writers.contains(std::string(role));
}

bool Roles::may_read(std::string_view role, std::string_view topic) const {
  const TopicRule* const rule = rule_of(*this, topic);
  return rule != nullptr && rule->readers.contains(std::string(role));
}

std::string Roles::those_that_write(std::string_view topic) const {
  const TopicRule* const rule = rule_of(*this, topic);
  return joined(rule == nullptr ? std::set<std::string>{} : rule->writers);
}

std::string Roles::those_that_read(std::string_view topic) const {
  const TopicRule* const rule = rule_of(*this, topic);
  return joined(rule == nullptr ? std::set<std::string>{} : rule->readers);
}

const std::vector<std::string>& topics_of_contract() {
  static const std::vector<std::string> names{
#define SAPHIRA_TOPIC(constant, name, type, qos) name,
#include "saphira/bus/topics.def"
  };
  return names;
}

Roles parse_roles(const std::string& text, const std::string& file,
                  const std::vector<std::string>& topics) {
  return Parser(text, file, &topics).parse();
}

Roles parse_signed_roles(const std::string& text, const std::string& file) {
  return Parser(text, file, nullptr).parse();
}

}  // namespace saphira::security
