#include "saphira/cli/map_words.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string_view>

#include "lps/shell/convert.hpp"
#include "maps/shell/convert.hpp"
#include "saphira/base/text.hpp"

namespace saphira::cli {
namespace {

constexpr std::size_t kDoors = 3;    ///< closed ones that are named
constexpr double kAnywhere = 100.0;  ///< [m] with a larger sigma there is no place to speak of

/// What `saphira map` understands, in the order of its help.
struct Form {
  std::string_view verb;
  std::string_view rest;
};
constexpr std::array<Form, 16> kForms{
    {{"follow", ""},
     {"list", ""},
     {"save", " FILE"},
     {"show", " [FILE.svg]"},
     {"build", " [FILE]"},
     {"load", " FILE"},
     {"delete", ""},
     {"put", " \"LINE OF A MAP FILE\""},
     {"remove", " ID"},
     {"place", " X Y TH [m, rad], or place NAME of a POS of the map"},
     {"find", ""},
     {"on", ""},
     {"off", ""},
     {"features", " on|off"},
     {"snap", " on|off"},
     {"route", " PLACE"}}};

[[noreturn]] void complain(const std::vector<std::string>& words) {
  std::string verbs;
  for (const Form& form : kForms) {
    if (!words.empty() && form.verb == words.front())
      throw std::invalid_argument("expected " + std::string(form.verb) + std::string(form.rest) +
                                  ", found " + std::to_string(words.size() - 1) +
                                  (words.size() == 2 ? " word" : " words") + " after it");
    verbs.append(verbs.empty() ? "" : &form == &kForms.back() ? " or " : ", ").append(form.verb);
  }
  throw std::invalid_argument("expected " + verbs +
                              (words.empty() ? "" : ", found \"" + words.front() + "\""));
}

double number(const std::string& word, const char* what) {
  std::size_t used = 0;
  double value = NAN;
  try {
    value = std::stod(word, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != word.size() || !std::isfinite(value))
    throw std::invalid_argument(std::string("expected ") + what + ", found \"" + word + "\"");
  return value;
}

bool on_or_off(const std::string& word) {
  if (word != "on" && word != "off")
    throw std::invalid_argument("expected on or off, found \"" + word + "\"");
  return word == "on";
}

Pose place_of(const std::vector<std::string>& words, const maps::Map& map) {
  if (words.size() == 4)
    return {number(words[1], "x [m]"), number(words[2], "y [m]"),
            norm2_angle(number(words[3], "the heading [rad]"))};
  if (words.size() != 2)
    complain(words);
  const auto places = maps::named(map, lps::PointType::position, words[1]);
  if (places.empty())
    throw std::invalid_argument("the map has no POS \"" + words[1] + "\"");
  return places.front()->pose_in_map;
}

}  // namespace

v1::RegistrationRequest parse_map_request(const std::vector<std::string>& words,
                                          const maps::Map& map) {
  v1::RegistrationRequest request;
  const std::string& verb = words.empty() ? "" : words.front();
  const std::size_t count = words.size();
  if (verb == "load" && count == 2) {
    request.action(v1::REGISTRATION_LOAD);
    request.name(words[1]);
    request.text(read_file(words[1]));
    maps::parse_map(request.text(), words[1]);
  } else if (verb == "delete" && count == 1) {
    request.action(v1::REGISTRATION_DELETE);
  } else if (verb == "put" && count == 2) {
    request.action(v1::REGISTRATION_PUT);
    const maps::Map line = maps::parse_map(words[1], "the line");
    if (line.features.size() != 1)
      throw std::invalid_argument(
          "expected one artifact, such as \"DOOR (3) 3000, 1000, 90, 900\"");
    request.artifact(maps::to_bus(line.features.front()));
  } else if (verb == "remove" && count == 2) {
    request.action(v1::REGISTRATION_REMOVE);
    const double id = number(words[1], "the id of an artifact");
    if (id < 1.0 || id != std::floor(id) || id > 4294967295.0)
      throw std::invalid_argument("expected the id of an artifact, found \"" + words[1] + "\"");
    request.artifact().id(static_cast<std::uint32_t>(id));
  } else if (verb == "place") {
    request.action(v1::REGISTRATION_PLACE);
    request.pose_in_map(lps::to_bus(place_of(words, map)));
  } else if (verb == "find" && count == 1) {
    request.action(v1::REGISTRATION_FIND);
  } else if ((verb == "on" || verb == "off") && count == 1) {
    request.action(v1::REGISTRATION_SWITCH);
    request.on(verb == "on");
  } else if (verb == "features" && count == 2) {
    request.action(v1::REGISTRATION_ADD_FEATURES);
    request.on(on_or_off(words[1]));
  } else if (verb == "snap" && count == 2) {
    request.action(v1::REGISTRATION_SNAP);
    request.on(on_or_off(words[1]));
  } else {
    complain(words);
  }
  return request;
}

const char* name_of(v1::RegistrationState state) {
  switch (state) {
    case v1::REGISTRATION_OFF:
      return "off";
    case v1::REGISTRATION_UNPLACED:
      return "unplaced";
    case v1::REGISTRATION_LOST:
      return "lost";
    case v1::REGISTRATION_TRACKING:
      return "tracking";
  }
  return "?";
}

std::string describe(const v1::Registration& registration, const maps::Map& map) {
  const v1::Covariance2& c = registration.covariance();
  // The longer axis of the ellipse of one sigma.
  const double middle = 0.5 * (c.xx() + c.yy());
  const double spread = std::hypot(0.5 * (c.xx() - c.yy()), c.xy());
  const double sigma = std::sqrt(std::max(0.0, middle + spread));
  std::string text = name_of(registration.state());
  text.resize(8, ' ');
  if (sigma < kAnywhere) {
    const v1::Pose2& pose = registration.pose_in_map();
    char numbers[120];
    std::snprintf(numbers, sizeof numbers,
                  " (%.2f, %.2f, %.0f deg) +-%.2f m, %.1f deg, %.0f %% sure", pose.x(), pose.y(),
                  degrees(pose.th()), sigma, degrees(std::sqrt(std::max(0.0, c.thth()))),
                  100.0 * registration.confidence());
    text += numbers;
  } else {
    text += " it may be anywhere";
  }
  if (const maps::Feature* in =
          registration.environment() == 0 ? nullptr : maps::find(map, registration.environment()))
    text += ", in " + describe(*in);
  std::size_t accepted = 0;
  for (const v1::Match& match : registration.matches())
    accepted += match.accepted() ? 1U : 0U;
  if (!registration.matches().empty())
    text += ", " + std::to_string(accepted) + " of " +
            std::to_string(registration.matches().size()) + " matched";
  std::size_t told = 0;
  for (const std::uint32_t id : registration.closed_doors())
    if (const maps::Feature* const door = maps::find(map, id); door != nullptr && told++ < kDoors)
      text += ", " + describe(*door) + " closed";
  if (told > kDoors)
    text += " and " + std::to_string(told - kDoors) + " more";
  return registration.reason().empty() ? text : text + ": " + registration.reason();
}

}  // namespace saphira::cli
