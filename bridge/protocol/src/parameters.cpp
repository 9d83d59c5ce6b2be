#include "saphira/protocol/parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "saphira/base/format.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"
#include "saphira/protocol/command.hpp"

namespace saphira::protocol {

namespace {

/// True where a subclass of the class Pioneer is one of its first generation. "pioneer-..." may be
/// any.
bool is_of_the_first(std::string_view subclass) {
  return subclass.starts_with("psos") ||
         (subclass.starts_with("pion") && !subclass.starts_with("pioneer-"));
}

/// The file of the same robot with a later server.
std::string later_name(const std::string& name) {
  return name + "-sh.p";
}

constexpr double kMillimetre = 0.001;
constexpr int kMaxSonars = 64;

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
  std::string_view means = "";  // that unit, for values whose wrong unit would pass unnoticed
};

using P = RobotParameters;
constexpr double kDegree = kPi / 180.0;
constexpr double kMaxRotAcceleration = 300.0 * kDegree;   // [rad/s2]
constexpr double kStopRotDeceleration = 200.0 * kDegree;  // [rad/s2]
// The later names of the same parameters are accepted too, so that the files of later robots load.
constexpr std::array kNumbers{
    NumberKeyword{"AngleConvFactor", &P::angle_unit, 1.0, 1.9e-4, 0.0246,
                  "in radians a tick, of which a turn has 256 at least and 32768 at most"},
    NumberKeyword{"DistConvFactor", &P::distance_unit, kMillimetre, 1e-3, 50.0, "in mm a tick"},
    NumberKeyword{"VelConvFactor", &P::velocity_unit, kMillimetre, 0.01, 100.0, "in mm/s"},
    NumberKeyword{"RangeConvFactor", &P::range_unit, kMillimetre, 0.08, 1000.0, "in mm a tick"},
    NumberKeyword{"DiffConvFactor", &P::rotation_per_difference, 1.0 / kMillimetre, 1e-6, 1.0,
                  "in radians a mm"},
    NumberKeyword{"Vel2Divisor", &P::vel2_unit, kMillimetre, 0.01, 1000.0, "in mm/s"},
    NumberKeyword{"RobotRadius", &P::radius, kMillimetre, 10.0, 10000.0, "in mm"},
    NumberKeyword{"RobotDiagonal", &P::diagonal, kMillimetre, 0.0, 10000.0, "in mm"},
    NumberKeyword{"MaxVelocity", &P::max_velocity, kMillimetre, 20.0, 10000.0, "in mm/s"},
    NumberKeyword{"MaxRVelocity", &P::max_rotation_velocity, kDegree, 10.0, 1000.0, "in degrees/s"},
    NumberKeyword{"Acceleration", &P::acceleration, kMillimetre, 10.0, 100000.0, "in mm/s2"},
    NumberKeyword{"TransAccel", &P::acceleration, kMillimetre, 10.0, 100000.0, "in mm/s2"},
    NumberKeyword{"Deceleration", &P::deceleration, kMillimetre, 10.0, 100000.0, "in mm/s2"},
    NumberKeyword{"TransDecel", &P::deceleration, kMillimetre, 10.0, 100000.0, "in mm/s2"},
    NumberKeyword{"RotAcceleration", &P::rotation_acceleration, kDegree, 10.0, 100000.0,
                  "in degrees/s2"},
    NumberKeyword{"RotAccel", &P::rotation_acceleration, kDegree, 10.0, 100000.0, "in degrees/s2"},
    NumberKeyword{"RotDeceleration", &P::rotation_deceleration, kDegree, 10.0, 100000.0,
                  "in degrees/s2"},
    NumberKeyword{"RotDecel", &P::rotation_deceleration, kDegree, 10.0, 100000.0, "in degrees/s2"},
    NumberKeyword{"MaxAcceleration", &P::max_acceleration, kMillimetre, 10.0, 100000.0, "in mm/s2"},
    NumberKeyword{"MaxRotAcceleration", &P::max_rotation_acceleration, kDegree, 10.0, 100000.0,
                  "in degrees/s2"},
    NumberKeyword{"StopDeceleration", &P::stop_deceleration, kMillimetre, 0.0, 100000.0},
    NumberKeyword{"StopRotDeceleration", &P::stop_rotation_deceleration, kDegree, 0.0, 100000.0},
    NumberKeyword{"HeadReach", &P::head_reach, kDegree, 0.0, 180.0, "in degrees"},
    NumberKeyword{"HeadCenter", &P::head_center, 1.0, kShortestPulse, kLongestPulse, "in us"},
    NumberKeyword{"HeadPulse", &P::head_pulse, 1.0 / kDegree, -100.0, 100.0, "in us a degree"},
    NumberKeyword{"HeadSpeed", &P::head_speed, kDegree, 1.0, 1000.0, "in degrees/s"},
    NumberKeyword{"EncodeJitter", &P::encode_jitter, 1.0, 0.0, 1.0},
    NumberKeyword{"AngleJitter", &P::angle_jitter, 1.0, 0.0, 1.0},
    NumberKeyword{"AngleDrift", &P::angle_drift, 1.0, 0.0, 1.0},
    NumberKeyword{"Battery", &P::battery, 1.0, 0.0, 100.0},
    NumberKeyword{"RobotLength", &P::length, kMillimetre, 1.0, 10000.0, "in mm"},
    NumberKeyword{"RobotWidth", &P::width, kMillimetre, 1.0, 10000.0, "in mm"},
    NumberKeyword{"Watchdog", &P::watchdog, kMillimetre, 0.0, 60000.0},
    NumberKeyword{"LowBattery", &P::low_battery, 1.0, 0.0, 100.0},
    NumberKeyword{"ShutdownVolts", &P::shutdown_voltage, 1.0, 0.0, 100.0},
    NumberKeyword{"SonarPeriod", &P::sonar_period, kMillimetre, 1.0, 1000.0},
    NumberKeyword{"SonarMaxRange", &P::sonar_max_range, kMillimetre, 1.0, 100000.0},
    NumberKeyword{"SonarMinRange", &P::sonar_min_range, kMillimetre, 0.0, 1000.0},
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

// Parameters that every robot needs. The manual's own file (chapter 10) names no class and has
// fewer parameters: it is a Pioneer 1's, and so are the defaults.
struct NeededKeyword {
  std::string_view name;
  bool with_class_only;
};
constexpr std::array kNeeded{
    NeededKeyword{"AngleConvFactor", false}, NeededKeyword{"DistConvFactor", false},
    NeededKeyword{"VelConvFactor", false},   NeededKeyword{"RangeConvFactor", false},
    NeededKeyword{"DiffConvFactor", true},   NeededKeyword{"Vel2Divisor", true},
    NeededKeyword{"RobotRadius", false},     NeededKeyword{"MaxVelocity", true},
    NeededKeyword{"MaxRVelocity", true},     NeededKeyword{"SonarNum", false},
};

// The ARIA sections with parameters of this program. The others are about lasers, cameras and the
// like, some with the same keywords.
constexpr std::array<std::string_view, 5> kAriaSections{
    "general settings", "conversion factors", "accessories the robot has",
    "movement control parameters", "sonar parameters"};

/// In their usual case.
const std::vector<std::string>& keywords() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names{
        "SonarUnit",        "SonarNum",         "Name", "Class", "Subclass", "Protocol",
        "SwitchToBaudRate", "EncoderTicksPerMM"};
    const auto add = [&names](const auto& table) {
      for (const auto& each : table)
        names.emplace_back(each.name);
    };
    add(kNumbers);
    add(kFlags);
    add(kCounts);
    return names;
  }();
  return all;
}

bool is_keyword(const std::string& name) {
  return std::any_of(keywords().begin(), keywords().end(),
                     [&name](const std::string& known) { return lowered(known) == name; });
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& file) : lines_(split_lines(text)) {
    expect_own_format(text, file, "a parameter file (.p)");
    expect_last_line_break(text, file);
    parameters_.file = file;
  }

  RobotParameters parse() {
    while (next_ < lines_.size()) {
      const Line& line = lines_[next_++];
      if (is_passed_over(line))
        continue;
      LineReader in(parameters_.file, line);
      keyword(in);
      if (!aria_)
        in.expect_end();
    }
    finish_sonars();
    finish_protocol();
    expect_needed();
    expect_head();
    doubt_unlikely();
    return std::move(parameters_);
  }

 private:
  static const std::vector<std::string>& sections() {
    static const std::vector<std::string> all(kAriaSections.begin(), kAriaSections.end());
    return all;
  }
  static std::string section_of(const Line& line) {
    return joined(std::span(line.words).subspan(1), " ",
                  [](const Word& word) { return lowered(word.text); });
  }

  // ARIA's files have sections, keywords and columns beyond ours, and comments that are broken over
  // two lines. An acceleration of 0 there means the robot's own.
  bool is_passed_over(const Line& line) {
    const std::string name = lowered(line.words[0].text);
    if (name == "configversion")
      aria_ = true;
    if (name == "section") {
      aria_ = true;
      const std::string section = section_of(line);
      aria_section_ = std::find(sections().begin(), sections().end(), section) != sections().end();
      if (aria_section_)
        read_sections_.insert(section);
      else if (!section.empty())
        unread_sections_.push_back(&line);
    }
    if (!aria_)
      return false;
    const bool is_own = (name.ends_with("accel") || name.ends_with("decel")) &&
                        line.words.size() > 1 && line.words[1].text == "0";
    return !aria_section_ || is_own || !is_keyword(name);
  }

  void keyword(LineReader& in) {
    const std::string name = lowered(in.word("a keyword"));
    if (name == "sonarunit") {
      sonar_unit(in);
      return;
    }
    const int line = lines_[next_ - 1].number;
    if (const auto [seen, is_new] = seen_.emplace(name, line); !is_new)
      in.fail("expected each keyword once; it stands on line " + std::to_string(seen->second) +
              " already");
    for (const NumberKeyword& k : kNumbers) {
      if (lowered(k.name) != name)
        continue;
      to_value(in);
      const std::string what =
          std::string(k.name) + (k.means.empty() ? "" : " ") + std::string(k.means);
      parameters_.*k.field = in.number(what, k.low, k.high) * k.unit;
      return;
    }
    for (const FlagKeyword& k : kFlags) {
      if (lowered(k.name) != name)
        continue;
      parameters_.*k.field = flag(in, k.name);
      return;
    }
    for (const CountKeyword& k : kCounts) {
      if (lowered(k.name) != name)
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
      in.fail("expected a keyword of a robot parameter file" +
              did_you_mean(name, keywords(), " (such as RobotRadius or SonarUnit)"));
    }
  }

  static bool flag(LineReader& in, std::string_view name) {
    const std::string value = lowered(in.word("true or false behind " + std::string(name)));
    if (value != "true" && value != "false")
      in.fail("expected true or false");
    return value == "true";
  }

  void protocol(LineReader& in) {
    const std::string value = lowered(in.word("psos, p2os or arcos"));
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
    if (std::ranges::find(rates, rate) == rates.end())
      in.fail("expected 0 (never), 9600, 19200, 38400, 57600 or 115200");
    parameters_.switch_to_baud = static_cast<int>(rate);
  }

  // ARIA's files do not give the protocol; the servers' version names do.
  Protocol protocol_of_subclass() const {
    const std::string name = lowered(parameters_.subclass);
    if ((name + "-").find("-sh-") != std::string::npos)
      return Protocol::kArcos;
    return is_of_the_first(name) ? Protocol::kPsos : Protocol::kP2os;
  }

  // Missing parameters follow from the generation of the server.
  void finish_protocol() {
    if (aria_ && !seen_.contains("protocol")) {
      parameters_.protocol = protocol_of_subclass();
      parameters_.protocol_is_assumed = parameters_.protocol == Protocol::kP2os;
    }
    const bool later = parameters_.protocol != Protocol::kPsos;
    for (const auto& [name, field] : {std::pair{"hasmovecommand", &P::move_command},
                                      std::pair{"settablevelmaxes", &P::settable_velocities},
                                      std::pair{"settableaccsdecs", &P::settable_accelerations}})
      if (!seen_.contains(name))
        parameters_.*field = later;
    finish_accelerations();
    if (parameters_.length == 0.0)
      parameters_.length = 2.0 * parameters_.radius;
    if (parameters_.width == 0.0)
      parameters_.width = 2.0 * parameters_.radius;
  }

  // The limits are those of the servers since P2OS. The decelerations stop a robot of that size
  // softly enough for its load.
  void finish_accelerations() {
    P& p = parameters_;
    if (!p.settable_accelerations) {
      p.max_acceleration = std::max(p.acceleration, p.deceleration);
      p.max_rotation_acceleration = std::max(p.rotation_acceleration, p.rotation_deceleration);
      p.stop_deceleration = p.stop_rotation_deceleration = 0.0;
      return;
    }
    const auto usual = [&](std::string_view keyword, double P::*field, double value) {
      if (!seen_.contains(std::string(keyword)))
        p.*field = value;
    };
    usual("maxacceleration", &P::max_acceleration, 2.0);
    usual("maxrotacceleration", &P::max_rotation_acceleration, kMaxRotAcceleration);
    usual("stopdeceleration", &P::stop_deceleration, 0.6);
    usual("stoprotdeceleration", &P::stop_rotation_deceleration, kStopRotDeceleration);
    p.stop_deceleration = std::min(p.stop_deceleration, p.max_acceleration);
    p.stop_rotation_deceleration =
        std::min(p.stop_rotation_deceleration, p.max_rotation_acceleration);
  }

  // Steps to the next line where the value stands there.
  void to_value(LineReader& in) {
    if (in.at_end() && next_ < lines_.size() && begins_number(lines_[next_].words[0].text))
      in = LineReader(parameters_.file, lines_[next_++]);
  }

  void sonar_unit(LineReader& in) {
    const long number = in.integer("sonar number", 0, kMaxSonars - 1);
    const auto is_same = [number](const SonarUnit& unit) { return unit.number == number; };
    if (std::ranges::any_of(parameters_.sonars, is_same))
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
    if (!sonar_count_)
      return;
    std::ranges::sort(sonars,
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
                           std::to_string(i) + " is missing (has the file been cut off?)");
  }

  void expect_needed() const {
    std::string missing;
    for (const NeededKeyword& k : kNeeded)
      if (!seen_.contains(lowered(k.name)) && (seen_.contains("class") || !k.with_class_only))
        missing += (missing.empty() ? "" : ", ") + std::string(k.name);
    if (missing.empty())
      return;
    for (const Line* const line : unread_sections_) {
      const std::string near = guess(section_of(*line), sections());
      if (near.empty() || near[0] != section_of(*line)[0] || read_sections_.contains(near))
        continue;
      std::string wrong = "expected a section of ARIA: did you mean ";
      wrong.append(near).append("? Its lines are not read; missing: ").append(missing);
      throw FileError(parameters_.file, line->number, line->words[1].column, wrong, line->text);
    }
    const std::string message =
        "expected also " + missing + ": no robot can do without (has the file been cut off?)";
    if (lines_.empty())
      throw FileError(parameters_.file, 1, 1, message);
    const Word& last = lines_.back().words.back();
    throw FileError(parameters_.file, lines_.back().number,
                    last.column + static_cast<int>(last.text.size()), message, lines_.back().text);
  }

  /// Warns of values that are in no range of their own, and do not fit each other.
  void doubt_unlikely() {
    P& p = parameters_;
    const auto doubt = [&](const std::string& keyword, const std::string& words) {
      const auto line = seen_.find(lowered(keyword));
      p.warnings.push_back(p.file + ":" +
                           (line == seen_.end() ? "" : std::to_string(line->second) + ":") + " " +
                           keyword + words);
    };
    if (p.radius < 0.45 * p.width)
      doubt("RobotRadius", format(" of %.0f mm is less than half of RobotWidth, %.0f mm: the robot "
                                  "would touch things that it passes",
                                  p.radius / kMillimetre, p.width / kMillimetre));
    // VEL2 has a signed byte for each wheel.
    if (127.0 * p.vel2_unit < 0.2 * p.max_velocity)
      doubt("Vel2Divisor", format(" of %g mm/s gives wheels %.0f mm/s at the most, where "
                                  "MaxVelocity is %.0f mm/s: is it 20?",
                                  p.vel2_unit / kMillimetre, 127.0 * p.vel2_unit / kMillimetre,
                                  p.max_velocity / kMillimetre));
    double farthest = 0.0;  // [m]
    for (const SonarUnit& unit : p.sonars)
      farthest = std::max(farthest, unit.pose_in_robot.position().norm());
    if (farthest > 0.0 && farthest < 2.0 * kMillimetre)
      p.warnings.push_back(p.file + ":" + std::to_string(unit_lines_.begin()->second) +
                           ": SonarUnit: all sonars are within 2 mm of the robot's middle; their "
                           "places are in mm and their bearings in degrees");
  }

  void expect_head() const {
    const P& p = parameters_;
    if (p.head_reach == 0.0)
      return;
    const double way = p.head_reach * std::abs(p.head_pulse);
    std::string message;
    if (p.protocol != Protocol::kPsos)
      message =
          "expected no HeadReach: the packets of a later robot than psos do not show its servo";
    else if (way < 1.0 || p.head_center - way < kShortestPulse ||
             p.head_center + way > kLongestPulse)
      message = "expected pulses of " + std::to_string(kShortestPulse) + " to " +
                std::to_string(kLongestPulse) + " us, found HeadReach times HeadPulse around " +
                "HeadCenter to be " + std::to_string(std::lround(p.head_center - way)) + " to " +
                std::to_string(std::lround(p.head_center + way));
    if (message.empty())
      return;
    const int number = seen_.at("headreach");
    const auto line = std::ranges::find(lines_, number, &Line::number);
    throw FileError(p.file, number, line->words[0].column, message, line->text);
  }

  std::vector<Line> lines_;
  std::size_t next_ = 0;
  bool aria_ = false;          // the form of ARIA's files, with sections
  bool aria_section_ = false;  // a section that is read
  std::set<std::string> read_sections_;
  std::vector<const Line*> unread_sections_;
  RobotParameters parameters_;
  std::map<std::string, int> seen_;        // keyword, line
  std::map<int, int> unit_lines_;          // sonar, line
  std::optional<LineReader> sonar_count_;  // the line for an error about the number of units
  long sonar_count_number_ = 0;
};

}  // namespace

std::uint16_t pulse_of_head(const RobotParameters& p, double angle) {
  const double rounding = 1e-6;  // [rad]
  if (p.head_reach == 0.0 || !(std::abs(angle) <= p.head_reach + rounding))
    return 0;
  return static_cast<std::uint16_t>(std::lround(p.head_center + angle * p.head_pulse));
}

double angle_of_head(const RobotParameters& p, std::uint16_t pulse) {
  return p.head_reach == 0.0 || pulse == 0 ? 0.0 : (pulse - p.head_center) / p.head_pulse;
}

RobotParameters parse_parameters(std::string_view text, const std::string& file) {
  return Parser(text, file).parse();
}

RobotParameters load_parameters(const std::string& path) {
  return parse_parameters(read_file(path), path);
}

bool RobotParameters::is_of(std::string_view of_class, std::string_view of_subclass) const {
  return lowered(of_class) == lowered(robot_class) && lowered(of_subclass) == lowered(subclass);
}

std::vector<std::string> parameter_file_names(std::string_view robot_class,
                                              std::string_view subclass) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    const bool plain = !name.empty() && name[0] != '.' && std::ranges::all_of(name, [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '+' ||
             c == '.';
    });
    if (plain && std::ranges::find(names, name + ".p") == names.end())
      names.push_back(name + ".p");
  };
  const std::string of_class = lowered(robot_class);
  const std::string whole = lowered(subclass);
  std::string name = whole;
  add(name);
  // The part behind a hyphen is a variant: p3dx-sh-lms1xx is a p3dx-sh with a laser.
  // Without -sh it is another generation.
  for (std::size_t hyphen = name.rfind('-');
       hyphen != std::string::npos && name.substr(hyphen) != "-sh"; hyphen = name.rfind('-')) {
    name.resize(hyphen);
    if (name != of_class && name != "pioneer")
      add(name);
  }
  // The file of the class Pioneer is one of the manual's time, with its units.
  if (of_class != "pioneer" || is_of_the_first(whole) || whole.empty())
    add(of_class);
  return names;
}

std::optional<std::string> find_parameter_file(const std::string& folder,
                                               std::string_view robot_class,
                                               std::string_view subclass) {
  namespace fs = std::filesystem;
  for (const std::string& name : parameter_file_names(robot_class, subclass)) {
    const fs::path path = fs::path(folder) / name;
    // A variant of amigo may as well be of the later generation amigo-sh, whose units differ.
    const bool ambiguous =
        path.stem() != lowered(subclass) && fs::exists(fs::path(folder) / later_name(path.stem()));
    if (fs::exists(path) && !ambiguous)
      return path.string();
  }
  return std::nullopt;
}

RobotParameters parameters_of(const RobotIdentity& robot, const std::string& folder,
                              const std::string& file) {
  std::string other;
  if (!file.empty()) {
    RobotParameters given = load_parameters(file);
    if (given.is_of(robot.robot_class, robot.subclass))
      return given;
    other = file + " is for a robot (" + given.robot_class + ", " + given.subclass +
            ") and not for this one";
  }
  const auto path = find_parameter_file(folder, robot.robot_class, robot.subclass);
  if (!path) {
    const std::string names = joined(parameter_file_names(robot.robot_class, robot.subclass));
    for (const std::string& name : parameter_file_names(robot.robot_class, robot.subclass))
      if (std::filesystem::exists(std::filesystem::path(folder) / name))
        throw std::runtime_error(
            name_of(robot) +
            format(
                " may be of either generation, whose units differ: %s/%s or %s%s%s. Copy the right "
                "one there as %s.p",
                folder.c_str(), name.c_str(), later_name(name.substr(0, name.size() - 2)).c_str(),
                other.empty() ? "" : "; ", other.c_str(), lowered(robot.subclass).c_str()));
    throw std::runtime_error("no parameter file for " + name_of(robot) + ": looked for " +
                             (names.empty() ? "nothing (the robot names no class)" : names) +
                             " in " + folder + (other.empty() ? "" : "; " + other) +
                             ". Copy the file of the most similar robot there, under its subclass");
  }
  RobotParameters found = load_parameters(*path);
  if (!other.empty())
    found.warnings.push_back(other + ": takes " + *path);
  else if (!found.is_of(robot.robot_class, robot.subclass))
    found.warnings.push_back(name_of(robot) + " has no parameter file of its own: takes " + *path);
  return found;
}

}  // namespace saphira::protocol
