#include "saphira/protocol/parameters.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <utility>

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
    NumberKeyword{"Battery", &P::battery, 1.0, 0.0, 100.0},
    NumberKeyword{"RobotLength", &P::length, kMillimetre, 1.0, 10000.0},
    NumberKeyword{"RobotWidth", &P::width, kMillimetre, 1.0, 10000.0},
    NumberKeyword{"Watchdog", &P::watchdog, kMillimetre, 0.0, 60000.0},
    NumberKeyword{"LowBattery", &P::low_battery, 1.0, 0.0, 100.0},
    NumberKeyword{"ShutdownVolts", &P::shutdown_voltage, 1.0, 0.0, 100.0},
    NumberKeyword{"SonarPeriod", &P::sonar_period, kMillimetre, 1.0, 1000.0},
    NumberKeyword{"SonarMaxRange", &P::sonar_max_range, kMillimetre, 1.0, 100000.0},
    NumberKeyword{"FrontMaxRange", &P::front_max_range, kMillimetre, 0.0, 100000.0},
};

struct FlagKeyword {
  std::string_view name;
  bool RobotParameters::*field;
};
constexpr std::array kFlags{
    FlagKeyword{"HasMoveCommand", &P::move_command},
    FlagKeyword{"SettableVelMaxes", &P::settable_velocities},
    FlagKeyword{"SettableAccsDecs", &P::settable_accelerations},
    FlagKeyword{"HasGripper", &P::gripper},
    FlagKeyword{"HasCompass", &P::compass},
    FlagKeyword{"HasGyro", &P::gyro},
    FlagKeyword{"HasCharger", &P::charger},
};

struct CountKeyword {
  std::string_view name;
  int RobotParameters::*field;
  int low;
  int high;
};
constexpr std::array kCounts{
    CountKeyword{"NumFrontBumpers", &P::front_bumpers, 0, 7},
    CountKeyword{"NumRearBumpers", &P::rear_bumpers, 0, 7},
    CountKeyword{"SonarArrays", &P::sonar_arrays, 1, 8},
    CountKeyword{"FrontBuffer", &P::front_buffer, 1, 200},  // CBUF_LEN of 6.6.1
    CountKeyword{"SideBuffer", &P::side_buffer, 1, 200},
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
    finish_protocol();
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
    for (const FlagKeyword& k : kFlags) {
      if (lower(k.name) != name)
        continue;
      parameters_.*k.field = flag(in, k.name);
      return;
    }
    for (const CountKeyword& k : kCounts) {
      if (lower(k.name) != name)
        continue;
      to_value(in);
      parameters_.*k.field = static_cast<int>(in.integer(k.name, k.low, k.high));
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
    } else if (name == "protocol") {
      protocol(in);
    } else if (name == "switchtobaudrate") {
      to_value(in);
      baud(in);
    } else if (name == "encodertickspermm") {
      to_value(in);
      parameters_.encoder_unit = kMillimetre / in.number("EncoderTicksPerMM", 0.1, 10000.0);
    } else {
      in.fail("expected a keyword of a robot parameter file (such as RobotRadius or SonarUnit)");
    }
  }

  static bool flag(LineReader& in, std::string_view name) {
    const std::string value = lower(in.word("true or false behind " + std::string(name)));
    if (value != "true" && value != "false")
      in.fail("expected true or false");
    return value == "true";
  }

  void protocol(LineReader& in) {
    const std::string value = lower(in.word("psos, p2os or arcos"));
    if (value == "psos")
      parameters_.protocol = Protocol::kPsos;
    else if (value == "p2os")
      parameters_.protocol = Protocol::kP2os;
    else if (value == "arcos")
      parameters_.protocol = Protocol::kArcos;
    else
      in.fail("expected psos, p2os or arcos");
  }

  void baud(LineReader& in) {
    constexpr std::array rates{0L, 9600L, 19200L, 38400L, 57600L, 115200L};  // of HOSTBAUD
    const long rate = in.integer("baud rate", 0, rates.back());
    if (std::find(rates.begin(), rates.end(), rate) == rates.end())
      in.fail("expected 0 (never), 9600, 19200, 38400, 57600 or 115200");
    parameters_.switch_to_baud = static_cast<int>(rate);
  }

  // What a file does not say follows from the generation of its server.
  void finish_protocol() {
    const bool later = parameters_.protocol != Protocol::kPsos;
    for (const auto& [name, field] : {std::pair{"hasmovecommand", &P::move_command},
                                      std::pair{"settablevelmaxes", &P::settable_velocities},
                                      std::pair{"settableaccsdecs", &P::settable_accelerations}})
      if (!seen_.contains(name))
        parameters_.*field = later;
    if (parameters_.length == 0.0)
      parameters_.length = 2.0 * parameters_.radius;
    if (parameters_.width == 0.0)
      parameters_.width = 2.0 * parameters_.radius;
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

std::optional<std::string> find_parameter_file(const std::string& folder,
                                               std::string_view robot_class,
                                               std::string_view subclass) {
  for (const std::string& name : parameter_file_names(robot_class, subclass))
    if (const auto path = std::filesystem::path(folder) / name; std::filesystem::exists(path))
      return path.string();
  return std::nullopt;
}

}  // namespace saphira::protocol
