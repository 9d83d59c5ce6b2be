#include "saphira/security/subject.hpp"

#include <algorithm>
#include <map>

#include "saphira/base/numbers.hpp"

namespace saphira::security {
namespace {

constexpr std::size_t kLongestName = 32;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ')
    text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ')
    text.remove_suffix(1);
  return text;
}

}  // namespace

bool is_name(std::string_view text) {
  const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !text.empty() && text.size() <= kLongestName && letter(text.front()) &&
         std::all_of(text.begin(), text.end(),
                     [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-'; });
}

std::string common_name(const Subject& subject) {
  return subject.name + "." + std::to_string(subject.issue);
}

std::string to_text(const Subject& subject) {
  return "CN=" + common_name(subject) + ",OU=" + subject.role + ",O=" + subject.site;
}

std::optional<Subject> parse_subject(std::string_view text) {
  std::map<std::string_view, std::string_view> parts;
  const char separator = text.starts_with('/') ? '/' : ',';
  if (separator == '/')
    text.remove_prefix(1);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    const std::string_view part = text.substr(0, end);
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos ||
        !parts.emplace(trimmed(part.substr(0, equals)), trimmed(part.substr(equals + 1))).second)
      return std::nullopt;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (parts.size() != 3 || !parts.contains("CN") || !parts.contains("OU") || !parts.contains("O"))
    return std::nullopt;
  const std::string_view common = parts["CN"];
  const std::size_t dot = common.find('.');
  if (dot == std::string_view::npos)
    return std::nullopt;
  Subject subject{std::string(common.substr(0, dot)), 0, std::string(parts["OU"]),
                  std::string(parts["O"])};
  const std::string_view issue = common.substr(dot + 1);
  subject.issue = number_in<decltype(subject.issue)>(issue).value_or(0);
  if (subject.issue == 0 || issue.front() == '0' || !is_name(subject.name) ||
      !is_name(subject.role) || !is_name(subject.site))
    return std::nullopt;
  return subject;
}

}  // namespace saphira::security
