#include "carmen.hpp"

#include <zlib.h>

#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "saphira/base/text.hpp"

namespace saphira::bench {

namespace {

struct Row {
  std::string_view text;
  int number = 1;
};

std::vector<Row> rows_of(std::string_view text) {
  std::vector<Row> rows;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    std::string_view row = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (!row.empty() && row.back() == '\r')
      row.remove_suffix(1);
    rows.push_back({row, number});
  }
  return rows;
}

class Words {
 public:
  Words(const Row& row, const std::string& file) : row_(row), file_(file) {}

  std::string_view word(const char* expected) {
    const std::size_t from = row_.text.find_first_not_of(" \t", at_);
    if (from == std::string_view::npos) {
      begin_ = row_.text.size();
      fail(expected);
    }
    begin_ = from;
    at_ = std::min(row_.text.find_first_of(" \t", from), row_.text.size());
    return row_.text.substr(from, at_ - from);
  }
  bool at_end() const { return row_.text.find_first_not_of(" \t", at_) == std::string_view::npos; }
  double number(const char* expected) {
    const std::string_view text = word(expected);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
      fail(expected);
    return value;
  }
  // A range may be written nan or inf where there was no return.
  double range() {
    const std::string_view text = word("a range");
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range)
      return 1e9;
    if (error != std::errc{} || end != text.data() + text.size())
      fail("a range");
    return std::isfinite(value) ? value : 1e9;
  }
  std::size_t count(const char* expected) {
    const double value = number(expected);
    if (!(value >= 0.0 && value <= 10000.0 && value == std::floor(value)))
      fail(expected);
    return static_cast<std::size_t>(value);
  }
  Pose pose() {
    const double x = number("x of a pose");
    const double y = number("y of a pose");
    return {x, y, norm2_angle(number("the heading of a pose"))};
  }
  [[noreturn]] void fail(const std::string& expected) const {
    std::string text = "expected " + expected;
    if (begin_ < row_.text.size())
      text += ", found \"" + std::string(row_.text.substr(begin_, 20)) + "\"";
    // A scan's line is too long to be shown.
    throw FileError(file_, row_.number, static_cast<int>(begin_) + 1, text,
                    row_.text.size() < 120 ? row_.text : std::string_view{});
  }

 private:
  const Row& row_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t begin_ = 0;
};

// The laser's place on the robot, from both poses. In corrected logs both are of one or the other.
Pose mounted(const Pose& laser, const Pose& robot) {
  const Pose in_robot = relative(robot, laser);
  return std::hypot(in_robot.x, in_robot.y) < 1.5 ? in_robot : Pose{};
}

LaserScan flaser(Words& words) {
  LaserScan scan;
  scan.ranges.resize(words.count("the number of beams"));
  for (double& range : scan.ranges)
    range = words.range();
  const std::size_t n = scan.ranges.size();
  // As CARMEN configures a SICK by the number of its beams; 180 and 360 are 181 and 361 without
  // the last. Any other number is taken to span 180 degrees.
  if (n == 401) {
    scan.first_angle = radians(-50.0);
    scan.step = radians(0.25);
  } else if (n == 360 || n == 361) {
    scan.step = radians(0.5);
  } else if (n != 180 && n != 181 && n > 1) {
    scan.step = kPi / static_cast<double>(n - 1);
  }
  const Pose laser = words.pose();
  scan.pose = words.pose();
  scan.laser_in_robot = mounted(laser, scan.pose);
  scan.time.ipc = words.number("a stamp");
  scan.host = words.word("a host");
  scan.time.logger = words.number("the logger's stamp");
  return scan;
}

LaserScan robot_laser(Words& words) {
  LaserScan scan;
  words.number("the laser's type");
  scan.first_angle = words.number("the first angle");
  words.number("the field of view");
  scan.step = words.number("the angular resolution");
  const double longest = words.number("the longest range");
  if (longest > 1.0)
    scan.no_return = longest - 0.01;
  words.number("the accuracy");
  words.number("the remission mode");
  scan.ranges.resize(words.count("the number of beams"));
  for (double& range : scan.ranges)
    range = words.range();
  const std::size_t remissions = words.count("the number of remissions");
  for (std::size_t i = 0; i < remissions; ++i)
    words.number("a remission");
  const Pose laser = words.pose();
  scan.pose = words.pose();
  scan.laser_in_robot = mounted(laser, scan.pose);
  for (int i = 0; i < 5; ++i)  // velocities, safety distances, the turn's axis
    words.number("a number");
  scan.time.ipc = words.number("a stamp");
  scan.host = words.word("a host");
  scan.time.logger = words.number("the logger's stamp");
  return scan;
}

}  // namespace

CarmenLog parse_carmen(std::string_view text, const std::string& file) {
  CarmenLog log;
  log.file = file;
  for (const Row& row : rows_of(text)) {
    try {
      Words words(row, file);
      if (row.text.starts_with("FLASER ")) {
        words.word("FLASER");
        log.scans.push_back(flaser(words));
      } else if (row.text.starts_with("ROBOTLASER1 ")) {
        words.word("ROBOTLASER1");
        log.scans.push_back(robot_laser(words));
      } else if (row.text.starts_with("ODOM ")) {
        words.word("ODOM");
        OdomRecord record;
        record.pose = words.pose();
        for (int i = 0; i < 3; ++i)  // velocities and acceleration
          words.number("a velocity");
        record.time.ipc = words.number("a stamp");
        words.word("a host");
        record.time.logger = words.number("the logger's stamp");
        record.scans_before = log.scans.size();
        log.odometry.push_back(record);
      }
    } catch (const FileError& error) {
      log.damaged.emplace_back(error.what());
    }
  }
  if (log.scans.empty()) {
    if (!log.damaged.empty())
      throw std::runtime_error(log.damaged.front());
    throw FileError(file, 1, 1, "expected a line FLASER or ROBOTLASER1");
  }
  return log;
}

std::vector<Relation> parse_relations(std::string_view text, const std::string& file) {
  std::vector<Relation> out;
  for (const Row& row : rows_of(text)) {
    Words words(row, file);
    if (row.text.starts_with("#") || words.at_end())
      continue;
    Relation relation;
    relation.from = words.number("a stamp");
    relation.to = words.number("a stamp");
    relation.to_in_from.x = words.number("dx");
    relation.to_in_from.y = words.number("dy");
    for (const char* ignored : {"dz", "roll", "pitch"})
      words.number(ignored);
    relation.to_in_from.th = norm2_angle(words.number("yaw"));
    out.push_back(relation);
  }
  return out;
}

std::string read_log(const std::string& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file)
    throw std::runtime_error(path + ": cannot be opened");
  std::string out;
  std::array<char, 1 << 16> part{};
  for (;;) {
    const int got = gzread(file.get(), part.data(), part.size());
    if (got < 0)
      throw std::runtime_error(path + ": cannot be unpacked");
    if (got == 0)
      return out;
    out.append(part.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace saphira::bench
