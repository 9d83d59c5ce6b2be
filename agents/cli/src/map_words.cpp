#include "saphira/cli/map_words.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "lps/shell/convert.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/base/units.hpp"
#include "saphira/maps/artifact_traits.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::cli {
namespace {

constexpr std::size_t kDoors = 3;    ///< closed doors named at most
constexpr double kAnywhere = 100.0;  ///< [m] with a larger sigma there is no useful place

/// A form of `saphira map`; kForms has them in the order of its help.
struct Form {
  std::string_view verb;
  std::string_view rest;
};
constexpr std::array<Form, 16> kForms{
    {{"follow", ""},
     {"list", ""},
     {"save", " FILE"},
     {"show", " FILE.svg"},
     {"build", " [FILE]"},
     {"load", " FILE or the name of a shipped map"},
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
  for (const Form& form : kForms)
    if (!words.empty() && form.verb == words.front())
      throw std::invalid_argument("expected " + std::string(form.verb) + std::string(form.rest) +
                                  ", found " + counted(words.size() - 1, "word") + " after it");
  throw std::invalid_argument("expected " + situation::listed(map_verbs(), " or ") +
                              (words.empty() ? ""
                                             : ", found \"" + words.front() + "\"" +
                                                   did_you_mean(words.front(), map_verbs())));
}

double number(const std::string& word, const std::string& what, const char* unit) {
  const std::optional<double> value = measured(word, unit);
  if (!value)
    throw std::invalid_argument("expected " + what + (*unit == '\0' ? "" : " [") + unit +
                                (*unit == '\0' ? "" : "]") + ", found \"" + word + "\"");
  return *value;
}

bool on_or_off(const std::string& word) {
  if (word != "on" && word != "off")
    throw std::invalid_argument("expected on or off, found \"" + word + "\"");
  return word == "on";
}

/// The request's arguments for the artifact of one line of a map file.
Arguments artifact(const std::string& line) {
  const maps::Map map = maps::parse_map(line, "the line");
  if (map.features.size() != 1)
    throw std::invalid_argument("expected one artifact, such as \"DOOR (3) 3000, 1000, 90, 900\"");
  const maps::Feature& one = map.features.front();
  Arguments arguments{{"id", static_cast<double>(one.id)},
                      {"type", std::string(maps::traits(one.type).word)},
                      {"position", PlacedPoint{one.pose_in_map, Frame::map}},
                      {"length", one.length},
                      {"width", one.width},
                      {"name", one.name}};
  if (one.type == lps::PointType::zone) {
    arguments.push_back({"rule", std::string(maps::word(one.rule))});
    arguments.push_back({"speed", one.speed});
  }
  return arguments;
}

Pose place_of(const std::vector<std::string>& words, const maps::Map& map) {
  if (words.size() == 4) {
    const double heading = number(words[3], "the heading", "rad");
    if (std::abs(heading) > 2.0 * kPi)
      throw std::invalid_argument("expected the heading [rad] from -2 pi to 2 pi, found \"" +
                                  words[3] + "\"; degrees are written " + words[3] + "deg");
    return {number(words[1], "x", "m"), number(words[2], "y", "m"), norm2_angle(heading)};
  }
  if (words.size() != 2)
    complain(words);
  const auto places = maps::named(map, lps::PointType::position, words[1]);
  if (places.empty())
    throw std::invalid_argument(
        "expected place X Y TH [m, rad] or the name of a POS; the map has no "
        "POS \"" +
        words[1] + "\"");
  return places.front()->pose_in_map;
}

}  // namespace

Request parse_map_request(const std::vector<std::string>& words, const maps::Map& map) {
  const std::string& verb = words.empty() ? "" : words.front();
  const std::size_t count = words.size();
  if (verb == "load" && count == 2) {
    const std::string file = find_file(config_folder() + "/maps", words[1], ".map");
    maps::load_map(file);  // refuses a file that is cut off, too
    return {"load", {{"name", file}, {"text", read_file(file)}}};
  }
  if (verb == "put" && count == 2)
    return {"put", artifact(words[1])};
  if (verb == "remove" && count == 2) {
    const double id = number(words[1], "the id of an artifact", "");
    if (id < 1.0 || id != std::floor(id) || id > 4294967295.0)
      throw std::invalid_argument("expected the id of an artifact, found \"" + words[1] + "\"");
    return {"remove", {{"id", id}}};
  }
  if (verb == "place")
    return {"place", {{"position", PlacedPoint{place_of(words, map), Frame::map}}}};
  if ((verb == "delete" || verb == "find") && count == 1)
    return {verb};
  if ((verb == "on" || verb == "off") && count == 1)
    return {"switch", {{"on", verb == "on"}}};
  if (verb == "features" && count == 2)
    return {"add_features", {{"on", on_or_off(words[1])}}};
  if (verb == "snap" && count == 2)
    return {"snap", {{"on", on_or_off(words[1])}}};
  complain(words);
}

std::vector<std::string> map_verbs() {
  std::vector<std::string> all;
  for (const Form& form : kForms)
    all.emplace_back(form.verb);
  return all;
}

void check_map_words(const std::vector<std::string>& words) {
  for (const Form& form : kForms) {
    if (words.empty() || form.verb != words.front())
      continue;
    // Only the map knows a place by its name; a pose with the robot is the robot's.
    const bool named = words.front() == "place" && words.size() == 2;
    const bool looks = form.verb == "follow" || form.verb == "list" || form.verb == "save" ||
                       form.verb == "show" || form.verb == "build" || form.verb == "route";
    if (looks && words.size() != (form.rest.empty() ? 1U : 2U) && form.rest != " [FILE]")
      complain(words);
    if (!looks && !named)
      parse_map_request(words, {});
    return;
  }
  if (!words.empty())
    complain(words);
}

const char* name_of(v1::RegistrationState state) {
  return word_of(state, {"off", "unplaced", "lost", "tracking"});
}

std::string describe(const v1::Registration& registration, const maps::Map& map) {
  const v1::Covariance2& c = registration.covariance;
  // The longer axis of the ellipse of one sigma.
  const double middle = 0.5 * (c.xx + c.yy);
  const double spread = std::hypot(0.5 * (c.xx - c.yy), c.xy);
  const double sigma = std::sqrt(std::max(0.0, middle + spread));
  std::string text = name_of(registration.state);
  text.resize(8, ' ');
  if (sigma < kAnywhere) {
    const v1::Pose2& pose = registration.pose_in_map;
    text += format(" (%.2f, %.2f, %.0f deg) +-%.2f m, %.1f deg, %.0f %% sure", pose.x, pose.y,
                   degrees(pose.th), sigma, degrees(std::sqrt(std::max(0.0, c.thth))),
                   100.0 * registration.confidence);
  } else {
    text += " it may be anywhere";
  }
  if (const maps::Feature* in =
          registration.environment == 0 ? nullptr : maps::find(map, registration.environment))
    text += ", in " + describe(*in);
  std::size_t accepted = 0;
  for (const v1::Match& match : registration.matches)
    accepted += match.accepted ? 1U : 0U;
  if (!registration.matches.empty())
    text += ", " + std::to_string(accepted) + " of " + std::to_string(registration.matches.size()) +
            " matched";
  std::size_t told = 0;
  for (const std::uint32_t id : registration.closed_doors)
    if (const maps::Feature* const door = maps::find(map, id); door != nullptr && told++ < kDoors)
      text += ", " + describe(*door) + " closed";
  if (told > kDoors)
    text += " and " + std::to_string(told - kDoors) + " more";
  return registration.reason.empty() ? text : text + ": " + registration.reason;
}

}  // namespace saphira::cli
