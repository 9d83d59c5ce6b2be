#include "saphira/protocol/parameters.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>

#include "saphira/base/text.hpp"

namespace saphira::protocol {

namespace {

constexpr double kMillimetre = 0.001;
constexpr int kMaxSonars = 64;

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z')
      c = static_cast<char>(c - 'A' + 'a');
  return out;
}

bool begins_number(std::string_view word) {
  return !word.empty() &&
         (word[0] == '-' || word[0] == '+' || word[0] == '.' || (word[0] >= '0' && word[0] <= '9'));
}

// A keyword whose value is one number.
struct NumberKeyword {
  std::string_view name;
  double RobotParameters::*field;
  double unit;  // of the file's number, in SI
  double low;   // in the file's unit
  double high;
};

using P = RobotParameters;
constexpr double kDegree = kPi / 180.0;
// The later names of the same things are taken as well, so that the files of later robots load.
constexpr std::array kNumbers{
    NumberKeyword{"AngleConvFactor", &P::angle_unit, 1.0, 1e-9, 1.0},
    NumberKeyword{"DistConvFactor", &P::distance_unit, kMillimetre, 1e-6, 1000.0},
    NumberKeyword{"VelConvFactor", &P::velocity_unit, kMillimetre, 1e-6, 1000.0},
    NumberKeyword{"RangeConvFactor", &P::range_unit, kMillimetre, 0.08, 1000.0},
    NumberKeyword{"DiffConvFactor", &P::rotation_per_difference, 1.0 / kMillimetre, 1e-6, 1.0},
    NumberKeyword{"Vel2Divisor", &P::vel2_unit, kMillimetre, 0.01, 1000.0},
    NumberKeyword{"RobotRadius", &P::radius, kMillimetre, 1.0, 10000.0},
    NumberKeyword{"RobotDiagonal", &P::diagonal, kMillimetre, 0.0, 10000.0},
    NumberKeyword{"MaxVelocity", &P::max_velocity, kMillimetre, 1.0, 10000.0},
    NumberKeyword{"MaxRVelocity", &P::max_rotation_velocity, kDegree, 1.0, 1000.0},
    NumberKeyword{"Acceleration", &P::acceleration, kMillimetre, 1.0, 100000.0},
    NumberKeyword{"TransAccel", &P::acceleration, kMillimetre, 1.0, 100000.0},
    NumberKeyword{"Deceleration", &P::deceleration, kMillimetre, 1.0, 100000.0},
    NumberKeyword{"TransDecel", &P::deceleration, kMillimetre, 1.0, 100000.0},
    NumberKeyword{"RotAcceleration", &P::rotation_acceleration, kDegree, 1.0, 100000.0},
    NumberKeyword{"RotAccel", &P::rotation_acceleration, kDegree, 1.0, 100000.0},
    NumberKeyword{"RotDeceleration", &P::rotation_deceleration, kDegree, 1.0, 100000.0},
    NumberKeyword{"RotDecel", &P::rotation_deceleration, kDegree, 1.0, 100000.0},
    NumberKeyword{"EncodeJitter", &P::encode_jitter, 1.0, 0.0, 1.0},
    NumberKeyword{"AngleJitter", &P::angle_jitter, 1.0, 0.0, 1.0},
    NumberKeyword{"AngleDrift", &P::angle_drift, 1.0, 0.0, 1.0},
    NumberKeyword{"Battery", &P::battery, 1.0, 0.0, 25.5},
    NumberKeyword{"FrontMaxRange", &P::front_max_range, kMillimetre, 0.0, 100000.0},
};

class Parser {
 public:
  Parser(std::string_view text, const std::string& file) : lines_(split_lines(text)) {
    parameters_.file = file;
  }

  RobotParameters parse() {
    while (next_ < lines_.size()) {
      LineReader in(parameters_.file, lines_[next_++]);
      keyword(in);
      in.expect_end();
    }
    finish_sonars();
    return std::move(parameters_);
  }

 private:
  void keyword(LineReader& in) {
    const std::string name = lower(in.word("a keyword"));
    if (name == "sonarunit") {
      sonar_unit(in);
      return;
    }
    const int line = lines_[next_ - 1].number;
    if (const auto [seen, is_new] = seen_.emplace(name, line); !is_new)
      in.fail("expected each keyword once; it stands on line " + std::to_string(seen->second) +
              " already");
    for (const NumberKeyword& k : kNumbers) {
      if (lower(k.name) != name)
        continue;
      to_value(in);
      parameters_.*k.field = in.number(k.name, k.low, k.high) * k.unit;
      return;
    }
    if (name == "name" || name == "class" || name == "subclass") {
      std::string& field = name == "name"    ? parameters_.name
                           : name == "class" ? parameters_.robot_class
                                             : parameters_.subclass;
      field = in.word("a word behind " + name);
    } else if (name == "sonarnum") {
      to_value(in);
      sonar_count_.emplace(in);
      sonar_count_number_ = in.integer("number of sonars", 0, kMaxSonars);
      *sonar_count_ = in;
    } else if (name == "frontbuffer" || name == "sidebuffer") {
      to_value(in);
      int& field = name == "frontbuffer" ? parameters_.front_buffer : parameters_.side_buffer;
      field = static_cast<int>(in.integer("number of readings", 1, 200));  // CBUF_LEN of 6.6.1
    } else {
      in.fail("expected a keyword of a robot parameter file (such as RobotRadius or SonarUnit)");
    }
  }

  // Steps to the line behind where the value stands there.
  void to_value(LineReader& in) {
    if (in.at_end() && next_ < lines_.size() && begins_number(lines_[next_].words[0].text))
      in = LineReader(parameters_.file, lines_[next_++]);
  }

  void sonar_unit(LineReader& in) {
    const long number = in.integer("sonar number", 0, kMaxSonars - 1);
    const auto is_same = [number](const SonarUnit& unit) { return unit.number == number; };
    if (std::any_of(parameters_.sonars.begin(), parameters_.sonars.end(), is_same))
      in.fail("expected each sonar once; this one stands above already");
    SonarUnit unit;
    unit.number = static_cast<std::uint8_t>(number);
    unit.pose_in_robot.x = in.number("x of the sonar in mm", -10000, 10000) * kMillimetre;
    unit.pose_in_robot.y = in.number("y of the sonar in mm", -10000, 10000) * kMillimetre;
    unit.pose_in_robot.th =
        norm2_angle(radians(in.number("bearing of the sonar in degrees", -360, 360)));
    parameters_.sonars.push_back(unit);
    unit_lines_[static_cast<int>(number)] = lines_[next_ - 1].number;
  }

  void finish_sonars() {
    auto& sonars = parameters_.sonars;
    if (!sonar_count_) {
      if (!sonars.empty())
        throw FileError(parameters_.file, lines_.back().number, 1,
                        "expected SonarNum, the number of sonars, in a file with SonarUnit lines");
      return;
    }
    std::sort(sonars.begin(), sonars.end(),
              [](const SonarUnit& a, const SonarUnit& b) { return a.number < b.number; });
    // The manual's own sample describes a unit 7 of seven (0 to 6).
    while (!sonars.empty() && sonars.back().number >= sonar_count_number_) {
      parameters_.warnings.push_back(
          parameters_.file + ":" + std::to_string(unit_lines_[sonars.back().number]) +
          ": SonarUnit " + std::to_string(sonars.back().number) + " is left out: SonarNum is " +
          std::to_string(sonar_count_number_));
      sonars.pop_back();
    }
    for (int i = 0; i < sonar_count_number_; ++i)
      if (!unit_lines_.contains(i))
        sonar_count_->fail("expected as many SonarUnit lines as SonarNum says; SonarUnit " +
                           std::to_string(i) + " is missing");
  }

  std::vector<Line> lines_;
  std::size_t next_ = 0;
  RobotParameters parameters_;
  std::map<std::string, int> seen_;        // keyword, line
  std::map<int, int> unit_lines_;          // sonar, line
  std::optional<LineReader> sonar_count_;  // where an error about the number of units points to
  long sonar_count_number_ = 0;
};

}  // namespace

RobotParameters parse_parameters(std::string_view text, const std::string& file) {
  return Parser(text, file).parse();
}

RobotParameters load_parameters(const std::string& path) {
  return parse_parameters(read_file(path), path);
}

std::vector<std::string> parameter_file_names(std::string_view robot_class,
                                              std::string_view subclass) {
  std::vector<std::string> names;
  for (const std::string_view text : {subclass, robot_class}) {
    const std::string name = lower(text);
    const bool plain =
        !name.empty() && name[0] != '.' && std::all_of(name.begin(), name.end(), [](char c) {
          return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
                 c == '+' || c == '.';
        });
    if (plain && (names.empty() || names[0] != name + ".p"))
      names.push_back(name + ".p");
  }
  return names;
}

}  // namespace saphira::protocol
