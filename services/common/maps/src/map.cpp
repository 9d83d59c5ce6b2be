#include "saphira/maps/map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "saphira/base/enumerators.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"
#include "saphira/maps/artifact_traits.hpp"

namespace saphira::maps {

namespace {

using lps::PointType;

constexpr double kMillimetre = 0.001;
constexpr double kMax = 1e7;        // [mm] 10 km: more is a typing error
constexpr double kMaxAngle = 3600;  // [deg]
constexpr double kMaxId = 2147483647;
constexpr double kMaxSpeed = 10000;  // [mm/s]

constexpr std::array<std::pair<ZoneRule, std::string_view>, 4> kRules{
    {{ZoneRule::keep_out, "keep-out"},
     {ZoneRule::slow, "slow"},
     {ZoneRule::one_way, "one-way"},
     {ZoneRule::preferred, "preferred"}}};
static_assert(kRules.size() == kEnumerators<ZoneRule>.size());

/// Line breaks and other control characters, which no line of a file can hold.
bool has_control(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7F;
  });
}

// Reads one line: words and numbers between blanks, commas and parentheses.
class Scanner {
 public:
  Scanner(const std::string& file, std::string_view line, int number)
      : file_(file), line_(line), number_(number) {
    if (!line_.empty() && line_.back() == '\r')
      line_.remove_suffix(1);
  }

  /// True where only blanks and a comment are left.
  bool at_end() {
    while (at_ < line_.size() && blank(line_[at_]))
      ++at_;
    return at_ == line_.size() || line_[at_] == ';';
  }

  /// The next word; empty at the end of the line.
  std::string_view word() {
    if (at_end())
      return token(0);
    std::size_t end = at_;
    while (end < line_.size() && !blank(line_[end]) &&
           std::string_view(",();\"").find(line_[end]) == std::string_view::npos)
      ++end;
    return token(std::max<std::size_t>(end - at_, 1));
  }

  /// Takes the character if it is the next one.
  bool take(char c) {
    if (at_end() || line_[at_] != c)
      return false;
    token(1);
    return true;
  }

  double number(std::string_view what, double low, double high) {
    const std::string_view text = word();
    if (text.empty())
      fail("expected " + std::string(what) + ", found the end of the line");
    const auto value = number_in<double>(text.substr(text.starts_with('+') ? 1 : 0));
    if (!value || !std::isfinite(*value))
      fail("expected a number (" + std::string(what) + "), found \"" + std::string(text) + "\"");
    if (*value < low || *value > high)
      fail("expected " + std::string(what) + " between " + decimal(low, 0) + " and " +
           decimal(high, 0) + ", found " + std::string(text));
    return *value;
  }

  /// "..." up to the closing mark; the caller has seen the opening one.
  std::string quoted() {
    const std::size_t end = line_.find('"', at_ + 1);
    if (end == std::string_view::npos) {
      token(1);
      fail("expected a closing \" on the same line");
    }
    const std::string_view text = token(end + 1 - at_);
    if (text.size() == 2)
      fail("expected a name between the quotation marks");
    if (has_control(text))
      fail("expected a name without control characters");
    return std::string(text.substr(1, text.size() - 2));
  }
  bool at_quote() { return !at_end() && line_[at_] == '"'; }

  /// At the token read last.
  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(file_, number_, static_cast<int>(began_) + 1, message, line_);
  }

 private:
  std::string_view token(std::size_t length) {
    began_ = at_;
    at_ += length;
    return line_.substr(began_, length);
  }

  const std::string& file_;
  std::string_view line_;
  int number_;
  std::size_t at_ = 0;
  std::size_t began_ = 0;
};

/// Nothing where no artifact has this word.
const ArtifactTraits* traits_of(std::string_view word) {
  std::string upper(word);
  for (char& c : upper)
    c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  const auto* found = std::find_if(kArtifactTraits.begin(), kArtifactTraits.end(),
                                   [&](const ArtifactTraits& each) { return each.word == upper; });
  return upper.empty() || found == kArtifactTraits.end() ? nullptr : found;
}

/// "CORRIDOR, DOOR or WALL".
std::string all_words() {
  std::vector<std::string_view> words;
  for (const ArtifactTraits& each : kArtifactTraits)
    if (!each.word.empty())
      words.push_back(each.word);
  std::string text;
  for (const std::string_view word : words)
    text.append(text.empty() ? "" : word == words.back() ? " or " : ", ").append(word);
  return text;
}

const ArtifactTraits& traits_on_map(PointType type) {
  const ArtifactTraits& result = traits(type);
  if (result.word.empty())
    throw std::invalid_argument("a map does not hold artifacts of this type");
  return result;
}

Feature parse_line(Scanner& in, std::map<std::uint32_t, int>& lines_of_ids, int number) {
  const std::string_view word = in.word();
  const ArtifactTraits* form = traits_of(word);
  if (form == nullptr)
    in.fail("expected " + all_words() + ", found \"" + std::string(word) + "\"");
  Feature feature;
  feature.type = form->type;
  if (in.take('(')) {
    if (!form->id)
      in.fail("expected x: a " + std::string(form->word) + " has no id");
    const double id = in.number("the id", 1, kMaxId);
    if (id != std::floor(id))
      in.fail("expected a whole number (the id)");
    feature.id = static_cast<std::uint32_t>(id);
    const auto [known, is_new] = lines_of_ids.emplace(feature.id, number);
    if (!is_new)
      in.fail("expected an id of its own: line " + std::to_string(known->second) + " has " +
              std::to_string(feature.id));
    if (!in.take(')')) {
      in.word();
      in.fail("expected a closing parenthesis behind the id");
    }
  } else if (form->id) {
    in.word();
    in.fail("expected the id of the " + std::string(form->word) + " in parentheses");
  }

  // Commas as in the manual, or blanks.
  const auto next = [&](std::string_view what, double low, double high) {
    in.take(',');
    return in.number(what, low, high);
  };
  feature.pose_in_map.x = in.number("x in mm", -kMax, kMax) * kMillimetre;
  feature.pose_in_map.y = next("y in mm", -kMax, kMax) * kMillimetre;
  feature.pose_in_map.th = norm2_angle(radians(next("theta in degrees", -kMaxAngle, kMaxAngle)));
  if (form->length)
    feature.length = next("the length in mm", 1, kMax) * kMillimetre;
  if (form->width)
    feature.width = next("the width in mm", 1, kMax) * kMillimetre;
  if (form->type == PointType::zone) {
    in.take(',');
    const std::string_view text = in.word();
    const auto rule = zone_rule(text);
    if (!rule)
      in.fail("expected keep-out, slow, one-way or preferred, found " +
              (text.empty() ? "the end of the line" : '"' + std::string(text) + '"'));
    feature.rule = *rule;
    if (feature.rule == ZoneRule::slow)
      feature.speed = next("the speed in mm/s", 1, kMaxSpeed) * kMillimetre;
  }
  if (in.at_quote())
    feature.name = in.quoted();
  while (!in.at_end()) {
    const std::string_view extra = in.word();
    if (extra == "learned" && !feature.learned) {
      feature.learned = true;
      continue;
    }
    in.fail("expected " +
            std::string(feature.name.empty() && !feature.learned
                            ? "a name in quotation marks or the end of the line"
                            : "the end of the line") +
            ", found \"" + std::string(extra) + "\"");
  }
  return feature;
}

std::string millimetres(double metres, double low) {
  const double value = metres / kMillimetre;
  // Three digits are written behind the point, so the rounded value counts.
  if (!(std::round(value * 1000.0) / 1000.0 >= low && value <= kMax))
    throw std::invalid_argument("a place or size that a map file does not hold");
  return decimal(value, 3);
}

std::string line_of(const Feature& feature) {
  const ArtifactTraits& form = traits_on_map(feature.type);
  if ((form.id && feature.id == 0) || feature.id > kMaxId)
    throw std::invalid_argument("a feature without an id");
  if (!std::isfinite(feature.pose_in_map.th))
    throw std::invalid_argument("a heading that is not a number");
  if (feature.name.find('"') != std::string::npos || has_control(feature.name))
    throw std::invalid_argument("a name with a quotation mark or a control character");
  std::string out(form.word);
  if (form.id)
    out += " (" + std::to_string(feature.id) + ")";
  out += " " + millimetres(feature.pose_in_map.x, -kMax) + ", " +
         millimetres(feature.pose_in_map.y, -kMax) + ", " +
         decimal(degrees(norm2_angle(feature.pose_in_map.th)), 6);
  if (form.length)
    out += ", " + millimetres(feature.length, 1);
  if (form.width)
    out += ", " + millimetres(feature.width, 1);
  if (feature.type == PointType::zone) {
    out.append(" ").append(word(feature.rule));
    if (feature.rule == ZoneRule::slow) {
      const double speed = std::round(feature.speed / kMillimetre * 1000.0) / 1000.0;
      if (!(speed >= 1.0 && speed <= kMaxSpeed))
        throw std::invalid_argument("a speed of a slow zone that is not from 0.001 to 10 m/s");
      out += " " + decimal(speed, 3);
    }
  }
  if (!feature.name.empty())
    out += " \"" + feature.name + "\"";
  if (feature.learned)
    out += " learned";
  return out + "\n";
}

}  // namespace

std::string_view word(ZoneRule rule) {
  return std::find_if(kRules.begin(), kRules.end(),
                      [&](const auto& each) { return each.first == rule; })
      ->second;
}

std::optional<ZoneRule> zone_rule(std::string_view word) {
  for (const auto& [rule, its_word] : kRules)
    if (its_word == word)
      return rule;
  return std::nullopt;
}

Map parse_map(std::string_view text, const std::string& file) {
  Map map;
  std::map<std::uint32_t, int> lines_of_ids;
  expect_own_format(text, file,
                    "a map of Saphira's, which has a line for each corridor, door and "
                    "wall (config/maps/README.md). A robot can make one: saphira map build");
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    Scanner in(file, text.substr(0, end), number);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (!in.at_end())
      map.features.push_back(parse_line(in, lines_of_ids, number));
  }
  return map;
}

namespace {

/// [m] The distance of an artifact to the next, if that is more than the size of the map without
/// it; 0 otherwise.
double distance_off(const Map& map, const Feature& one) {
  double next = 1e9;
  Vec2 low(1e9, 1e9);
  Vec2 high(-1e9, -1e9);
  for (const Feature& other : map.features) {
    if (&other == &one)
      continue;
    const Vec2 place = other.pose_in_map.position();
    next = std::min(next, (place - one.pose_in_map.position()).norm() -
                              (one.length + one.width + other.length + other.width) / 2.0);
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  }
  return next > (high - low).norm() ? next : 0.0;
}

/// FileError where the artifacts of a file that a person wrote are unlikely.
void check_likely(const Map& map, std::string_view text, const std::string& file) {
  const std::vector<Line> lines = split_lines(text);  // one for each artifact
  if (map.features.empty())
    throw FileError(file, 1, 1, "expected a line for each artifact of the map, found none");
  constexpr double kRobot = 0.4;  // [m]
  constexpr std::size_t kFew = 3;
  const bool small = std::all_of(map.features.begin(), map.features.end(), [](const Feature& one) {
    return std::abs(one.pose_in_map.x) < kRobot && std::abs(one.pose_in_map.y) < kRobot &&
           one.length < kRobot && one.width < kRobot;
  });
  if (small && map.features.size() >= kFew)
    throw FileError(file, lines.front().number, 1,
                    "the whole map is smaller than a robot: is it in metres? The unit of this file "
                    "is mm",
                    lines.front().text);
  constexpr double kFarOff = 50.0;  // [m]
  for (std::size_t i = 0; i < std::min(lines.size(), map.features.size()); ++i) {
    const double off = distance_off(map, map.features[i]);
    if (off > kFarOff && map.features.size() > kFew)
      throw FileError(file, lines[i].number, 1,
                      "expected a place near the other artifacts of the map, found one " +
                          std::to_string(std::lround(off)) + " m off (a digit too many?)",
                      lines[i].text);
  }
  std::map<std::string_view, int> lines_of_places;
  for (std::size_t i = 0; i < std::min(lines.size(), map.features.size()); ++i) {
    const Feature& one = map.features[i];
    if (one.type != PointType::position || one.name.empty())
      continue;
    const auto [known, is_new] = lines_of_places.emplace(one.name, lines[i].number);
    if (!is_new)
      throw FileError(file, lines[i].number, static_cast<int>(lines[i].text.find('"')) + 1,
                      "expected a name of its own: the POS of line " +
                          std::to_string(known->second) + " is \"" + one.name + "\", too",
                      lines[i].text);
  }
}

}  // namespace

Map check_map(std::string_view text, const std::string& file) {
  if (!text.ends_with('"'))  // a name is whole
    expect_last_line_break(text, file);
  Map map = parse_map(text, file);
  check_likely(map, text, file);
  return map;
}

Map load_map(const std::string& path) {
  return check_map(read_file(path), path);
}

std::string to_text(const Map& map) {
  std::string out;
  std::vector<std::uint32_t> ids;
  for (const Feature& feature : map.features) {
    out += line_of(feature);
    if (feature.id != 0)
      ids.push_back(feature.id);
  }
  std::sort(ids.begin(), ids.end());
  if (std::adjacent_find(ids.begin(), ids.end()) != ids.end())
    throw std::invalid_argument("an id twice");
  return out;
}

std::string describe(const Feature& feature) {
  std::string text(traits_on_map(feature.type).word);
  for (char& c : text)
    c = static_cast<char>(c - 'A' + 'a');
  if (feature.type == PointType::zone)
    text = std::string(word(feature.rule)) + " zone";
  text += " " + std::to_string(feature.id);
  return feature.name.empty() ? text : text + " (" + feature.name + ")";
}

const Feature* find(const Map& map, std::uint32_t id) {
  const auto found = std::find_if(map.features.begin(), map.features.end(),
                                  [&](const Feature& f) { return f.id == id && id != 0; });
  return found == map.features.end() ? nullptr : &*found;
}

std::vector<const Feature*> named(const Map& map, PointType type, std::string_view name) {
  std::vector<const Feature*> found;
  for (const Feature& feature : map.features)
    if (feature.type == type && feature.name == name)
      found.push_back(&feature);
  return found;
}

Rectangle::Rectangle(const Feature& feature)
    : to_feature_(feature.pose_in_map), half_(feature.length / 2, feature.width / 2) {}

bool Rectangle::contains(const Vec2& position_in_map) const {
  const Vec2 inside = to_feature_(position_in_map);
  return std::abs(inside.x()) <= half_.x() && std::abs(inside.y()) <= half_.y();
}

double Rectangle::distance(const Vec2& position_in_map) const {
  const Vec2 inside = to_feature_(position_in_map);
  return (inside.cwiseAbs() - half_).cwiseMax(0.0).norm();
}

bool contains(const Feature& feature, const Vec2& position_in_map) {
  return Rectangle(feature).contains(position_in_map);
}

}  // namespace saphira::maps
