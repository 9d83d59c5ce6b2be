#include "following.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "driving.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/intentions/activity.hpp"
#include "seeing.hpp"

namespace saphira::intentions {
namespace {

constexpr double kStride = 0.2;     // [m] between places of a trail
constexpr double kLookAhead = 0.8;  // [m] to the place of the trail that the robot heads for...
constexpr double kAlong = 1.0;      // [m] ...where the person in sight has walked straight on
constexpr double kBefore = 0.5;     // of the distance to the person: it is that far before them
constexpr double kAtEnd = 0.3;      // [m]
constexpr double kFast = 0.05;      // [m] radius of a place to which the robot does not slow down
constexpr double kStands = 10.0;    // [m] radius of a place that it only faces
constexpr double kPlaced = 0.3;     // [s] since the person was seen: a place, not a guess
constexpr double kFollowed = 1.0;   // [s] since then
constexpr Ticks kWaits = 30;        // for the first sight of a person
constexpr double kInPicture = radians(15.0);  // from straight ahead, of the 30 that cameras see

/// [rad] From the robot, between two places.
double between(const Vec2& one, const Vec2& other) {
  return std::abs(norm2_angle(std::atan2(one.y(), one.x()) - std::atan2(other.y(), other.x())));
}

class Follow : public Activity {
 public:
  explicit Follow(const Arguments& arguments) { change(arguments); }

  bool change(const Arguments& arguments) override {
    distance_ = find(arguments, "distance")->number;
    speed_ = find(arguments, "speed")->number;
    const Argument* const place = find(arguments, "place");
    place_ = place == nullptr ? std::nullopt : std::optional(Point{place->point, place->frame});
    return true;
  }

  void step(Self& self) override {
    if (self.state() == IntentionState::kInterrupted)
      return;
    const World& world = self.world();
    auto& [who, trail, went, waits] = now_;
    const std::size_t places = trail.places();
    if (!who)
      if (const std::optional<Value> found =
              nearest_seen(world, "person",
                           place_ ? in_frame(place_->pose, place_->frame, Frame::odom, world.robot)
                                  : std::nullopt))
        if (const Reference* const person = found->reference())
          who = person->id;
    if (!who) {
      self.level(0.0);
      self.say("waiting until it sees a person");
      if (++waits > kWaits)
        self.fail(v1::CODE_NONE, world.around.things == nullptr
                                     ? "the robot has no camera, or nobody looks at its pictures"
                                     : "no person is to be seen");
      return;
    }
    const lps::SeenThing* const thing = who ? seen_thing(world, *who) : nullptr;
    const double unseen = thing == nullptr ? kFollowed + 1.0 : seconds_unseen(world, *thing);
    const bool in_sight = unseen <= kFollowed;
    if (unseen <= kPlaced) {
      trail.add(thing->pose_in_odom.position());
      went = thing->velocity_in_odom;
    }
    const Vec2 robot = self.robot().pose_in_odom.position();
    trail.reach(robot);
    const double left = trail.length();
    const Vec2 to_end = trail.at(left) - robot;
    const double near = in_sight ? distance_ : kAtEnd;
    // The trail of a person who comes back is longer than the straight way.
    const bool there = left <= near || (in_sight && to_end.norm() <= near);
    const bool straight = in_sight && between(trail.at(kLookAhead) - robot,
                                              trail.at(2.0 * kLookAhead) - robot) < kInPicture;
    // The goal lies short of the person: KeepOff steers around any obstacle on the way to a goal.
    double ahead = in_sight ? std::min(straight ? kAlong : kLookAhead, left - kBefore * distance_)
                            : std::min(left, kLookAhead);
    // Fixed cameras keep a person in the picture who walks around a corner.
    while (in_sight && world.around.head_reach == 0.0 && ahead < left &&
           between(trail.at(ahead) - robot, to_end) > kInPicture)
      ahead += kStride;
    Vec2 goal = trail.at(there ? left : ahead);
    // At the end of the trail the robot faces where the person has gone.
    if (there && !in_sight)
      goal = thing != nullptr ? thing->pose_in_odom.position() : Vec2(goal + kStands * went);
    const double pace =
        in_sight ? thing->velocity_in_odom.dot(to_end.normalized()) + left - near : left;
    self.intend_behavior("track", "AttendAtPos", kTask,
                         {point("goal", {goal.x(), goal.y(), 0.0}, Frame::odom),
                          number("radius", there      ? kStands
                                           : straight ? kFast
                                                      : kAtEnd),
                          number("speed", std::min(speed_, std::max(kSlow, pace)))});
    self.level(there ? 1.0 : 0.0);
    self.say(in_sight ? "following a person" : "going where it saw a person last");
    if (trail.places() != places)
      self.moved_on();
  }
  void archive(Archive& a) override {
    a("distance", distance_)("speed", speed_)("place", place_)("now", now_);
  }
  bool keeps_progress() const override { return true; }

 private:
  static constexpr double kSlow = 0.05;  // [m/s]

  double distance_ = 0.0;
  double speed_ = 0.0;
  std::optional<Point> place_;  ///< of the person at the beginning
  struct Now {
    std::optional<std::uint64_t> who;
    Trail trail;
    Vec2 went{0.0, 0.0};  ///< [m/s] where the person was seen last
    Ticks waits = 0;      ///< for the first sight of somebody
  };
  Now now_;
};

}  // namespace

void Trail::add(const Vec2& place) {
  // The last place goes with the person until it is a stride away from the one before.
  if (places_.size() >= 2 && (places_.back() - places_[places_.size() - 2]).norm() < kStride)
    places_.back() = place;
  else
    places_.push_back(place);
}

void Trail::reach(const Vec2& robot) {
  robot_ = robot;
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (const double off = (places_[i] - robot).norm(); off < least) {
      least = off;
      nearest = i;
    }
  if (places_.size() > 1)
    places_.erase(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                         nearest + (least < kLookAhead ? 1 : 0),
                                                         places_.size() - 1)));
}

double Trail::length() const {
  double sum = 0.0;
  Vec2 from = robot_;
  for (const Vec2& place : places_) {
    sum += (place - from).norm();
    from = place;
  }
  return sum;
}

Vec2 Trail::at(double distance) const {
  Vec2 from = robot_;
  for (const Vec2& place : places_) {
    const double step = (place - from).norm();
    if (step >= distance)
      return step > 0.0 ? Vec2(from + distance / step * (place - from)) : place;
    distance -= step;
    from = place;
  }
  return from;
}

Schema follow_trail() {
  Schema follow;
  follow.name = "follow-trail";
  follow.summary =
      "walks behind a visible person, around the same corners: the nearest one, or the nearest to "
      "a place";
  Parameter place;
  place.name = "place";
  place.kind = ArgumentKind::point;
  follow.parameters = {place, quantity("distance", "m", 0.5, 5.0, 1.2),
                       quantity("speed", "m/s", 0.05, 1.0, 1.0)};
  follow.make = [](const Arguments& arguments) -> std::unique_ptr<Activity> {
    return std::make_unique<Follow>(arguments);
  };
  return follow;
}

}  // namespace saphira::intentions
