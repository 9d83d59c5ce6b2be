#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iostream>

#include "drive/drive.hpp"
#include "saphira/base/places.hpp"
#include "saphira/explore/explorer.hpp"
#include "saphira/interpretation/interpretation.hpp"
#include "saphira/lps/point.hpp"
#include "saphira/maps/drawing.hpp"
#include "saphira/registration/map_builder.hpp"

namespace saphira::explore {
namespace {

using test::Drive;
using test::DriveOptions;

struct Built {
  maps::Map map;
  std::vector<Vec2> way;
  std::vector<Vec2> true_way;  ///< in the frame of the built map
  std::uint64_t cycles = 0;
  int contacts = 0;
  int closures = 0;
  int given_up = 0;
  bool done = false;
  double worst = 0.0;  ///< [m] pose by the map against the truth
};

Built build(const std::string& world, std::uint64_t seed, double errors, std::uint64_t limit,
            bool snap = true) {
  DriveOptions options;
  options.world = world;
  options.seed = seed;
  options.errors = errors;
  Drive drive(options);
  interpretation::Settings seeing;
  seeing.sonars = drive.mounts();
  interpretation::Interpretation interpretation(seeing);
  registration::MapBuilderSettings building;
  building.sonars = drive.mounts();
  building.snap_to_right_angle_grid = snap;
  const Pose start = drive.seen().true_pose_in_world;
  registration::MapBuilder builder(building, {}, start);
  Settings exploring;
  exploring.sonars = drive.mounts();
  Explorer explorer(exploring);

  Built built;
  const bool talk = std::getenv("SAPHIRA_TALK") != nullptr;
  std::string said;
  while (!explorer.output().done && built.cycles < limit) {
    const test::Seen& seen = drive.advance();
    ++built.cycles;
    const auto& output = interpretation.step({seen.cycle, seen.pose_in_odom, seen.readings});
    builder.step({seen.cycle, 1, seen.pose_in_odom, output.percepts, seen.readings, std::nullopt});
    const std::vector<Vec2> way = builder.way();
    const Output& order =
        explorer.step({seen.cycle, builder.pose_in_map(), builder.map(), way, seen.readings});
    if (order.point_in_map)
      drive.go_to(
          transform(seen.pose_in_odom, to_frame(builder.pose_in_map(), *order.point_in_map)),
          order.speed);
    else if (order.look_at)
      drive.turn_to(
          seen.pose_in_odom.th +
          lps::phi(relative(builder.pose_in_map(), {order.look_at->x(), order.look_at->y(), 0.0})));
    else
      drive.stop();
    built.true_way.push_back(seen.true_pose_in_world.position());
    built.worst =
        std::max(built.worst,
                 (seen.true_pose_in_world.position() - builder.pose_in_map().position()).norm());
    if (talk && order.reason != said) {
      said = order.reason;
      std::cout << seen.cycle << " at " << seen.true_pose_in_world.position().transpose()
                << " believed " << builder.pose_in_map().position().transpose() << ": " << said
                << std::endl;
      for (const auto& f : output.percepts)
        if (std::getenv("SAPHIRA_PERCEPTS"))
          std::cout << "   " << f.id << " type " << static_cast<int>(f.type) << " side "
                    << static_cast<int>(f.side) << " at "
                    << compose(builder.pose_in_map(), relative(seen.pose_in_odom, f.pose_in_odom))
                           .position()
                           .transpose()
                    << " th " << degrees(f.pose_in_odom.th) << " l " << f.length << " w " << f.width
                    << " conf " << f.confidence << " sa " << f.sigma_across << " sh "
                    << degrees(f.sigma_heading) << "\n";
    }
  }
  built.map = builder.map();
  built.way = builder.way();
  built.contacts = drive.contacts();
  built.closures = builder.closures();
  built.given_up = explorer.given_up();
  built.done = explorer.output().done;
  if (const char* folder = std::getenv("SAPHIRA_DRAW_TO")) {
    maps::Drawing drawing;
    drawing.map = built.map;
    drawing.title = world + ", built";
    for (const sim::Segment& wall : drive.world().segments) {
      drawing.lines.push_back(wall.from);
      drawing.lines.push_back(wall.to);
    }
    drawing.trajectories = {{"true", built.true_way}, {"believed", built.way}};
    std::ofstream(std::string(folder) + "/" + world + ".svg") << maps::to_svg(drawing);
    std::ofstream(std::string(folder) + "/" + world + ".map") << maps::to_text(built.map);
  }
  return built;
}

TEST(Explore, Loop) {
  const Built built = build("loop", 1, 1.0, 8000);
  std::cout << built.cycles << " cycles, contacts " << built.contacts << ", closures "
            << built.closures << ", given up " << built.given_up << ", worst " << built.worst
            << "\n"
            << maps::to_text(built.map);
  EXPECT_TRUE(built.done);
}

TEST(Explore, OfficeFloor) {
  const Built built = build("office-floor", 1, 1.0, 20000);
  std::cout << built.cycles << " cycles, contacts " << built.contacts << ", closures "
            << built.closures << ", given up " << built.given_up << ", worst " << built.worst
            << "\n"
            << maps::to_text(built.map);
  EXPECT_TRUE(built.done);
}

}  // namespace
}  // namespace saphira::explore
