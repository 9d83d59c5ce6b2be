// Registration as a service, with a simulated robot that tours an office, step by step.
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "drive/drive.hpp"
#include "lps/shell/convert.hpp"
#include "maps/shell/convert.hpp"
#include "node_options.hpp"
#include "registration/shell/service.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/request_client.hpp"
#include "trouble.hpp"

namespace {

/// The bytes on the disk, and the content of the file named there, at that time.
struct Synced {
  std::string path;
  std::string target;  ///< the content of the file to be replaced
};
std::vector<Synced> synced;
std::string watched;

}  // namespace

/// Instead of the C library's.
extern "C" int fsync(int fd) {
  if (!watched.empty()) {
    std::error_code none;
    Synced now{std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(fd), none), ""};
    std::ifstream file(watched);
    std::getline(file, now.target);
    synced.push_back(now);
  }
  return static_cast<int>(syscall(SYS_fsync, fd));
}

namespace saphira::registration {
namespace {

std::string map_path(const std::string& name) {
  return config_folder() + "/maps/" + name + ".map";
}

class RegistrationShell : public testing::Test {
 protected:
  RegistrationShell() { drive.scene().set_door("n2", true); }

  void start(const Options& options) {
    service.emplace(test::memory_options("registration", true), drive.bus());
    shell.emplace(*service, [options](runtime::Ports& ports) {
      return std::make_unique<Service>(ports, options);
    });
  }

  /// One cycle of robot and services.
  void cycle() {
    const test::Seen& seen = drive.advance();
    // A service that starts late steps the oldest available cycle first.
    do {
      ASSERT_TRUE(shell->step(stop));
      const auto newest = registrations.take_newest();
      ASSERT_TRUE(newest);
      registration = *newest;
    } while (registration.stamp.cycle < seen.cycle);
    ASSERT_EQ(registration.stamp.cycle, seen.cycle);
  }

  /// The service ends when the memory has its whole state, and another one begins.
  void restart(const Options& options) {
    const std::string file = options.memory_file;
    // The first save may have been under way before.
    for (int saves = 0; saves < 2; ++saves) {
      std::filesystem::remove(file);
      const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(30);
      while (!std::filesystem::exists(file) && std::chrono::steady_clock::now() < limit)
        cycle();
      ASSERT_TRUE(std::filesystem::exists(file));
    }
    shell.reset();
    service.reset();
    start(options);
    cycle();
  }

  /// To and fro through the corridor of the office, by the service's pose.
  void tour(test::Tour& tour, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      if (!tour.act(drive, lps::from_bus(registration.pose_in_map)))
        return;
      ASSERT_NO_FATAL_FAILURE(cycle());
    }
  }

  double error() const {
    return (lps::from_bus(registration.pose_in_map).position() -
            drive.seen().true_pose_in_world.position())
        .norm();
  }

  Answer ask(const Request& asked) {
    v1::Request request = to_bus(asked);
    request.source = "test";
    request.number = ++number;
    requests.write(request);
    cycle();
    const auto answer = answers.take_newest();
    EXPECT_TRUE(answer.has_value());
    EXPECT_EQ(answer->number, number);
    return from_bus(*answer);
  }
  static Request put(const char* type, const Pose& pose_in_map, double size) {
    return {"put",
            {{"type", std::string(type)},
             {"position", PlacedPoint{pose_in_map, Frame::map}},
             {"length", size},
             {"width", size}}};
  }
  static std::uint32_t id_of(const Answer& answer) {
    return static_cast<std::uint32_t>(number_of(answer.results, "id"));
  }

  /// The office with a door to N2, which is open at first, and a crate, which is far away.
  static test::DriveOptions options() {
    test::DriveOptions made;
    made.world = testing::TempDir() + "saphira-registration-" + std::to_string(getpid()) + ".wld";
    std::ofstream(made.world) << read_file(config_folder() + "/worlds/office.wld")
                              << "\ndoor n2 6500 8000 7400 8000 90\n"
                              << "box crate 20000 10000 0 400 400 50\n";
    made.errors = 2.0;
    made.interpretation = true;
    return made;
  }

  /// To and fro until `done`, or for so many cycles; returns the result of `done`.
  bool tour_until(const std::function<bool()>& done, int cycles) {
    test::Tour to_and_fro({{11.0, 7.0}, {2.0, 7.0}}, true);
    for (int i = 0; i < cycles && !done() && !HasFatalFailure(); i += 10)
      tour(to_and_fro, 10);
    return done();
  }
  const maps::Map& known_map() {
    if (const auto newest = maps.take_newest())
      newest_map = maps::from_bus(*newest);
    return newest_map;
  }
  /// The robot's object on the map at the crate's place.
  const maps::Feature* crate() {
    for (const maps::Feature& feature : known_map().features)
      if (feature.type == lps::PointType::object && feature.learned &&
          (feature.pose_in_map.position() - drive.scene().boxes()[0].pose_in_world.position())
                  .norm() < 0.5)
        return &feature;
    return nullptr;
  }

  const test::TempDir folder;
  test::Drive drive{options()};
  bus::Stop stop;
  bus::Node& node = drive.node();
  bus::Writer<v1::Request> requests{node.writer<v1::Request>(bus::topics::kRegistrationRequest)};
  bus::Reader<v1::Registration> registrations{node.reader(bus::topics::kRegistration)};
  bus::Reader<v1::Answer> answers{node.reader(bus::topics::kRegistrationAnswers)};
  bus::Reader<v1::FloorMap> maps{node.reader(bus::topics::kMap)};
  std::optional<bus::Node> service;
  std::optional<runtime::Shell> shell;
  v1::Registration registration;
  maps::Map newest_map;
  std::uint64_t number = 0;
};

TEST_F(RegistrationShell, KeepsTheRobotOnTheMap) {
  start({map_path("office"), "start", ""});
  const auto map = maps.take_newest();
  ASSERT_TRUE(map);
  const maps::Map file = maps::load_map(map_path("office"));
  ASSERT_EQ(map->artifacts.size(), file.features.size());
  for (std::size_t i = 0; i < file.features.size(); ++i) {
    maps::Feature expected = file.features[i];
    const maps::Feature feature = maps::from_bus(map->artifacts[i]);
    EXPECT_NE(feature.id, 0U) << "while it is loaded a wall has one, too";
    if (expected.type == lps::PointType::wall)
      expected.id = feature.id;
    EXPECT_EQ(feature, expected);
  }
  cycle();
  EXPECT_EQ(registration.state, v1::REGISTRATION_TRACKING);
  EXPECT_EQ(registration.environment, 1U);
}

TEST_F(RegistrationShell, AThingComesOntoTheMapAndGoesWhereFeaturesAreAdded) {
  ASSERT_TRUE(drive.scene().set_box("crate", {5.0, 7.7, 0.0}));
  Options options{map_path("office"), "start", folder.path("memory")};
  options.add_features = true;
  start(options);
  ASSERT_TRUE(tour_until([&] { return crate() != nullptr; }, 1200));
  const std::uint32_t id = crate()->id;
  EXPECT_GT(id, 115U);
  // It keeps its id, also over a restart.
  restart(options);
  ASSERT_NE(crate(), nullptr);
  EXPECT_EQ(crate()->id, id);
  ASSERT_TRUE(drive.scene().set_box("crate", {20.0, 10.0, 0.0}));
  EXPECT_TRUE(tour_until([&] { return maps::find(known_map(), id) == nullptr; }, 2000));
  for (const maps::Feature& feature : maps::load_map(map_path("office")).features) {
    if (feature.id != 0) {
      EXPECT_NE(maps::find(known_map(), feature.id), nullptr)
          << "a person wrote it: " << feature.id;
    }
  }
}

TEST_F(RegistrationShell, AThingThatIsNotThereIsTakenFromTheMapOfAPerson) {
  start({map_path("office"), "start", ""});
  cycle();
  const std::uint32_t id = id_of(ask(put("OBJECT", {5.0, 7.7, 0.0}, 0.5)));
  ASSERT_NE(maps::find(known_map(), id), nullptr);
  EXPECT_TRUE(tour_until([&] { return maps::find(known_map(), id) == nullptr; }, 2000));
  // And the crate is not put onto it.
  ASSERT_TRUE(drive.scene().set_box("crate", {5.0, 7.7, 0.0}));
  EXPECT_FALSE(tour_until([&] { return crate() != nullptr; }, 1200));
}

TEST_F(RegistrationShell, ABadMemoryIsNone) {
  const auto with = [](const Pose& pose, double size) {
    Remembered memory;
    memory.option = memory.source = map_path("office");
    memory.memory.filter.emplace(pose, Eigen::Matrix3d::Zero(), 0.0, 0.0, ReckoningErrors{});
    maps::Feature& office = memory.map.features.emplace_back();
    office.type = lps::PointType::office;
    office.id = 1;
    office.length = office.width = size;
    return sealed(saved(memory));
  };
  for (const std::string& text :
       {std::string(), std::string("; memory of saphira\nodom 1\nmap\n; sum 0123456789abcdef\n"),
        sealed("{\"memory\":{}}"), with({std::nan(""), 0.0, 0.0}, 1.0), with({1e11, 0.0, 0.0}, 1.0),
        with({}, 2000.0)}) {
    std::ofstream(folder.path("memory")) << text;
    start({map_path("office"), "start", folder.path("memory")});
    const auto map = maps.take_newest();
    ASSERT_TRUE(map) << text;
    EXPECT_EQ(map->source, map_path("office"));
    shell.reset();
    service.reset();
  }
  start({map_path("office"), "start", folder.path("memory")});
  cycle();
  EXPECT_EQ(registration.state, v1::REGISTRATION_TRACKING);
}

TEST(StartPose, IsAPlaceOrAPose) {
  const maps::Map map = maps::parse_map("POS (1) 1000, 2000, 90 \"start\"\n", "a.map");
  EXPECT_NEAR(start_pose("start", map)->y, 2.0, 1e-12);
  EXPECT_FALSE(start_pose("start", {}));
  EXPECT_FALSE(start_pose("unknown", map));
  EXPECT_EQ(start_pose("1.5,-2,0.5", {}), (Pose{1.5, -2.0, 0.5}));
  EXPECT_THROW(start_pose("1.5,-2", {}), std::invalid_argument);
  EXPECT_THROW(start_pose("1.5,nan,0", {}), std::invalid_argument);
  EXPECT_THROW(start_pose("1.5,-1e13,0", {}), std::invalid_argument);
  EXPECT_THROW(start_pose("kitchen", map), std::invalid_argument);
  const auto said = [&](const char* start) {
    return test::trouble_of<std::invalid_argument>([&] { start_pose(start, map); });
  };
  EXPECT_EQ(said("1,2,6.28"), "");
  EXPECT_EQ(
      said("1,2,90"),
      "start \"1,2,90\": expected th between -2 pi and 2 pi; it is in radians; 90 degrees are "
      "1.5708");
  EXPECT_EQ(said("1500,7000,0").substr(0, 48),
            "start \"1500,7000,0\": expected a place on the map");
}

TEST(MemoryFile, IsOnTheDiskBeforeItReplacesTheOldOne) {
  const test::TempDir folder;
  const std::string path = folder.path("memory");
  ASSERT_TRUE(replace_file(path, "old\n", true));
  watched = path;
  synced.clear();
  ASSERT_TRUE(replace_file(path, "new\n", true));
  watched.clear();
  ASSERT_EQ(synced.size(), 2U);
  EXPECT_EQ(synced[0].path, path + ".new");
  EXPECT_EQ(synced[0].target, "old");
  EXPECT_EQ(synced[1].path, std::filesystem::path(path).parent_path());
  EXPECT_EQ(synced[1].target, "new");
  EXPECT_FALSE(replace_file(folder.path("nowhere/memory"), "new\n", true));
}

}  // namespace
}  // namespace saphira::registration
