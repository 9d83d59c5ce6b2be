#include "saphira/sim/view.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "process.hpp"
#include "saphira/base/local_socket.hpp"
#include "saphira/sim/host.hpp"

namespace saphira::sim {
namespace {

using nlohmann::json;

World small() {
  return parse_world(
      "width 10000 height 10000 0 0 10000 0 10000 0 10000 10000 10000 10000 0 10000 0 10000 0 0\n"
      "person ann 8000 8000 box crate 5000 8000 0 400 600 5 door d 2000 5000 3000 5000 90\n"
      "post can 6000 2000 60 color red",
      "small.wld");
}

/// A host of which nothing is asked.
struct NoHost : ViewedHost {
  std::string pause(bool) override { return "asked"; }
  std::string step_once() override { return "asked"; }
  std::string set_rate(double) override { return "asked"; }
  std::string disconnect(RobotNumber) override { return "asked"; }
  std::string load(Load) override { return "asked"; }
  std::string list_files() override { return "asked"; }
} nothing_else;

TEST(View, TellsWhatIsThere) {
  const World world = small();
  Simulation simulation(world);
  simulation.add({}, Pose{2.0, 2.0, 0.0}, {});
  const json still = json::parse(describe_world(world, {{"a", "b"}, {"pioneer"}, "a"}));
  EXPECT_EQ(still.at("walls").size(), 4U);
  EXPECT_EQ(still.at("posts").at(0).at("color"), "red");
  EXPECT_EQ(still.at("worlds").size(), 2U);
  const json scene = json::parse(describe_scene(simulation, {}));
  EXPECT_EQ(scene.at("robots").at(0).at("x"), 2.0);
  EXPECT_EQ(scene.at("people").at(0).at("name"), "ann");
  EXPECT_EQ(scene.at("boxes").at(0).at("corners").size(), 4U);
  EXPECT_EQ(scene.at("doors").at(0).at("open"), false);
}

TEST(View, DoesWhatItIsAskedForAndSaysWhyNot) {
  const World world = small();
  Simulation simulation(world);
  simulation.add({}, Pose{2.0, 2.0, 0.0}, {});
  const auto act = [&](const std::string& text) { return obey(text, simulation, nothing_else); };
  EXPECT_EQ(act(R"({"do":"place","robot":0,"x":4,"y":3,"th":1.5})"), "");
  EXPECT_EQ(simulation.scene().robot(0).pose_in_world(), (Pose{4.0, 3.0, 1.5}));
  EXPECT_NE(act(R"({"do":"place","robot":0,"x":0.1,"y":3,"th":0})"), "");
  EXPECT_NE(act(R"({"do":"place","robot":1,"x":4,"y":3,"th":0})"), "");
  EXPECT_EQ(act(R"({"do":"person","name":"ann","x":7,"y":7})"), "");
  EXPECT_EQ(simulation.scene().persons()[0].at, Vec2(7.0, 7.0));
  EXPECT_NE(act(R"({"do":"person","name":"ann","x":4,"y":3.1})"), "") << "there stands the robot";
  EXPECT_NE(act(R"({"do":"person","name":"bob","x":7,"y":7})"), "");
  EXPECT_EQ(act(R"({"do":"point","name":"ann","th":1.5})"), "");
  EXPECT_EQ(simulation.scene().persons()[0].points, 1.5);
  EXPECT_EQ(json::parse(describe_scene(simulation, {})).at("people").at(0).at("arm").size(), 4U);
  EXPECT_EQ(act(R"({"do":"point","name":"ann"})"), "");
  EXPECT_FALSE(simulation.scene().persons()[0].points);
  EXPECT_NE(act(R"({"do":"point","name":"bob","th":1.5})"), "");
  EXPECT_EQ(act(R"({"do":"box","name":"crate","x":5,"y":6,"th":0.5})"), "");
  EXPECT_EQ(act(R"({"do":"door","name":"d","open":true})"), "");
  EXPECT_TRUE(simulation.scene().doors()[0].opens);
}

// Table 5-5's last fields, of a robot of PSOS.
TEST(View, InputsAreInTheRobotsPackets) {
  const World world = small();
  Simulation simulation(world);
  simulation.add({}, Pose{2.0, 2.0, 0.0}, {});
  Server& server = simulation.server(0);
  for (const int sync : {0, 1, 2})
    server.receive(protocol::encode_sync(sync));
  server.receive(protocol::encode(protocol::Open{}));
  const auto act = [&](const std::string& text) { return obey(text, simulation, nothing_else); };
  const auto packet = [&] {
    server.take_output();
    simulation.advance(kTicksPerPacket);
    protocol::PacketParser parser;
    parser.feed(server.take_output());
    return protocol::decode_information(parser.next().value()).value();
  };
  EXPECT_EQ(act(R"({"do":"input","robot":0,"digital":5,"analog":200})"), "");
  const protocol::InformationPacket first = packet();
  EXPECT_EQ(first.digital_input, 5);
  EXPECT_EQ(first.analog, 200);
  EXPECT_EQ(first.timer, 0);

  // Another pin than the timer's is no event of it.
  server.receive(protocol::encode(protocol::Timer{3}));
  EXPECT_EQ(packet().timer, 100);
  EXPECT_EQ(act(R"({"do":"input","robot":0,"digital":1})"), "");
  EXPECT_EQ(packet().timer, 200);
  EXPECT_EQ(act(R"({"do":"input","robot":0,"digital":9})"), "");
  EXPECT_EQ(packet().timer, 200);
  EXPECT_EQ(packet().timer, 200);
  server.receive(protocol::encode(protocol::Timer{3}));
  EXPECT_EQ(packet().timer, 100) << "begun again";
  EXPECT_EQ(packet().analog, 200);

  EXPECT_NE(act(R"({"do":"input","robot":0,"port":1,"analog":1})"), "") << "it has one port";
  EXPECT_NE(act(R"({"do":"input","robot":1,"digital":1})"), "");
  const json scene = json::parse(describe_scene(simulation, {}));
  EXPECT_EQ(scene.at("robots").at(0).at("inputs").at("digital"), 9);
  EXPECT_EQ(scene.at("robots").at(0).at("inputs").at("analog"), json::array({200}));
  EXPECT_EQ(scene.at("robots").at(0).at("outputs"), 0);
}

TEST(View, WhatIsNoWishIsRefusedWithWhatWasExpected) {
  const World world = small();
  Simulation simulation(world);
  simulation.add({}, Pose{2.0, 2.0, 0.0}, {});
  for (const char* const text :
       {"", "[]", "{", R"({"do":"fly"})", R"({"do":"place","robot":0,"x":1e9,"y":0,"th":0})",
        R"({"do":"place","robot":-1,"x":0,"y":0,"th":0})", R"({"do":"pause","on":1})",
        R"({"do":"rate","rate":0})", R"({"do":"door","name":3,"open":true})",
        R"({"do":"load","world":"../../etc/passwd"})", R"({"do":"load","world":"/tmp/x.wld"})",
        R"({"do":"input","robot":0})", R"({"do":"input","robot":0,"digital":256})",
        R"({"do":"input","robot":0,"digital":0.5})", R"({"do":"input","robot":0,"analog":-1})"})
    EXPECT_THROW(obey(text, simulation, nothing_else), std::invalid_argument) << text;
}

/// A viewer on the socket of a host, both in this thread.
class Viewer {
 public:
  Viewer(Host& host, const std::string& path) : host_(host), fd_(connect_local(path)) {
    EXPECT_GE(fd_, 0);
  }
  void say(const std::string& text) {
    const std::string line = text + "\n";
    EXPECT_EQ(::send(fd_, line.data(), line.size(), 0), static_cast<ssize_t>(line.size()));
  }
  /// The next line of that kind.
  json next(const std::string& type) {
    for (int i = 0; i < 1000; ++i) {
      host_.serve(-1, 10);
      char part[4096];
      const ssize_t size = ::recv(fd_, part, sizeof part, MSG_DONTWAIT);
      if (size > 0)
        heard_.append(part, static_cast<std::size_t>(size));
      for (auto end = heard_.find('\n'); end != std::string::npos; end = heard_.find('\n')) {
        json line = json::parse(heard_.substr(0, end));
        heard_.erase(0, end + 1);
        if (line.at("type") == type)
          return line;
      }
    }
    ADD_FAILURE() << "no " << type;
    return {};
  }

 private:
  Host& host_;
  Descriptor fd_;
  std::string heard_;
};

TEST(View, PausesStepsAndLoadsAnotherWorldByTheSocket) {
  const test::TempDir folder;
  HostOptions options;
  options.world = test::source("config/worlds/office.wld");
  options.robot = test::source("config/robots/pioneer.p");
  options.socket = folder.path("robot");
  options.view_socket = folder.path("view");
  options.world_file = [](const std::string& name) {
    return test::source("config/worlds/" + name + ".wld");
  };
  options.robot_file = [](const std::string& name) {
    return test::source("config/robots/" + name + ".p");
  };
  Host host(options);
  Viewer viewer(host, folder.path("view"));
  EXPECT_EQ(viewer.next("world").at("world"), "office");
  viewer.say(R"({"do":"pause","on":true})");
  json scene;
  do
    scene = viewer.next("scene");
  while (scene.at("paused") == false && !HasFailure());
  viewer.say(R"({"do":"rate","rate":0})");
  EXPECT_NE(viewer.next("trouble").at("text").get<std::string>().find("rate"), std::string::npos);
  viewer.say(R"({"do":"load","world":"nowhere"})");
  viewer.next("trouble");
  viewer.say(R"({"do":"load","world":"arena","robot":"p3dx"})");
  EXPECT_EQ(viewer.next("world").at("world"), "arena");
  scene = viewer.next("scene");
  EXPECT_EQ(scene.at("paused"), false);
  EXPECT_NEAR(scene.at("robots").at(0).at("radius").get<double>(), 0.26, 0.05);
}

// Those that are shipped, those beside the given file, and no others.
TEST(View, OwnWorldsAreBesideTheGivenOne) {
  const test::TempDir folder, elsewhere;
  const auto write = [](const std::string& path, const char* text) {
    std::ofstream(path) << text << "\n";
  };
  constexpr const char* kRoom =
      "width 9000 height 9000 0 0 9000 0 9000 0 9000 9000 9000 9000 0 9000 0 9000 0 0\n"
      "position 2000 2000 0";
  write(folder.path("mine.wld"), kRoom);
  write(folder.path("arena.wld"), kRoom);
  write(folder.path("notes.txt"), kRoom);
  write(elsewhere.path("other.wld"), kRoom);
  HostOptions options;
  options.world = folder.path("mine.wld");
  options.robot = test::source("config/robots/pioneer.p");
  options.socket = folder.path("robot");
  options.view_socket = folder.path("view");
  offer_files(options, test::source("config"));
  Host host(options);
  Viewer viewer(host, folder.path("view"));
  const json world = viewer.next("world");
  const auto names = world.at("worlds").get<std::vector<std::string>>();
  const auto offered = [&](const char* name) {
    return std::ranges::count(names, std::string(name));
  };
  EXPECT_EQ(offered("mine"), 1);
  EXPECT_EQ(offered("arena"), 1);
  EXPECT_EQ(offered("office"), 1);
  EXPECT_EQ(offered("notes") + offered("other"), 0);
  viewer.say(R"({"do":"load","world":"office"})");
  EXPECT_EQ(viewer.next("world").at("world"), "office");
  for (const char* const name : {"other", "notes.txt", "mine.wld", ".."}) {
    viewer.say(R"({"do":"load","world":")" + std::string(name) + "\"}");
    EXPECT_NE(viewer.next("trouble").at("text").get<std::string>().find("expected one of"),
              std::string::npos);
  }
  viewer.say(R"({"do":"load","world":"arena"})");
  EXPECT_EQ(viewer.next("world").at("width"), 9.0) << "the own one comes first";
  write(folder.path("new.wld"), kRoom);
  viewer.say(R"({"do":"files"})");
  const json files = viewer.next("files");
  const auto worlds = files.at("worlds").get<std::vector<std::string>>();
  EXPECT_EQ(std::ranges::count(worlds, std::string("new")), 1);
  EXPECT_FALSE(files.at("robots").empty());
  Viewer later(host, folder.path("view"));
  EXPECT_EQ(later.next("world").at("worlds"), files.at("worlds"));
  viewer.say(R"({"do":"load","world":"new"})");
  EXPECT_EQ(viewer.next("world").at("world"), "new");
}

}  // namespace
}  // namespace saphira::sim
