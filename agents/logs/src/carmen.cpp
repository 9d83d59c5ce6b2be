#include "saphira/logs/carmen.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

#include "saphira/base/format.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"

namespace saphira::logs {

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
  /// The number of words left, and the second last one; empty without it.
  std::pair<std::size_t, std::string_view> rest() const {
    std::size_t count = 0;
    std::string_view last;
    std::string_view before_last;
    for (std::size_t at = at_; (at = row_.text.find_first_not_of(" \t", at)) != row_.text.npos;) {
      const std::size_t end = std::min(row_.text.find_first_of(" \t", at), row_.text.size());
      before_last = std::exchange(last, row_.text.substr(at, end - at));
      ++count;
      at = end;
    }
    return {count, before_last};
  }
  bool at_end() const { return row_.text.find_first_not_of(" \t", at_) == std::string_view::npos; }
  double number(const char* expected) {
    const auto value = number_in<double>(word(expected));
    if (!value || !std::isfinite(*value))
      fail(expected);
    return *value;
  }
  // A range without a return may be written as nan or inf.
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
  // A stamp, if any; logs of before CARMEN 0.5 have none.
  double stamp(double otherwise) { return at_end() ? otherwise : number("a stamp"); }
  Pose pose() {
    const double x = number("x of a pose");
    const double y = number("y of a pose");
    return {x, y, norm2_angle(number("the heading of a pose"))};
  }
  [[noreturn]] void fail(const std::string& expected) const {
    std::string text = "expected " + expected;
    if (begin_ < row_.text.size())
      text += ", found \"" + std::string(row_.text.substr(begin_, 20)) + "\"";
    // A scan's line is too long for a message.
    throw FileError(file_, row_.number, static_cast<int>(begin_) + 1, text,
                    row_.text.size() < 120 ? row_.text : std::string_view{});
  }

 private:
  const Row& row_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t begin_ = 0;
};

// [degrees] fields of view of usual lasers: a SICK LMS either way, Hokuyos, a rotating one.
constexpr double kFields[] = {100.0, 180.0, 240.0, 270.0, 360.0};

// Sets the beams of a laser by their number, if the log does not give them: as CARMEN and others
// configure a SICK LMS, a SICK LMS 1xx or Hokuyo UTM, a Hokuyo URG. An even number is the odd one
// without the last beam. Any other number spans 180 degrees. A usual laser overrides a `resolution`
// or `field` of view [degrees; 0: not given] of the log that gives an unusual field of view.
// Returns the words where header and number of beams leave a doubt.
std::string lay_beams(LaserScan& scan, double resolution, double field) {
  const std::size_t n = scan.ranges.size();
  const auto spans = [&](double first, double step) {
    scan.first_angle = radians(first);
    scan.step = radians(step);
  };
  const auto beams = static_cast<double>(n);
  const double steps = beams - static_cast<double>(n % 2);
  const double each = resolution > 0.0 || n < 2 ? resolution : field / steps;
  const double all = each * steps;
  bool usual = true;
  if (n == 401)
    spans(-50.0, 0.25);
  else if (n == 90 || n == 91)
    spans(-90.0, 2.0);
  else if (n == 180 || n == 181)
    spans(-90.0, 1.0);
  else if (n == 360 || n == 361)
    spans(-90.0, 0.5);
  else if (n == 720 || n == 721)
    spans(-90.0, 0.25);
  else if (n == 270 || n == 271)
    spans(-135.0, 1.0);
  else if (n == 540 || n == 541)
    spans(-135.0, 0.5);
  else if (n == 1080 || n == 1081)
    spans(-135.0, 0.25);
  else if (n == 512 || n == 682 || n == 683 || n == 726 || n == 769)
    spans(-0.5 * 360.0 / 1024.0 * (beams - 1.0), 360.0 / 1024.0);
  else {
    usual = false;
    if (n > 1)
      spans(-90.0, 180.0 / (beams - 1.0));
  }
  if (each <= 0.0 || n < 2)
    return {};
  const double step = degrees(scan.step);
  const auto spans_field = [&](double other) { return std::abs(all - other) < 0.02 * other; };
  const bool spans_usual = std::any_of(std::begin(kFields), std::end(kFields), spans_field);
  const bool as_usual = std::abs(each - step) < 1e-4;
  const bool both = resolution > 0.0 && field > 0.0;
  const bool agree = both && spans_field(field);
  const bool said = agree || (usual ? as_usual || spans_usual : all > 30.0 && all <= 360.0);
  if (said)
    spans(-0.5 * all, each);
  if (agree || (said && !both && (as_usual || (!usual && spans_usual && n % 2 == 1))))
    return {};
  std::string header;
  if (resolution > 0.0)
    header = format("laser_front_laser_resolution %g", resolution);
  if (field > 0.0)
    header += format("%slaser_front_laser_fov %g", header.empty() ? "" : " and ", field);
  return header +
         format(said ? " may not fit %zu beams, which usual lasers have %g degrees apart: taken as "
                       "%g degrees apart, over %.0f degrees"
                     : " does not fit %zu beams, which usual lasers have %g degrees apart: taken "
                       "as that, %g degrees apart, over %.0f degrees",
                n, step, degrees(scan.step), degrees(scan.step) * steps);
}

// The step between the beams where the header contradicts itself: its field of view and the number
// of beams give it, unless the first angle fits the step. Returns the words; empty: all fits.
std::string mend_step(LaserScan& scan, double field) {
  const auto beams = static_cast<double>(scan.ranges.size());
  if (beams < 2.0)
    return {};
  const double given = scan.step;
  const double by_field = std::copysign(field / (beams - 1.0), given);
  if (given == 0.0)
    scan.step = field / (beams - 1.0);
  // The last beam may be left out.
  const auto fits = [&](double step, double all) {
    return std::abs(step) * beams > 0.98 * all && std::abs(step) * (beams - 1.0) < 1.02 * all;
  };
  if (given == 0.0 || field <= 0.0 || fits(given, field))
    return {};
  if (!fits(given, 2.0 * std::abs(scan.first_angle)))
    scan.step = fits(radians(given), field) ? radians(given) : by_field;
  return format(
      "the header's field of view of %g rad does not fit %zu beams %g rad apart: taken as %g "
      "degrees apart, over %.0f degrees",
      field, scan.ranges.size(), given, degrees(scan.step),
      std::abs(degrees(scan.step)) * (beams - 1.0));
}

// Takes a header in degrees as such: its angles fit each other, and are more than a whole turn.
// Returns the words; empty: it is in radians.
std::string mend_unit(LaserScan& scan, double& field) {
  constexpr double kMost = 1.02 * 2.0 * kPi;
  const double all = std::abs(scan.step) * (static_cast<double>(scan.ranges.size()) - 1.0);
  if (!(field > kMost) || !(all > kMost))
    return {};
  std::string words = format(
      "the header's field of view of %g rad is more than a whole turn: its angles are taken as "
      "degrees",
      field);
  for (double* angle : {&scan.first_angle, &scan.step, &field})
    *angle = radians(*angle);
  return words;
}

// Stamp, host, and the logger's stamp, as far as present.
Stamps stamps(Words& words) {
  Stamps time;
  time.ipc = time.logger = words.stamp(std::nan(""));
  if (words.at_end())
    return time;
  words.word("a host");
  time.logger = words.stamp(time.ipc);
  return time;
}

struct Parameters {
  double resolution = 0.0;  // [degrees]
  double field = 0.0;       // [degrees]
  std::optional<Pose> front;
  double longest = 0.0;
  // Where header and number of beams do not fit each other: the words, by the first such scan.
  std::map<Laser, std::string> doubts;

  void doubt(Laser laser, std::string words) {
    if (!words.empty())
      doubts.emplace(laser, std::move(words));
  }
};

void ranges_of(Words& words, LaserScan& scan) {
  scan.ranges.resize(words.count("the number of beams"));
  for (double& range : scan.ranges)
    range = words.range();
}

// The laser's pose is stored as its place until all are known.
LaserScan old_laser(Words& words, Laser laser, Parameters& parameters) {
  LaserScan scan;
  scan.laser = laser;
  ranges_of(words, scan);
  const bool front = laser == Laser::flaser;
  parameters.doubt(
      laser, lay_beams(scan, front ? parameters.resolution : 0.0, front ? parameters.field : 0.0));
  const Pose in_log = words.pose();
  scan.pose = words.pose();
  scan.laser_in_robot = relative(scan.pose, in_log);
  scan.no_return = 0.0;
  scan.time = stamps(words);
  return scan;
}

LaserScan new_laser(Words& words, Laser laser, bool with_robot, Parameters& parameters) {
  LaserScan scan;
  scan.laser = laser;
  words.number("the laser's type");
  scan.first_angle = words.number("the first angle");
  double field = words.number("the field of view");
  scan.step = words.number("the angular resolution");
  const double longest = words.number("the longest range");
  scan.no_return = longest > 1.0 ? longest - 0.01 : 0.0;
  words.number("the accuracy");
  words.number("the remission mode");
  ranges_of(words, scan);
  parameters.doubt(laser, mend_unit(scan, field));
  parameters.doubt(laser, mend_step(scan, field));
  // CARMEN's documents have no remissions there, its programs do. Then come two poses and five
  // numbers, a stamp, a name and a stamp.
  const auto [left, host] = words.rest();
  const bool named = !host.empty() && host.find_first_not_of("0123456789+-.eE") != host.npos;
  if (const std::size_t plain = with_robot ? 14 : 3; left != plain || !named) {
    const std::size_t remissions = words.count("the number of remissions");
    for (std::size_t i = 0; i < remissions; ++i)
      words.word("a remission");
  }
  if (with_robot) {
    const Pose in_log = words.pose();
    scan.pose = words.pose();
    scan.laser_in_robot = relative(scan.pose, in_log);
    for (int i = 0; i < 5; ++i)  // velocities, safety distances, the turn's axis
      words.number("a number");
  }
  scan.time = stamps(words);
  return scan;
}

struct Message {
  const char* name;
  Laser laser;
};
// The first one in a log is read: by place, and for one place the message with poses.
constexpr Message kLasers[] = {
    {"FLASER", Laser::flaser},  {"ROBOTLASER1", Laser::robot1}, {"RAWLASER1", Laser::raw1},
    {"RLASER", Laser::rlaser},  {"ROBOTLASER2", Laser::robot2}, {"RAWLASER2", Laser::raw2},
    {"LASER3", Laser::laser3},  {"LASER4", Laser::laser4},      {"RAWLASER3", Laser::raw3},
    {"RAWLASER4", Laser::raw4},
};

bool has_no_pose(Laser laser) {
  return laser == Laser::raw1 || laser == Laser::raw2 || laser == Laser::raw3 ||
         laser == Laser::raw4;
}

/// The middle one in size; there is one.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// One place for all scans. In some corrected logs only one of the two poses is corrected: then they
// do not give the laser's place.
void mount(CarmenLog& log, const Parameters& parameters) {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> th;
  for (const LaserScan& scan : log.scans) {
    x.push_back(scan.laser_in_robot.x);
    y.push_back(scan.laser_in_robot.y);
    th.push_back(norm2_angle(scan.laser_in_robot.th - log.scans.front().laser_in_robot.th));
  }
  Pose place{median(x), median(y), norm2_angle(median(th) + log.scans.front().laser_in_robot.th)};
  std::size_t same = 0;
  for (const LaserScan& scan : log.scans) {
    const Pose off = relative(place, scan.laser_in_robot);
    same += std::hypot(off.x, off.y) < 0.02 && std::abs(off.th) < 0.02 ? 1U : 0U;
  }
  const bool said = same > log.scans.size() * 9 / 10 && std::hypot(place.x, place.y) < 1.5;
  const bool moved = std::hypot(place.x, place.y) > 1e-3 || std::abs(place.th) > 1e-3;
  if (!said || !moved) {
    const Laser laser = log.scans.front().laser;
    const bool front = laser == Laser::flaser || laser == Laser::robot1 || laser == Laser::raw1;
    const bool rear = laser == Laser::rlaser || laser == Laser::robot2 || laser == Laser::raw2;
    place = front && parameters.front ? *parameters.front : Pose{0.0, 0.0, rear ? kPi : 0.0};
  }
  for (LaserScan& scan : log.scans)
    scan.laser_in_robot = place;
}

// Removes the scans that are not kept; dead reckoning keeps its order with the others.
void keep_scans(CarmenLog& log, const std::vector<char>& kept) {
  std::vector<std::size_t> kept_before{0};
  std::vector<LaserScan> scans;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    if (kept[i] != 0)
      scans.push_back(std::move(log.scans[i]));
    kept_before.push_back(scans.size());
  }
  for (OdomRecord& record : log.odometry)
    record.scans_before = kept_before.at(record.scans_before);
  log.scans = std::move(scans);
}

// Scans without a pose get that of dead reckoning at their stamp.
void place_raw(CarmenLog& log) {
  std::vector<OdomRecord> records = log.odometry;
  std::stable_sort(records.begin(), records.end(), [](const OdomRecord& a, const OdomRecord& b) {
    return a.time.ipc < b.time.ipc;
  });
  std::vector<char> placed(log.scans.size(), 0);
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    LaserScan& scan = log.scans[i];
    const auto after =
        std::lower_bound(records.begin(), records.end(), scan.time.ipc,
                         [](const OdomRecord& r, double time) { return r.time.ipc < time; });
    if (after == records.end() || after == records.begin())
      continue;
    const auto before = after - 1;
    const double gap = after->time.ipc - before->time.ipc;
    if (!(gap < 2.0))
      continue;
    const double share = (scan.time.ipc - before->time.ipc) / gap;
    const Pose step = relative(before->pose, after->pose);
    scan.pose = compose(before->pose, {share * step.x, share * step.y, share * step.th});
    placed[i] = 1;
  }
  if (const auto lost = std::count(placed.begin(), placed.end(), 0); lost > 0)
    log.notes.push_back(std::to_string(lost) + " scans have no dead reckoning at their time");
  keep_scans(log, placed);
}

// Gives every message a stamp, by the order in the file if the log has none. Single messages
// without a stamp, such as the last line of a truncated log, are left out.
void stamp_all(CarmenLog& log) {
  const auto unstamped = [](const auto& m) {
    return !std::isfinite(m.time.ipc) || !std::isfinite(m.time.logger);
  };
  const auto without = std::count_if(log.scans.begin(), log.scans.end(), unstamped);
  if (without < std::ssize(log.scans)) {
    std::vector<char> kept;
    for (const LaserScan& scan : log.scans)
      kept.push_back(unstamped(scan) ? 0 : 1);
    keep_scans(log, kept);
    const auto erased = std::erase_if(log.odometry, unstamped);
    if (without > 0 || erased > 0)
      log.notes.push_back(std::to_string(without) + " scans and " + std::to_string(erased) +
                          " lines ODOM without a stamp are left out");
    return;
  }
  log.notes.emplace_back("no stamps: by their order, a scan every 0.1 s");
  for (std::size_t i = 0; i < log.scans.size(); ++i)
    log.scans[i].time.ipc = log.scans[i].time.logger = 0.1 * static_cast<double>(i);
  std::size_t same = 0;
  for (std::size_t k = 0; k < log.odometry.size(); ++k) {
    OdomRecord& record = log.odometry[k];
    same = k > 0 && log.odometry[k - 1].scans_before == record.scans_before ? same + 1 : 0;
    record.time.ipc = record.time.logger = 0.1 * (static_cast<double>(record.scans_before) - 1.0) +
                                           0.1 * (1.0 - 1.0 / static_cast<double>(same + 2));
  }
}

}  // namespace

std::optional<double> find_no_return(const std::vector<LaserScan>& scans) {
  constexpr double kBin = 0.02;  // [m]
  constexpr std::size_t kBins = 10000;
  constexpr std::size_t kSectors = 32;
  struct Bin {
    double count = 0.0;
    std::uint32_t sectors = 0;  // of the field of view, a bit each
  };
  std::vector<Bin> bins(kBins);
  double all = 0.0;
  for (const LaserScan& scan : scans)
    for (std::size_t i = 0; i < scan.ranges.size(); ++i)
      if (scan.ranges[i] > 0.0) {
        Bin& bin = bins[std::min(kBins - 1,
                                 static_cast<std::size_t>(std::min(scan.ranges[i], 1e6) / kBin))];
        bin.count += 1.0;
        bin.sectors |= 1U << (i * kSectors / scan.ranges.size());
        all += 1.0;
      }
  // From the longest down. Ranges that mean no return have three signs: almost none are longer;
  // they are many times as frequent as those in a bin of the metre before; and they are in all
  // directions, unlike a wall before a standing robot.
  constexpr double kBeyond = 0.002;
  constexpr double kPile = 0.001;
  constexpr double kTimes = 20.0;
  constexpr std::size_t kBefore = 50;
  constexpr int kDirections = 6;
  constexpr double kCodes = 0.3;  // [m] distance between neighbouring codes
  std::optional<double> found;
  double beyond = 0.0;
  for (std::size_t bin = kBins; bin-- > 1 && beyond <= kBeyond * all;) {
    const double range = kBin * static_cast<double>(bin) - 0.01;
    if (found && range < *found - kCodes)
      break;
    double before = 0.0;
    const std::size_t near = bin > 10 ? bin - 10 : 0;
    for (std::size_t k = near > kBefore ? near - kBefore : 0; k < near; ++k)
      before += bins[k].count / static_cast<double>(kBefore);
    if (bins[bin].count > std::max(4.0, kPile * all) && bins[bin].count > kTimes * before &&
        std::popcount(bins[bin].sectors) >= kDirections)
      found = range;
    else
      beyond += bins[bin].count;
  }
  return found;
}

CarmenLog parse_carmen(std::string_view text, const std::string& file) {
  expect_own_format(text, file, "a log of CARMEN (FLASER, ROBOTLASER1 or RAWLASER1 lines)");
  CarmenLog log;
  log.file = file;
  Parameters parameters;
  std::map<Laser, std::vector<LaserScan>> scans;
  std::map<Laser, std::vector<std::size_t>> before;  // odometry records before each scan
  for (const Row& row : rows_of(text)) {
    try {
      Words words(row, file);
      if (words.at_end() || row.text.front() == '#')
        continue;
      const std::string_view name = words.word("a message");
      const auto* const laser = std::find_if(std::begin(kLasers), std::end(kLasers),
                                             [&](const Message& m) { return name == m.name; });
      if (laser != std::end(kLasers)) {
        const bool old =
            name.starts_with("FLASER") || name.starts_with("RLASER") || name.starts_with("LASER");
        LaserScan scan =
            old ? old_laser(words, laser->laser, parameters)
                : new_laser(words, laser->laser, name.starts_with("ROBOT"), parameters);
        scans[laser->laser].push_back(std::move(scan));
        before[laser->laser].push_back(log.odometry.size());
      } else if (name == "ODOM") {
        OdomRecord record;
        record.pose = words.pose();
        for (int i = 0; i < 3; ++i)  // velocities and acceleration; dead reckoning
          words.number("a velocity");
        record.time = stamps(words);
        log.odometry.push_back(record);
      } else if (name == "PARAM") {
        const std::string_view what = words.word("a parameter's name");
        if (what == "laser_front_laser_resolution") {
          parameters.resolution = words.number("degrees");
        } else if (what == "laser_front_laser_fov") {
          parameters.field = words.number("degrees");
        } else if (what.starts_with("robot_frontlaser_")) {
          Pose front = parameters.front.value_or(Pose{});
          if (what == "robot_frontlaser_offset")
            front.x = words.number("metres");
          else if (what == "robot_frontlaser_side_offset")
            front.y = words.number("metres");
          else if (what == "robot_frontlaser_angular_offset")
            front.th = words.number("radians");
          parameters.front = front;
        } else if (what == "robot_front_laser_max") {
          parameters.longest = words.number("metres");
        }
      }
    } catch (const FileError& error) {
      log.damaged.emplace_back(error.what());
    }
  }
  for (const Message& message : kLasers) {
    const auto found = scans.find(message.laser);
    if (found == scans.end())
      continue;
    if (has_no_pose(message.laser) && log.odometry.empty())
      continue;
    // The number of the kept laser's scans before each odometry record in the file.
    const std::vector<std::size_t>& odometry_before = before[message.laser];
    for (std::size_t k = 0, scan = 0; k < log.odometry.size(); ++k) {
      while (scan < odometry_before.size() && odometry_before[scan] <= k)
        ++scan;
      log.odometry[k].scans_before = scan;
    }
    log.scans = std::move(found->second);
    scans.erase(found);
    for (const auto& [other, left_out] : scans)
      for (const Message& m : kLasers)
        if (m.laser == other)
          log.notes.push_back(std::string(message.name) + " is read, " +
                              std::to_string(left_out.size()) + " " + m.name + " are not");
    stamp_all(log);
    if (has_no_pose(message.laser))
      place_raw(log);
    break;
  }
  if (log.scans.empty()) {
    if (!log.damaged.empty())
      throw UnusableFile(log.damaged.front());
    throw FileError(file, 1, 1,
                    scans.empty() ? "expected a line FLASER, ROBOTLASER1 or RAWLASER1"
                                  : "expected lines ODOM: scans without a pose need them");
  }
  if (const auto doubt = parameters.doubts.find(log.scans.front().laser);
      doubt != parameters.doubts.end())
    log.notes.push_back(doubt->second);
  mount(log, parameters);
  const std::optional<double> no_return = find_no_return(log.scans);
  for (LaserScan& scan : log.scans) {
    // The log's maximum range may be that of the laser's type, not the configured one.
    if (no_return)
      scan.no_return = scan.no_return > 0.0 ? std::min(scan.no_return, *no_return) : *no_return;
    else if (scan.no_return == 0.0)
      scan.no_return = parameters.longest > 1.0 ? parameters.longest - 0.01 : 1e8;
  }
  return log;
}

std::string read_log(const std::string& path, std::string* trouble) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file)
    throw UnusableFile(cannot_be(path, "opened"));
  std::string out;
  std::array<char, 1 << 16> part{};
  for (;;) {
    const int got = gzread(file.get(), part.data(), part.size());
    if (got > 0) {
      out.append(part.data(), static_cast<std::size_t>(got));
      continue;
    }
    // A truncated file is reported only on request.
    int error = Z_OK;
    const std::string why = gzerror(file.get(), &error);
    if (error == Z_OK || error == Z_STREAM_END)
      return out;
    if (out.empty())
      throw UnusableFile(path + ": cannot be unpacked");
    if (trouble != nullptr)
      *trouble = path + ": damaged or cut off after " + std::to_string(out.size()) + " bytes";
    // Whole lines only.
    out.resize(out.rfind('\n') == std::string::npos ? 0 : out.rfind('\n') + 1);
    return out;
  }
}

}  // namespace saphira::logs
