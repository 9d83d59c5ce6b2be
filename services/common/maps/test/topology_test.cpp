#include "saphira/maps/topology.hpp"

#include <gtest/gtest.h>

#include "saphira/base/places.hpp"

namespace saphira::maps {
namespace {

Topology of(const char* text) {
  return Topology(parse_map(text, "test.map"));
}

std::size_t by_id(const Topology& topology, std::uint32_t id) {
  for (std::size_t i = 0; i < topology.regions().size(); ++i)
    if (topology.regions()[i].area.id == id)
      return i;
  ADD_FAILURE() << "no region " << id;
  return 0;
}

bool linked(const Topology& topology, std::uint32_t a, std::uint32_t b) {
  for (const std::size_t i : topology.regions()[by_id(topology, a)].links) {
    const Link& link = topology.links()[i];
    const std::size_t other = by_id(topology, b);
    if (link.a == other || link.b == other)
      return true;
  }
  return false;
}

TEST(Topology, CorridorsThatMeetHaveAJunction) {
  // An L, a T that ends at the near wall, and one that is too far away.
  const Topology t =
      of("CORRIDOR (1) 0, 0, 0, 10000, 2000\n"
         "CORRIDOR (2) 5000, 4000, 90, 8000, 2000\n"
         "CORRIDOR (3) -2000, 4000, 90, 6000, 1600\n"
         "CORRIDOR (4) 0, 9000, 90, 10000, 2000\n");
  ASSERT_EQ(t.regions().size(), 6U);
  const Feature& corner = t.regions()[4].area;
  EXPECT_EQ(t.regions()[4].kind, RegionKind::junction);
  EXPECT_EQ(corner.id, 0U);
  EXPECT_NEAR(corner.pose_in_map.x, 5.0, 1e-9);
  EXPECT_NEAR(corner.pose_in_map.y, 0.0, 1e-9);
  const Feature& tee = t.regions()[5].area;
  EXPECT_NEAR(tee.pose_in_map.x, -2.0, 1e-9);
  EXPECT_NEAR(tee.length, 1.6, 1e-9);
  EXPECT_NEAR(tee.width, 2.0, 1e-9);
  EXPECT_TRUE(t.regions()[3].links.empty());
}

TEST(Topology, CorridorsThatFollowOneAnotherMeet) {
  const Topology t =
      of("CORRIDOR (1) 0, 0, 0, 10000, 2000\n"
         "CORRIDOR (2) 9100, 100, 180, 8000, 2000\n");
  ASSERT_EQ(t.regions().size(), 2U);
  ASSERT_EQ(t.links().size(), 1U);
  EXPECT_NEAR(t.links()[0].pose_in_map.x, 5.05, 0.1);
}

TEST(Topology, ADoorLeadsFromTheRoomIntoTheCorridor) {
  const Topology t =
      of("CORRIDOR (1) 0, 0, 0, 10000, 2000\n"
         "OFFICE (2) 0, 3000, 0, 4000, 3600\n"
         "DOOR (3) 1000, 1100, -90, 900\n"
         "DOOR (4) -3000, 1000, -90, 900\n"
         "DOOR (5) 30000, 1000, -90, 900\n");
  ASSERT_EQ(t.links().size(), 2U);
  EXPECT_EQ(t.links()[0].kind, LinkKind::door);
  EXPECT_EQ(t.regions()[t.links()[0].a].area.id, 1U);
  ASSERT_TRUE(t.links()[0].b);
  EXPECT_EQ(t.regions()[*t.links()[0].b].area.id, 2U);
  EXPECT_EQ(t.links()[1].id, 4U);
  EXPECT_FALSE(t.links()[1].b) << "nobody knows what is behind it";
}

TEST(Topology, TheOfficeFloor) {
  const Topology t(load_map(config_folder() + "/maps/office-floor.map"));
  // Its junctions are in the map; none is added.
  for (const Region& region : t.regions())
    EXPECT_NE(region.area.id, 0U);
  EXPECT_TRUE(linked(t, 1, 11));
  EXPECT_TRUE(linked(t, 2, 11));
  EXPECT_TRUE(linked(t, 2, 12));
  EXPECT_TRUE(linked(t, 3, 12));
  EXPECT_TRUE(linked(t, 3, 13));
  EXPECT_TRUE(linked(t, 4, 13));
  EXPECT_TRUE(linked(t, 4, 14));
  EXPECT_TRUE(linked(t, 1, 14));
  EXPECT_TRUE(linked(t, 20, 21)) << "two rectangles of the library";
  EXPECT_TRUE(linked(t, 20, 1));
  EXPECT_TRUE(linked(t, 21, 3));
  EXPECT_TRUE(linked(t, 24, 4)) << "the kitchen";
  EXPECT_FALSE(linked(t, 241, 243)) << "a wall between";
  EXPECT_FALSE(linked(t, 1, 2)) << "by their junction only";
  std::size_t doors = 0;
  for (const Link& link : t.links())
    if (link.kind == LinkKind::door) {
      ++doors;
      EXPECT_TRUE(link.b) << link.id;
      EXPECT_EQ(t.regions()[link.a].kind, RegionKind::corridor) << link.id;
    }
  EXPECT_EQ(doors, 27U);
}

TEST(Topology, EveryShippedMapHangsTogether) {
  for (const char* name :
       {"cluttered", "loop", "office", "office-floor", "simple", "small-office", "visitors"}) {
    const Topology t(load_map(config_folder() + "/maps/" + name + ".map"));
    ASSERT_FALSE(t.regions().empty()) << name;
    std::vector<bool> seen(t.regions().size(), false);
    std::vector<std::size_t> open{0};
    while (!open.empty()) {
      const std::size_t region = open.back();
      open.pop_back();
      if (seen[region])
        continue;
      seen[region] = true;
      for (const std::size_t link : t.regions()[region].links) {
        open.push_back(t.links()[link].a);
        if (t.links()[link].b)
          open.push_back(*t.links()[link].b);
      }
    }
    for (std::size_t i = 0; i < seen.size(); ++i)
      EXPECT_TRUE(seen[i]) << name << ": " << t.text(i);
  }
}

TEST(Topology, OfAMapWithoutNamesKindsAndIdsAreShown) {
  const Topology t(
      parse_map("CORRIDOR (1) 0, 0, 0, 10000, 1600\nDOOR (3) 1000, 800, -90, 900\n"
                "POS (4) 0, 0, 0 \"start\"\n"
                "DOOR (5) 3000, 800, -90, 900 \"Karen's office\"\n",
                "built.map"));
  EXPECT_EQ(t.no_place("library"),
            "the map has no place \"library\": it has start, Karen's office, corridor-1, door-3");
  // A named door without a room behind it is a place as well: before the door.
  const std::optional<Place> office = t.place("karen's office");
  ASSERT_TRUE(office);
  EXPECT_EQ(office->name, "door 5");
  ASSERT_TRUE(office->point);
  EXPECT_NEAR((*office->point - Vec2(3.0, 0.2)).norm(), 0.0, 1e-9);
}

TEST(Topology, NamesAreComparedAsPeopleReadThem) {
  const Topology t(parse_map("POS (4) 0, 0, 0 \"B\u00fcro S\u00fcd\"\n", "built.map"));
  for (const char* const said :
       {"B\u00fcro S\u00fcd", "Bu\u0308ro Su\u0308d", "b\u00fcro s\u00fcd", "B\u00dcRO S\u00dcD"})
    EXPECT_TRUE(t.place(said)) << said;
  EXPECT_FALSE(t.place("buro sud"));
  EXPECT_EQ(t.no_place("buro sud"),
            "the map has no place \"buro sud\": did you mean B\u00fcro S\u00fcd?");
}

TEST(Topology, PlacesByNameAndId) {
  const Topology t(load_map(config_folder() + "/maps/office-floor.map"));
  ASSERT_TRUE(t.place("EJ-231"));
  EXPECT_EQ(t.place("EJ-231")->name, "room 231 (EJ-231)");
  ASSERT_TRUE(t.place("ej-231"));
  ASSERT_TRUE(t.place("library"));
  EXPECT_EQ(t.place("library")->regions.size(), 2U);
  ASSERT_TRUE(t.place("start"));
  ASSERT_TRUE(t.place("start")->point);
  EXPECT_NEAR(t.place("start")->point->y(), 14.0, 1e-9);
  ASSERT_TRUE(t.place("1265"));
  for (const char* const door : {"door 1265", "door-1265", "Door 1265", "the door 1265"}) {
    ASSERT_TRUE(t.place(door)) << door;
    EXPECT_EQ(t.place(door)->name, "door 1265");
  }
  ASSERT_TRUE(t.place("corridor-2"));
  EXPECT_EQ(t.place("corridor-2")->name, "corridor 2 (central corridor)");
  EXPECT_FALSE(t.place("corridor-1265"));
  EXPECT_FALSE(t.place("door 126"));
  EXPECT_EQ(t.place("1265")->name, "door 1265");
  EXPECT_NEAR(t.place("1265")->point->y(), 6.6, 1e-9) << "before the door, in the corridor";
  EXPECT_FALSE(t.place("EJ-999"));
  EXPECT_FALSE(t.place(""));
}

TEST(Topology, ThingsThatAreCarriedAboutLeaveThePlacesAsTheyAre) {
  const Map before =
      parse_map("CORRIDOR (1) 0, 0, 0, 9000, 2000\nDOOR (3) 0, 1000, -90, 900\n", "m");
  Map after = before;
  after.features.insert(after.features.begin(),
                        {lps::PointType::object, 7, {2.0, 0.5, 0.0}, 0.5, 0.4, ""});
  EXPECT_TRUE(same_places(before, after));
  EXPECT_TRUE(same_places(after, before));
  after.features.back().pose_in_map.x += 0.1;
  EXPECT_FALSE(same_places(before, after));
  after.features.pop_back();
  EXPECT_FALSE(same_places(before, after));
  EXPECT_FALSE(same_places(after, before));
  EXPECT_TRUE(same_places({}, {}));
}

TEST(Topology, SaysWhatIsOutsideOfTheMap) {
  const Map map =
      parse_map("CORRIDOR (1) 5000, 0, 0, 10000, 2000\nWALL 5000, 4000, 0, 1000\n", "m");
  EXPECT_FALSE(outside(map, {5.0, 2.5}, 1.0));
  EXPECT_FALSE(outside(map, {10.9, -1.9}, 1.0));
  EXPECT_EQ(outside(map, {5.0, 5.5}, 1.0),
            "expected a place on the map, which goes from (0, -1) to (10, 4) m, got (5, "
            "5.5)");
  EXPECT_TRUE(outside(map, {-1.1, 0.0}, 1.0));
  EXPECT_FALSE(outside({}, {500.0, 0.0}, 1.0));
}

TEST(Topology, WhereAPositionIs) {
  const Topology t(load_map(config_folder() + "/maps/office-floor.map"));
  EXPECT_EQ(t.text(*t.region_at({17.5, 7.0})), "junction 12");
  EXPECT_EQ(t.text(*t.region_at({30.0, 7.0})), "corridor 3 (lower corridor)");
  EXPECT_FALSE(t.region_at({23.5, 20.0}, 0.5)) << "between the offices and the east corridor";
  EXPECT_EQ(t.text(*t.region_at({22.7, 20.0}, 0.5)), "room 244 (EJ-244)");
}

}  // namespace
}  // namespace saphira::maps
