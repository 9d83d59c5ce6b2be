#include "saphira/registration/presence.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace saphira::registration {
namespace {

using lps::PointType;
using Ids = std::vector<std::uint32_t>;

maps::Feature feature(PointType type, std::uint32_t id, const Pose& pose, double length,
                      double width, bool learned = false) {
  maps::Feature made;
  made.type = type;
  made.id = id;
  made.pose_in_map = pose;
  made.length = length;
  made.width = width;
  made.learned = learned;
  return made;
}

// The robot drives along y = 0 and passes artifacts at y = 1.
maps::Map a_map() {
  return {{feature(PointType::wall, 1, {2.0, 1.0, 0.0}, 1.0, 0.0),
           feature(PointType::wall, 2, {6.0, 1.0, 0.0}, 1.5, 0.0, true),
           feature(PointType::object, 7, {2.0, 1.2, 0.0}, 0.6, 0.5),
           feature(PointType::door, 9, {10.0, 1.0, -kPi / 2}, 0.0, 0.9)}};
}

class PresenceTest : public testing::Test {
 protected:
  /// Passes `x` once with three sonars to the left, with echoes at that distance from the way.
  Presence::Changes pass(double x, double distance, bool echo = true) {
    Presence::Changes all;
    for (double at = x - 2.0; at < x + 2.0; at += 0.03) {
      std::vector<Look> looks;
      for (const double bearing : {70.0, 90.0, 110.0})
        looks.push_back({{at, 0.0, radians(bearing)}, distance / std::sin(radians(bearing)), echo});
      take(presence.step(map, ++cycle, {at, 0.0}, looks, {}), all);
    }
    return all;
  }
  Presence::Changes stand(double x, double distance, int cycles) {
    Presence::Changes all;
    for (int i = 0; i < cycles; ++i)
      take(presence.step(map, ++cycle, {x, 0.0}, {{{x, 0.0, kPi / 2}, distance, true}}, {}), all);
    return all;
  }

  maps::Map map = a_map();
  Presence presence;
  std::uint64_t cycle = 0;

 private:
  void take(const Presence::Changes& changes, Presence::Changes& all) {
    for (const std::uint32_t id : changes.gone)
      std::erase_if(map.features, [id](const maps::Feature& each) { return each.id == id; });
    all.gone.insert(all.gone.end(), changes.gone.begin(), changes.gone.end());
    all.closed.insert(all.closed.end(), changes.closed.begin(), changes.closed.end());
    all.opened.insert(all.opened.end(), changes.opened.begin(), changes.opened.end());
  }
};

TEST_F(PresenceTest, AThingThatSoundGoesThroughIsGoneAndAWallThatAPersonWroteIsNot) {
  EXPECT_EQ(pass(2.0, 2.4).gone, Ids{7});
  EXPECT_TRUE(pass(2.0, 2.4).empty());
}

TEST_F(PresenceTest, AWallThatTheRobotPutDownIsGoneToo) {
  EXPECT_EQ(pass(6.0, 2.4).gone, Ids{2});
}

TEST_F(PresenceTest, WhatIsHeardStays) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(pass(2.0, 0.95).empty());
    EXPECT_TRUE(pass(6.0, 1.0).empty());
  }
}

TEST_F(PresenceTest, SilenceAndWhatStandsBeforeItSayNothing) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(pass(2.0, 2.4, false).empty());
    EXPECT_TRUE(pass(2.0, 0.4).empty());
    EXPECT_TRUE(pass(10.0, 0.4).empty());
  }
}

TEST_F(PresenceTest, WhatIsMissedFromOnePlaceIsNotGone) {
  EXPECT_TRUE(stand(2.0, 2.4, 1000).empty());
}

TEST_F(PresenceTest, ADoorIsClosedWhereItIsHeardAndOpenWhereWhatIsBehindItIs) {
  EXPECT_EQ(pass(10.0, 1.0).closed, Ids{9});
  EXPECT_EQ(presence.closed(), std::set<std::uint32_t>{9});
  EXPECT_TRUE(pass(10.0, 1.0).empty());
  const Presence::Changes changes = pass(10.0, 3.0);
  EXPECT_EQ(changes.opened, Ids{9});
  EXPECT_TRUE(changes.gone.empty());
  EXPECT_TRUE(presence.closed().empty());
}

TEST_F(PresenceTest, WhoStandsBeforeADoorSeesItClosedAndOpen) {
  EXPECT_EQ(stand(10.0, 1.0, 100).closed, Ids{9});
  EXPECT_EQ(stand(10.0, 3.0, 100).opened, Ids{9});
}

TEST_F(PresenceTest, ADoorThatIsSeenIsOpen) {
  pass(10.0, 1.0);
  const Presence::Changes changes = presence.step(map, ++cycle, {10.0, 0.0}, {}, {9});
  EXPECT_EQ(changes.opened, Ids{9});
}

TEST_F(PresenceTest, ADoorPostIsNoClosedDoor) {
  for (int i = 0; i < 5; ++i)
    for (const double x : {9.6, 10.4})
      EXPECT_TRUE(stand(x, 1.0, 100).empty());
}

TEST_F(PresenceTest, ABreakThatIsAWallIsGoneWhereTheRobotPutItDown) {
  map = {{feature(PointType::breach, 4, {2.0, 1.0, -kPi / 2}, 0.0, 1.2, true),
          feature(PointType::breach, 5, {2.0, 1.0, -kPi / 2}, 0.0, 1.2)}};
  Ids gone;
  for (double x = 1.6; x < 2.4; x += 0.1)
    for (const std::uint32_t id :
         presence.step(map, ++cycle, {x, 0.0}, {{{x, 0.0, kPi / 2}, 1.0, true}}, {}).gone) {
      gone.push_back(id);
      std::erase_if(map.features, [id](const maps::Feature& each) { return each.id == id; });
    }
  EXPECT_EQ(gone, Ids{4});
}

}  // namespace
}  // namespace saphira::registration
