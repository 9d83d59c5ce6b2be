#include "mapping.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driving.hpp"
#include "saphira/base/format.hpp"
#include "saphira/explore/explorer.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::intentions {
namespace {

constexpr double kRadius = 0.2;  ///< [m] the target moves on before the robot reaches it
/// [m] With KeepOff's own 0.36 less is explored: 0.92 of 70 generated floors, where it is 0.95.
constexpr double kBerth = 0.28;
constexpr double kAligned = 0.05;  ///< [rad] tolerance of a heading that the explorer asks for
constexpr double kWayStep = 0.4;   ///< [m] between stored places of the way
constexpr double kOverlap = 0.2;   ///< [m] of a lane beyond its ends, with the next one
constexpr std::size_t kMostLanes = 60;
constexpr double kSamePoint = 0.02;  ///< [m]

/// The explorer gives the target, cycle by cycle.
class ExploreUnknown : public Activity {
 public:
  explicit ExploreUnknown(const Arguments& arguments) : speed_(find(arguments, "speed")->number) {}

  void step(Self& self) override {
    if (self.state() == IntentionState::kInterrupted) {
      driving_to_.reset();
      return;
    }
    const World& world = self.world();
    const std::optional<Pose> pose_in_map = world.robot_in_map();
    self.intend_behavior("Stop", "Stop", kRest, {});
    if (!pose_in_map || world.around.map == nullptr || world.around.lps == nullptr ||
        world.around.readings == nullptr) {
      stand(self);
      self.say("waits for the map, and to know where it is on it");
      return;
    }
    if (!explorer_) {
      explore::Settings settings;
      settings.sonars = world.around.lps->settings().sonars;
      settings.speed = speed_;
      explorer_.emplace(std::move(settings));
    }
    remember(pose_in_map->position());
    const explore::Output& next =
        explorer_->step({static_cast<std::uint64_t>(world.now), *pose_in_map, *world.around.map,
                         way_, *world.around.readings});
    self.say(next.reason);
    if (explorer_->in_room() && !free_walls_) {
      free_walls_ = true;
      self.request({"snap", {truth("on", false)}});
    }
    if (next.done) {
      stand(self);
      const std::vector<std::string> left = explorer_->left(*world.around.map);
      if (explorer_->in_room())
        lay_lanes(self);
      else if (left.empty())
        self.succeed(next.reason);
      else
        self.fail(
            v1::CODE_BLOCKED,
            "not all of the floor could be explored: " + left.front() +
                (left.size() == 1 ? "" : " and " + std::to_string(left.size() - 1) + " more"));
      return;
    }
    if (next.look_at)
      turn(self, *next.look_at);
    else if (next.point_in_map)
      drive(self, *next.point_in_map, next.speed);
    else
      stand(self);
  }

  void archive(Archive& a) override {
    a("speed", speed_)("explorer", explorer_)("way", way_)("driving_to", driving_to_)(
        "turning", turning_)("free_walls", free_walls_)("lanes", lanes_)("places", places_);
  }

 private:
  void stand(Self& self) {
    for (const char* const behavior : {"AvoidCollision", "KeepOff", "GoToPos", "TurnTo"})
      self.drop_behavior(behavior);
    driving_to_.reset();
  }

  /// The ways over the free floor become lanes of the map, from one place to the next: one place a
  /// cycle.
  void lay_lanes(Self& self) {
    const explore::FreeFloor& floor = explorer_->floor();
    const std::vector<explore::Lane> more = floor.next_lanes(explorer_->start(), lanes_);
    if (more.empty() || lanes_.size() > kMostLanes) {
      tell_floor(self, floor.area());
      return;
    }
    for (const explore::Lane& lane : more) {
      const Vec2 way = lane.to - lane.from;
      const Vec2 middle = (lane.from + lane.to) / 2;
      put(self, "LANE", {middle.x(), middle.y(), std::atan2(way.y(), way.x())},
          {number("length", way.norm() + 2 * kOverlap), number("width", lane.width)});
      lanes_.push_back(lane);
    }
    const Vec2& place = more.back().to;
    put(self, "POS", {place.x(), place.y(), 0.0},
        {text("name", "place-" + std::to_string(++places_))});
  }

  static void put(Self& self, const std::string& type, const Pose& pose_in_map, Arguments more) {
    more.push_back(text("type", type));
    more.push_back(saphira::point("position", pose_in_map, Frame::map));
    more.push_back(truth("learned", true));
    self.request({"put", std::move(more)});
  }

  void tell_floor(Self& self, double area) {
    const auto& found = self.world().around.map->features;
    const auto walls = std::count_if(found.begin(), found.end(), [](const maps::Feature& one) {
      return one.type == lps::PointType::wall;
    });
    if (walls == 0 || lanes_.empty())
      self.fail(
          v1::CODE_ACTIVITY,
          saphira::format("nothing could be mapped in %.0f m of way: no corridor and no wall was "
                          "found, and %.0f m2 of free floor",
                          way_length(), area));
    else
      self.succeed(saphira::format(
          "no corridor: a room of %.0f m2 of free floor, %d walls, %d places to go "
          "to and %d lanes between them%s",
          area, static_cast<int>(walls), places_, static_cast<int>(lanes_.size()),
          lanes_.size() > kMostLanes ? "; the rest of the floor has no lanes"
          : explorer_->floor().goes_on()
              ? saphira::format("; it goes on beyond %.0f m from the start, which is not mapped",
                                explore::FreeFloor::kReach)
                    .c_str()
              : ""));
  }

  void turn(Self& self, const Vec2& to) {
    for (const char* const behavior : {"AvoidCollision", "KeepOff", "GoToPos"})
      self.drop_behavior(behavior);
    if (aim(self, to))
      self.intend_behavior("TurnTo", "TurnTo", kTask,
                           {point("goal", *driving_to_), number("success_angle", kAligned)});
  }

  void drive(Self& self, const Vec2& to, double speed) {
    self.drop_behavior("TurnTo");
    self.intend_behavior("AvoidCollision", "AvoidCollision", kAvoid, {});
    self.intend_behavior("KeepOff", "KeepOff", kKeepOff, {number("berth", kBerth)});
    if (aim(self, to))
      self.intend_behavior(
          "GoToPos", "GoToPos", kTask,
          {point("goal", *driving_to_), number("speed", speed), number("radius", kRadius)});
  }

  /// True where that differs from the behavior's target.
  bool aim(const Self& self, const Vec2& to) {
    const Pose there = relative(*self.robot().odom_in_map, {to.x(), to.y(), 0.0});
    const bool turns = explorer_->output().look_at.has_value();
    if (driving_to_ && turns == turning_ &&
        (driving_to_->position() - there.position()).norm() < kSamePoint)
      return false;
    turning_ = turns;
    driving_to_ = there;
    return true;
  }

  double way_length() const {
    double length = 0.0;
    for (std::size_t i = 1; i < way_.size(); ++i)
      length += (way_[i] - way_[i - 1]).norm();
    return length;
  }

  /// Stores places of the way at a distance from each other, and the present one.
  void remember(const Vec2& here) {
    if (way_.size() > 1 && (way_.back() - way_[way_.size() - 2]).norm() < kWayStep)
      way_.back() = here;
    else
      way_.push_back(here);
  }

  double speed_;
  std::optional<explore::Explorer> explorer_;
  std::vector<Vec2> way_;  ///< [map]
  std::optional<Pose> driving_to_;
  bool turning_ = false;
  bool free_walls_ = false;  ///< walls need not follow a grid of right angles
  std::vector<explore::Lane> lanes_;
  int places_ = 0;
};

}  // namespace

Schema explore_unknown() {
  Schema schema;
  schema.name = "explore_unknown";
  schema.summary = "drives to where the map ends, until nothing is left";
  schema.parameters = {quantity("speed", "m/s", 0.05, 1.0, 0.3)};
  schema.make = [](const Arguments& arguments) -> std::unique_ptr<Activity> {
    return std::make_unique<ExploreUnknown>(arguments);
  };
  return schema;
}

void add_mapping(Functions& functions) {
  functions.add(Action{"forget-map", 0, 0,
                       [](Effects& effects, Values) {
                         effects.request({"delete"});
                         return Value();
                       },
                       "(forget-map): registration begins with an empty map"});
  functions.add(Action{"add-features", 1, 1,
                       [](Effects& effects, Values arguments) {
                         effects.believe_while(kGrowsMap, arguments[0]);
                         return arguments[0];
                       },
                       "(add-features T): true while registration adds features to the map, until "
                       "this intention ends"});
  functions.add(
      "adds-features", "true while registration adds features to the map",
      [](const World& world) { return Value::truth(world.around.registration.adds_features); });
  functions.add(
      "map-has-lanes", "whether the map has ways over free floor", [](const World& world) {
        const maps::Map* const map = world.around.map.get();
        return Value::truth(
            map != nullptr &&
            std::any_of(map->features.begin(), map->features.end(),
                        [](const maps::Feature& one) { return one.type == lps::PointType::lane; }));
      });
  functions.add("map-size", "how many artifacts the map has", [](const World& world) {
    return Value(
        world.around.map == nullptr ? 0.0 : static_cast<double>(world.around.map->features.size()));
  });
}

}  // namespace saphira::intentions
