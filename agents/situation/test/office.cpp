#include "office.hpp"

#include <cctype>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <utility>

#include "process.hpp"
#include "sample.hpp"
#include "saphira/base/members.hpp"
#include "saphira/base/text.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::situation::test {
namespace {

namespace contract = saphira::test;

Program program(const std::string& name) {
  Program made;
  made.age = 0.4;
  made.status.name = name;
  made.status.state = v1::SERVICE_RUNNING;
  made.status.stamp = {7, 1000};
  made.status.uptime = 60.0;
  return made;
}

void read(const Json& json, Known& known) {
  known = {json.value("oldest", std::uint64_t{0}), json.value("newest", std::uint64_t{0})};
}
template <class T>
void read(const Json& json, std::optional<T>& sample) {
  sample = contract::sample<T>(json);
}
template <class T>
void read(const Json& json, std::vector<T>& samples) {
  samples = contract::samples<T>(json);
}
void read(const Json& json, std::vector<std::string>& words) {
  words = json.get<std::vector<std::string>>();
}
void read(const Json& json, std::vector<Program>& programs) {
  for (const auto& [name, of] : json.items()) {
    programs.push_back(program(name.substr(0, name.find('#'))));
    bus::internal::JsonReader().structure(of.value("status", Json::object()),
                                          programs.back().status, name);
    programs.back().age = of.value("age", programs.back().age);
    programs.back().namesake = of.value("namesake", false);
    programs.back().clock_behind = of.value("clock_behind", 0.0);
  }
}
template <class T>
requires std::is_arithmetic_v<T>
void read(const Json& json, T& value) {
  value = json.get<T>();
}

}  // namespace

Situation situation_of(const Json& json) {
  Situation s;
  std::size_t known = 0;
  const auto members = members_of(s);
  [&]<std::size_t... i>(std::index_sequence<i...> /*all*/) {
    const auto member = [&](const std::string& name, auto& value) {
      known += json.contains(name) ? 1U : 0U;
      if (json.contains(name) && !json[name].is_null())
        read(json[name], value);
    };
    (member(std::string(kMemberName<Situation, i>), std::get<i>(members)), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(members)>>());
  if (known < json.size())
    throw std::invalid_argument("a situation has no such member");
  // In the past, goals are known by the record of intentions.
  s.statuses_known = s.statuses_known && (!s.past || s.intentions);
  return s;
}

Json driving_json() {
  static const Json office = evaluated(
      Json::parse(read_file(contract::source("agents/situation/test/office.json"))), 1000);
  return office;
}

Json evaluated(const Json& json, std::uint64_t now) {
  Json made = json;
  if (json.is_structured())
    for (auto& each : made)
      each = evaluated(each, now);
  const std::string text = json.is_string() ? json.get<std::string>() : "";
  const std::string kind = text.substr(0, 4);
  if (kind == "big ") {
    std::string capitals = text.substr(4);
    for (char& c : capitals)
      c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return capitals;
  }
  if (kind == "num ")
    return Json::parse(text.substr(4));
  if (kind != "deg " && kind != "ago ")
    return made;
  std::size_t end = 0;
  const double value = std::stod(text.substr(4), &end);
  if (end + 4 != text.size())
    throw std::invalid_argument("expected a number, not \"" + text.substr(4) + "\"");
  if (kind == "ago ")
    return now - static_cast<std::uint64_t>(std::lround(value * 10.0));
  return radians(value);
}

}  // namespace saphira::situation::test
