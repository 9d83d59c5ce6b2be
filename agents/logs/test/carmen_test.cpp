// Small handwritten logs, in the formats of CARMEN and others over the years.
#include "saphira/logs/carmen.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "process.hpp"
#include "saphira/base/random.hpp"
#include "saphira/base/text.hpp"
#include "saphira/logs/data_set.hpp"

namespace saphira::logs {
namespace {

using saphira::test::TempDir;

// Of a robot at (i / 10, 0) that is between two walls.
std::string flaser(const std::string& name, int beams, int i, double longest, const char* tail) {
  std::string line = name + " " + std::to_string(beams);
  for (int k = 0; k < beams; ++k) {
    const double at = -kPi / 2 + kPi * k / std::max(1, beams - 1);
    const double range = 1.0 / std::max(1e-9, std::abs(std::sin(at)));
    line += " " + std::to_string(std::min(longest, range));
  }
  const std::string pose = std::to_string(0.1 * i) + " 0 0";
  return line + " " + pose + " " + pose + tail + "\n";
}

CarmenLog parse(const std::string& text) {
  return parse_carmen(text, "a.log");
}

TEST(CarmenKinds, EveryLaserMessageIsReadAndTheFrontOneKept) {
  const std::string old = " 0 0 0 0 0 0 5 h 5\n";
  const std::string config = " 0 -1.5 3 1.5 30 0.01 0 3 1 2 1 0";
  const std::string odom = "ODOM 0 0 0 0 0 0 4.9 h 4.9\nODOM 0.2 0 0 0 0 0 5.1 h 5.1\n";
  for (const auto& [line, laser] : std::vector<std::pair<std::string, Laser>>{
           {"FLASER 3 1 2 1" + old, Laser::flaser},
           {"RLASER 3 1 2 1" + old, Laser::rlaser},
           {"LASER3 3 1 2 1" + old, Laser::laser3},
           {"ROBOTLASER1" + config + " 0 0 0 0 0 0 0 0 0 0 0 5 h 5\n", Laser::robot1},
           {"ROBOTLASER2" + config + " 0 0 3.1415 0 0 0 0 0 0 0 0 5 h 5\n", Laser::robot2},
           {"RAWLASER1" + config + " 5 h 5\n", Laser::raw1}}) {
    const CarmenLog log = parse(odom + line);
    ASSERT_EQ(log.scans.size(), 1U) << line;
    EXPECT_TRUE(log.damaged.empty()) << log.damaged.front();
    EXPECT_EQ(log.scans[0].laser, laser);
    EXPECT_EQ(log.scans[0].ranges, (std::vector<double>{1.0, 2.0, 1.0}));
    EXPECT_DOUBLE_EQ(log.scans[0].time.ipc, 5.0);
  }
  const CarmenLog both = parse("RLASER 3 1 2 1" + old + "FLASER 3 4 4 4" + old + odom);
  ASSERT_EQ(both.scans.size(), 1U);
  EXPECT_EQ(both.scans[0].laser, Laser::flaser);
  ASSERT_EQ(both.notes.size(), 1U);
  EXPECT_EQ(both.notes[0], "FLASER is read, 1 RLASER are not");
  EXPECT_EQ(both.odometry[0].scans_before, 1U);
}

TEST(CarmenKinds, ARawScanIsWhereDeadReckoningWasThen) {
  const CarmenLog log = parse(
      "ODOM 1 0 0 0 0 0 10 h 10\nRAWLASER1 0 -1.5 3 1.5 30 0 0 3 1 2 1 0 10.25 h 10\n"
      "ODOM 2 0 0 0 0 0 11 h 11\nRAWLASER1 0 -1.5 3 1.5 30 0 0 3 1 2 1 0 99 h 99\n");
  ASSERT_EQ(log.scans.size(), 1U);
  EXPECT_NEAR(log.scans[0].pose.x, 1.25, 1e-9);
  EXPECT_EQ(log.notes, std::vector<std::string>{"1 scans have no dead reckoning at their time"});
  EXPECT_THROW(parse("RAWLASER1 0 -1.5 3 1.5 30 0 0 3 1 2 1 0 10.25 h 10\n"), FileError);
}

TEST(CarmenKinds, CommentsParametersCrlfAndUnknownLinesDoNotMatter) {
  const CarmenLog log = parse(
      "# FLASER 3 1 1 1 0 0 0 0 0 0 1 h 1\r\n\r\nSYNC tag 1 h 1\r\nPARAM robot_width 0.4 h 0\r\n"
      "NMEAGGA 1 2 3\r\nTRUEPOS 1 2 0.5 0 0 0 1 h 1\r\nFLASER 3 nan -1 inf 0 0 0 0 0 0 1 h 1\r\n"
      "FLASER 2 0 1e400 0 0 0 0 0 0 1 h 1");
  EXPECT_TRUE(log.damaged.empty()) << log.damaged.front();
  ASSERT_EQ(log.scans.size(), 2U);
  EXPECT_GT(log.scans[0].ranges[0], 1e6);
  EXPECT_EQ(log.scans[0].ranges[1], -1.0);
  for (const LaserScan& scan : log.scans) {
    Beams beams;
    beams.max_range = scan.no_return;
    EXPECT_TRUE(make_scan(scan.ranges, beams).points.empty());
  }
}

TEST(CarmenKinds, WithoutStampsTheOrderIsTheTime) {
  const CarmenLog log = parse(
      "ODOM 0 0 0 0 0 0\nFLASER 2 1 1 0 0 0 0 0 0\nODOM 0.1 0 0 0 0 0\n"
      "FLASER 2 1 1 0.1 0 0 0.1 0 0\n");
  ASSERT_EQ(log.scans.size(), 2U);
  EXPECT_TRUE(log.damaged.empty()) << log.damaged.front();
  EXPECT_DOUBLE_EQ(log.scans[1].time.ipc, 0.1);
  EXPECT_GT(log.odometry[1].time.ipc, log.scans[0].time.ipc);
  EXPECT_LT(log.odometry[1].time.ipc, log.scans[1].time.ipc);
  EXPECT_FALSE(log.notes.empty());
}

TEST(CarmenBeams, LieAsUsualLasersHaveThem) {
  for (const auto& [beams, first, step] :
       std::vector<std::tuple<int, double, double>>{{180, -90.0, 1.0},
                                                    {181, -90.0, 1.0},
                                                    {360, -90.0, 0.5},
                                                    {361, -90.0, 0.5},
                                                    {401, -50.0, 0.25},
                                                    {541, -135.0, 0.5},
                                                    {1081, -135.0, 0.25},
                                                    {682, -119.70703125, 0.3515625},
                                                    {101, -90.0, 1.8}}) {
    const CarmenLog log = parse(flaser("FLASER", beams, 0, 50.0, " 1 h 1"));
    EXPECT_NEAR(degrees(log.scans[0].first_angle), first, 1e-9) << beams;
    EXPECT_NEAR(degrees(log.scans[0].step), step, 1e-9) << beams;
  }
  const CarmenLog said = parse("PARAM laser_front_laser_resolution 0.5 nohost 0\n" +
                               flaser("FLASER", 201, 0, 50.0, " 1 h 1"));
  EXPECT_NEAR(degrees(said.scans[0].first_angle), -50.0, 1e-9);
  EXPECT_TRUE(said.notes.empty());
}

TEST(Carmen, AResolutionThatDoesNotFitTheBeamsIsNotBelieved) {
  // No laser has 180 beams half a degree apart.
  const CarmenLog log = parse("PARAM laser_front_laser_resolution 0.5 nohost 0\n" +
                              flaser("FLASER", 180, 0, 50.0, " 1 h 1"));
  EXPECT_NEAR(degrees(log.scans[0].first_angle), -90.0, 1e-9);
  EXPECT_NEAR(degrees(log.scans[0].step), 1.0, 1e-9);
  ASSERT_EQ(log.notes.size(), 1U);
  EXPECT_NE(log.notes[0].find("resolution 0.5 does not fit 180 beams"), std::string::npos)
      << log.notes[0];
}

TEST(Carmen, AHeaderThatMayContradictTheBeamsIsTold) {
  struct Case {
    const char* header;
    int beams;
    double step;  // [degrees]
    const char* note;
  };
  for (const Case& each : {
           Case{"resolution 2", 180, 2.0, "taken as 2 degrees apart, over 360 degrees"},
           Case{"resolution 1", 361, 1.0, "taken as 1 degrees apart, over 360 degrees"},
           Case{"resolution 0.5", 200, 0.5, "taken as 0.5 degrees apart, over 100 degrees"},
           Case{"fov 90", 180, 1.0, "laser_front_laser_fov 90 does not fit 180 beams"},
           Case{"fov 180", 180, 1.0, ""},
           Case{"fov 270", 541, 0.5, ""},
           Case{"resolution 1", 181, 1.0, ""},
       }) {
    const CarmenLog log = parse("PARAM laser_front_laser_" + std::string(each.header) +
                                " nohost 0\n" + flaser("FLASER", each.beams, 0, 50.0, " 1 h 1"));
    EXPECT_NEAR(degrees(log.scans[0].step), each.step, 1e-9) << each.header;
    ASSERT_EQ(log.notes.size(), *each.note == 0 ? 0U : 1U) << each.header << " " << each.beams;
    if (!log.notes.empty()) {
      EXPECT_NE(log.notes[0].find(each.note), std::string::npos) << log.notes[0];
    }
  }
  // Two values that fit each other are believed; others are told.
  const auto with_both = [](const char* resolution) {
    return parse("PARAM laser_front_laser_fov 90 nohost 0\nPARAM laser_front_laser_resolution " +
                 std::string(resolution) + " nohost 0\n" +
                 flaser("FLASER", 180, 0, 50.0, " 1 h 1"));
  };
  EXPECT_NEAR(degrees(with_both("0.5").scans[0].step), 0.5, 1e-9);
  EXPECT_TRUE(with_both("0.5").notes.empty());
  EXPECT_NEAR(degrees(with_both("1").scans[0].step), 1.0, 1e-9);
  EXPECT_EQ(with_both("1").notes.size(), 1U);
}

TEST(Carmen, ARobotLaserWhoseStepDoesNotFitItsFieldIsTold) {
  struct Case {
    const char* head;  // first angle, field of view, step
    double step;       // [degrees]
    bool told;
  };
  for (const Case& each : {
           Case{"-1.570796 3.141593 0.008727", 180.0 / 179.0, true},
           Case{"-1.570796 3.141593 0.034907", 180.0 / 179.0, true},
           Case{"-1.570796 3.141593 1", 1.0, true},
           Case{"-1.570796 1.570796 0.017453293", 1.0, true},
           Case{"-1.570796 3.141593 0.017453293", 1.0, false},
           Case{"-1.570796 3.141593 0", 180.0 / 179.0, false},
           Case{"-90 180 1", 1.0, true},
           Case{"-180 360 2.0111731844", 360.0 / 179.0, true},
       }) {
    std::string line = "ROBOTLASER1 0 " + std::string(each.head) + " 50 0.01 0 180";
    for (int i = 0; i < 180; ++i)
      line += " 1";
    const CarmenLog log = parse(line + " 0 0 0 0 0 0 0 0 0 0 0 0 10.5 host 10.6\n");
    ASSERT_EQ(log.scans.size(), 1U) << each.head;
    EXPECT_NEAR(degrees(log.scans[0].step), each.step, 1e-3) << each.head;
    EXPECT_EQ(log.notes.size(), each.told ? 1U : 0U) << each.head;
    EXPECT_LE(std::abs(log.scans[0].first_angle), kPi) << each.head;
  }
}

TEST(Carmen, ARobotLaserWithOrWithoutACountOfRemissions) {
  const std::string head = "ROBOTLASER1 0 -1.570796 3.141593 0.785398 50 0.01 0 5 1 2 3 4 5";
  const std::string tail = " 1.1 2 0 1 2 0 0.1 0 1 1 0 10.5 host 10.6\n";
  for (const char* remissions : {"", " 0", " 2 7 8"}) {
    const CarmenLog log = parse(head + remissions + tail);
    ASSERT_TRUE(log.damaged.empty()) << log.damaged.front();
    ASSERT_EQ(log.scans.size(), 1U);
    EXPECT_EQ(log.scans[0].ranges.size(), 5U);
    EXPECT_NEAR(log.scans[0].pose.x, 1.0, 1e-9);
    EXPECT_NEAR(log.scans[0].laser_in_robot.x, 0.1, 1e-9);
    EXPECT_NEAR(log.scans[0].time.ipc, 10.5, 1e-9);
  }
}

TEST(CarmenMount, IsWhatAllPosesSay) {
  // Backwards and off centre, at three headings.
  std::string text = "PARAM robot_frontlaser_offset 0.3 nohost 0\n";
  const Pose in_robot{-0.2, 0.1, kPi};
  for (int i = 0; i < 3; ++i) {
    const Pose robot{1.0, 2.0, 0.7 * i};
    const Pose laser = compose(robot, in_robot);
    std::string line = "FLASER 2 1 1";
    for (const Pose& p : {laser, robot})
      for (const double v : {p.x, p.y, p.th})
        line += " " + std::to_string(v);
    text += line + " " + std::to_string(i) + " h 1\n";
  }
  const CarmenLog log = parse(text);
  for (const LaserScan& scan : log.scans) {
    EXPECT_NEAR(scan.laser_in_robot.x, -0.2, 1e-4);
    EXPECT_NEAR(scan.laser_in_robot.y, 0.1, 1e-4);
    EXPECT_NEAR(std::abs(scan.laser_in_robot.th), kPi, 1e-4);
  }
  // Equal poses do not give the place; the parameters count.
  EXPECT_DOUBLE_EQ(
      parse("PARAM robot_frontlaser_offset 0.3 nohost 0\nFLASER 1 1 5 5 0 5 5 0 1 h 1\n")
          .scans[0]
          .laser_in_robot.x,
      0.3);
  // If only one of the two is corrected, they do not give it either.
  const CarmenLog corrected =
      parse("FLASER 1 1 0.1 0 0 0 0 0 1 h 1\nFLASER 1 1 5 5 1 4.5 5 0 2 h 2\n");
  EXPECT_EQ(corrected.scans[0].laser_in_robot, Pose{});
}

TEST(CarmenNoReturn, IsWhereRangesPileUp) {
  Random random(3);
  const auto drive = [&](double longest, double pile) {
    std::vector<LaserScan> scans(200);
    for (LaserScan& scan : scans)
      for (int i = 0; i < 180; ++i)
        scan.ranges.push_back(random.chance(pile) ? longest : random.uniform(0.5, 7.9));
    return scans;
  };
  for (const double longest : {8.0, 8.191, 30.0, 50.0, 80.0, 81.91})
    EXPECT_NEAR(find_no_return(drive(longest, 0.1)).value_or(0.0), longest, 0.04) << longest;
  // None: the robot never looked so far.
  EXPECT_FALSE(find_no_return(drive(8.0, 0.0)));
  // A few codes far above, as from some lasers, hide nothing.
  auto codes = drive(8.19, 0.1);
  codes[7].ranges[5] = codes[8].ranges[5] = 81.91;
  EXPECT_NEAR(find_no_return(codes).value_or(0.0), 8.19, 0.04);
  // A robot stands before a wall at 3 m for half of the time.
  auto wall = drive(80.0, 0.05);
  for (std::size_t i = 0; i < 100; ++i)
    std::fill_n(wall[i].ranges.begin(), 90, 3.0);
  EXPECT_NEAR(find_no_return(wall).value_or(0.0), 80.0, 0.04);
}

TEST(CarmenFiles, APackedLogThatEndsTooEarlyIsReadAsFarAsItGoes) {
  const TempDir folder;
  const std::string path = folder.path("cut.log.gz");
  std::string text;
  Random random(5);
  for (int i = 0; i < 400; ++i)
    text += "FLASER 1 " + std::to_string(random.uniform(1.0, 9.0)) + " 0 0 0 0 0 0 " +
            std::to_string(i) + " h 1\n";
  gzFile out = gzopen(path.c_str(), "wb");
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
  std::string trouble;
  EXPECT_EQ(read_log(path, &trouble), text);
  EXPECT_TRUE(trouble.empty()) << trouble;
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const std::string half = read_log(path, &trouble);
  EXPECT_NE(trouble.find("cut off"), std::string::npos);
  ASSERT_FALSE(half.empty());
  EXPECT_EQ(half.back(), '\n');
  EXPECT_TRUE(text.starts_with(half));
  EXPECT_TRUE(parse(half).damaged.empty());
}

TEST(CarmenFiles, AClockThatWasSetBackIsNotTakenIfTheOtherIsSound) {
  const TempDir folder;
  const auto load = [&](const char* last) {
    std::string text = flaser("FLASER", 181, 0, 30.0, " 100 h 1");
    text += flaser("FLASER", 181, 1, 30.0, " 50 h 2");
    text += flaser("FLASER", 181, 2, 30.0, last);
    std::ofstream(folder.path("a.log")) << text;
    return load_data_set("a", folder.path("a.log"));
  };
  const DataSet sound = load(" 51 h 3");
  EXPECT_EQ(sound.times, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_NEAR(sound.way(), 0.2, 1e-9);
  EXPECT_GT(sound.scans.front().points.size(), 170U);
  EXPECT_TRUE(sound.notes.empty());
  const DataSet neither = load(" 51 h -3");
  EXPECT_EQ(neither.times, (std::vector<double>{50.0, 51.0, 100.0}));
  EXPECT_EQ(neither.notes.size(), 1U);
}

// Reading a damaged file gives scans with finite poses and times, or an error that begins with the
// file's name. Damaged lines are reported.
TEST(CarmenProperty, DamageIsToldAndNothingElse) {
  std::string good = "PARAM robot_front_laser_max 80 nohost 0\n";
  for (int i = 0; i < 6; ++i) {
    good += "ODOM 0 0 0 0 0 0 " + std::to_string(i) + " h 0\n";
    good += flaser(i % 2 == 0 ? "FLASER" : "RLASER", 5, i, 30.0, " 1 h 1");
    good += "ROBOTLASER1 0 -1.5 3 1.5 30 0.01 0 3 1 2 1 1 5 0 0 0 0 0 0 0 0 0 0 0 5 h 5\n";
  }
  Random random(7);
  for (int round = 0; round < 3000; ++round) {
    std::string text = good;
    for (std::uint32_t k = 0; k < 1 + random.next() % 6; ++k) {
      const std::size_t at = random.next() % text.size();
      const char* const pieces[] = {"\n", " ", "nan", "-", "1e999", "\r", "9999999", "\0x", "#"};
      switch (random.next() % 3) {
        case 0:
          text.erase(at, random.next() % 30);
          break;
        case 1:
          text.insert(at, pieces[random.next() % std::size(pieces)]);
          break;
        default:
          text[at] = static_cast<char>(random.next());
      }
      if (text.empty())
        text = " ";
    }
    try {
      const CarmenLog log = parse(text);
      ASSERT_FALSE(log.scans.empty());
      for (const LaserScan& scan : log.scans) {
        ASSERT_TRUE(std::isfinite(scan.pose.x) && std::isfinite(scan.time.ipc));
        ASSERT_TRUE(std::isfinite(scan.first_angle) && std::isfinite(scan.laser_in_robot.th));
      }
      for (const std::string& line : log.damaged)
        ASSERT_TRUE(line.starts_with("a.log:") && line.find("expected") != std::string::npos)
            << line;
    } catch (const std::runtime_error& error) {
      ASSERT_TRUE(std::string(error.what()).starts_with("a.log:")) << error.what();
    }
  }
}

}  // namespace
}  // namespace saphira::logs
