#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/protocol/parameters.hpp"
#include "saphira/sim/grid.hpp"
#include "saphira/sim/movable.hpp"
#include "saphira/sim/robot.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::sim {

/// The robot that looks or moves, in a scene, so that it does not detect itself.
using RobotNumber = std::size_t;
inline constexpr RobotNumber kNobody = std::numeric_limits<RobotNumber>::max();

struct Person {
  const PersonPlan* plan = nullptr;
  Vec2 at{0.0, 0.0};
  double heading = 0.0;  ///< [rad] of his view
  double way = 0.0;      ///< [m] walked since he last stood; 0: stands
  std::size_t leg = 0;   ///< of the script
  double waited = 0.0;   ///< [s] in this leg
  Vec2 from{0.0, 0.0};   ///< where this leg began
  bool aside = false;    ///< beside the straight line of this leg, past a robot
  struct Refuge {
    Vec2 at{0.0, 0.0};
    double stay = 0.0;  ///< [s] there
  };
  std::optional<Refuge> refuge{};  ///< goes there, to let a robot pass
  std::vector<Vec2> back = {};  ///< from the line of his leg to where he is, by way of his refuges
  int yielded = 0;              ///< times in this leg
  /// [rad] Direction of an outstretched arm, in the world.
  std::optional<double> points{};
};

/// A person's outstretched arm, from the shoulder to the hand; none without a direction.
std::optional<Segment> arm(const Person& person);

struct Door {
  const DoorPlan* plan = nullptr;
  double angle = 0.0;     ///< [rad] 0: closed
  bool opens = false;     ///< or is open
  std::size_t event = 0;  ///< the next one of the schedule
  double since = 0.0;     ///< [s] start of this round of the schedule
};

struct Box {
  const BoxPlan* plan = nullptr;
  Pose pose_in_world;
};

/// A lower leg of a person: while the person walks, one stands on the floor and the other swings.
struct Shin {
  Disc disc;
  bool swings = false;
};
std::array<Shin, 2> shins(const Person& person);

/// The reflection of sonar sound by a moving or movable thing.
struct Surface {
  double loss = 0.0;     ///< [dB] absorbed by its material
  bool swings = false;   ///< tilts to and fro: answers at most half of the time
  std::uint32_t id = 0;  ///< of the thing; those of a segment's ends follow
};

/// The moving things for a sonar.
struct Echoes {
  Things things;
  std::vector<Surface> segments;  ///< of things.segments; the rest are walls
  std::vector<Surface> discs;     ///< of things.discs
};

/// A sonar's firing.
struct Ping {
  RobotNumber robot = kNobody;
  std::uint64_t tick = 0;
  Vec2 origin{0.0, 0.0};
  Vec2 ahead{1.0, 0.0};
};

/// A world and its moving things: people, doors, boxes, robots. People walk by their scripts. They
/// push closed doors open. Where a robot stands or comes in their way they pass beside it; without
/// room they step out of its way or go back, and before a box they wait. Stubborn people wait for
/// four seconds and go on to the next place of the script. Doors stop where a person stands in
/// their way; robots push boxes. One tick() moves everything by one tick of time, always in the
/// same order, so that a scene is the same to the last bit in every run.
class Scene {
 public:
  /// The world outlives the scene.
  explicit Scene(const World& world);
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Adds a robot, which stays at its address. std::invalid_argument where it would touch an
  /// obstacle.
  Robot& add_robot(const protocol::RobotParameters& parameters, const Pose& start_in_world,
                   std::uint64_t seed);

  void tick();
  std::uint64_t ticks() const { return ticks_; }  ///< since the beginning

  const World& world() const { return *world_; }
  std::size_t robots() const { return robots_.size(); }
  const Robot& robot(RobotNumber number) const { return *robots_[number]; }
  Robot& robot(RobotNumber number) { return *robots_[number]; }

  const std::vector<Person>& persons() const { return persons_; }
  const std::vector<Door>& doors() const { return doors_; }
  const std::vector<Box>& boxes() const { return boxes_; }
  Segment leaf(const Door& door) const { return leaf(door, door.angle); }
  std::array<Segment, 4> sides(const Box& box) const { return outline(box, box.pose_in_world); }
  /// Opens or closes a door; its schedule goes on. False for an unknown door.
  bool set_door(std::string_view name, bool open);
  /// A person carries a box elsewhere. False for an unknown box, or where the place is taken.
  bool set_box(std::string_view name, const Pose& pose_in_world);
  /// A person is at once elsewhere; their script goes on. False likewise.
  bool set_person(std::string_view name, const Vec2& at);
  /// A person stretches out an arm, or lowers it, until the script goes on. False for an unknown
  /// person.
  bool set_arm(std::string_view name, std::optional<double> direction_in_world);

  /// A sonar has fired; those of a single robot in a scene are not stored.
  void sound(const Ping& ping);
  /// The firings whose sound may still be on its way, and some older ones.
  const std::vector<Ping>& pings() const { return pings_; }

  /// Adds the movable things (and posts) within `reach` of `point`, and some beyond, to `things`;
  /// without the robot `but`.
  void add_movable(const Vec2& point, double reach, RobotNumber but, Things& things) const;
  /// The same for sonars, at the height of a robot's ring: of a person the legs, whose clothes
  /// absorb `cloth` [dB] unless the world says otherwise.
  void add_echoes(const Vec2& point, double reach, RobotNumber but, double cloth,
                  Echoes& echoes) const;
  /// True where there is a movable thing besides the robot `but`.
  bool has_movable(RobotNumber but) const {
    return !segments_.empty() || !persons_.empty() || !posts_.empty() ||
           robots_.size() > (but == kNobody ? 0U : 1U);
  }
  /// The speed limit of all movable points [m/s].
  double fastest() const { return fastest_; }

  /// From `point` to the nearest thing of any kind [m]; without the robot `but`.
  double distance(const Vec2& point, RobotNumber but = kNobody) const;
  /// The nearest thing, in words, such as "robot 1" or "a wall".
  std::string nearest(const Vec2& point) const;

 private:
  friend class Robot;
  void moved(RobotNumber number);
  /// A robot's hull at `centre` presses forward by `way`: true where a box has given way.
  bool push(RobotNumber number, const Vec2& centre, const Vec2& way);
  void put(std::size_t box, const Pose& pose_in_world);

  void walk(Person& person);
  void next_leg(Person& person);
  bool has_robot_within(double reach, const Vec2& point) const;
  bool has_robot_ahead(const Person& person) const;
  std::optional<Vec2> next_place(Person& person) const;
  std::optional<Vec2> way_past(const Person& person, const Vec2& aim, const Vec2& target) const;
  Person::Refuge refuge(const Person& person) const;
  double room(const Person& person, const Vec2& at) const;
  double room_but_robots(const Person& person, const Vec2& at) const;
  bool is_free(const Person& person, const Vec2& to) const;
  bool lets_pass(const Person& person, const Vec2& to);
  void turn(std::size_t door);
  bool is_free(std::size_t box, const Pose& pose_in_world, RobotNumber pusher) const;
  static Segment leaf(const Door& door, double angle);
  static std::array<Segment, 4> outline(const Box& box, const Pose& pose_in_world);

  const World* world_;
  std::vector<std::unique_ptr<Robot>> robots_;
  std::vector<Disc> hulls_;  // of the robots, by number
  Grid hulls_near_;
  double widest_hull_ = 0.0;  // [m] radius
  std::vector<Person> persons_;
  Grid persons_near_;
  double widest_person_ = 0.0;
  std::vector<Door> doors_;
  std::vector<Box> boxes_;
  std::vector<Disc> posts_;
  std::vector<Segment> segments_;  // each door's leaf, then the four sides of each box
  std::vector<Ping> pings_;
  double fastest_ = 0.0;
  std::uint64_t ticks_ = 0;
};

}  // namespace saphira::sim
