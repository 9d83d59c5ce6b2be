#include "saphira/sim/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saphira::sim {

namespace {

constexpr double kContactLookout = 1.0;  // [m] from the hull
// Slower motion is rest.
constexpr double kStands = 0.005;    // [m/s]
constexpr double kTurns = 0.01;      // [rad/s]
constexpr double kSameThing = 0.1;   // [m] a wall this near to the point does not hide it
constexpr std::size_t kOneWall = 0;  // all walls count as one thing
constexpr double kTouch = 0.002;     // [m] a smaller gap is a contact...
constexpr double kParted = 0.05;     // [m] ...which has ended when the gap is larger than this
constexpr double kTowards = 0.01;    // [m/s] a person feels a faster robot
constexpr double kAtRest = 0.3;      // [s] nor one that has stood this long
constexpr double kReaction = 0.6;    // [s] from the sound to the brakes, at worst
// The true range for a sonar, heard or not.
constexpr double kLobe = radians(9.0);  // [rad] to either side of the axis
constexpr double kLeastRange = 0.2;     // [m]
constexpr double kMostRange = 2.0;      // [m]
constexpr double kMemory = 10.0;        // [s] older readings do not count

}  // namespace

ContactWatch::ContactWatch(const Scene& scene, RobotNumber robot,
                           const protocol::RobotParameters& parameters)
    : scene_(&scene),
      robot_(robot),
      parameters_(parameters),
      most_range_(std::min(kMostRange, parameters.sonar_max_range)),
      near_(scene.world(), parameters.radius + std::max(kContactLookout, kMostRange)) {
  remember();
}

void ContactWatch::tick() {
  for (const Thing& thing : things())
    judge(thing);
  const Robot& robot = scene_->robot(robot_);
  const bool stands =
      std::abs(robot.velocity()) < kStands && std::abs(robot.rotation_velocity()) < kTurns;
  stood_ = stands ? stood_ + kTick : 0.0;
  velocity_ = robot.velocity();
  remember();
}

void ContactWatch::remember() {
  Past past{scene_->robot(robot_).pose_in_world(), {}};
  for (const Person& person : scene_->persons())
    for (const Shin& shin : shins(person))
      past.persons.push_back(shin.disc.centre);
  past_.push_back(std::move(past));
  if (static_cast<double>(past_.size()) * kTick > kMemory)
    past_.pop_front();
}

std::vector<ContactWatch::Thing> ContactWatch::things() const {
  const Robot& robot = scene_->robot(robot_);
  const Vec2 at = robot.pose_in_world().position();
  std::vector<Thing> found;
  const auto add = [&](ThingKind kind, std::size_t number, const Vec2& nearest) {
    const double gap = (nearest - at).norm() - robot.radius();
    found.push_back({kind, number, nearest, gap});
  };
  const auto add_disc = [&](ThingKind kind, std::size_t number, const Disc& disc) {
    const Vec2 way = at - disc.centre;
    add(kind, number, disc.centre + way.normalized() * disc.radius);
  };
  for (std::size_t i = 0; i < scene_->persons().size(); ++i)
    add_disc(ThingKind::kPerson, i, {scene_->persons()[i].at, scene_->persons()[i].plan->radius});
  const auto& posts = scene_->world().movable.posts;
  for (std::size_t i = 0; i < posts.size(); ++i)
    add_disc(ThingKind::kPost, i, {posts[i].at, posts[i].radius});
  for (std::size_t i = 0; i < scene_->boxes().size(); ++i) {
    const auto sides = scene_->sides(scene_->boxes()[i]);
    add(ThingKind::kBox, i, *nearest_point({sides.begin(), sides.end()}, at));
  }
  for (std::size_t i = 0; i < scene_->doors().size(); ++i)
    add(ThingKind::kDoor, i, nearest_point(scene_->leaf(scene_->doors()[i]), at));
  for (RobotNumber i = 0; i < scene_->robots(); ++i)
    if (i != robot_)
      add_disc(ThingKind::kRobot, i,
               {scene_->robot(i).pose_in_world().position(), scene_->robot(i).radius()});
  if (const auto wall = nearest_point(near_.around(at), at))
    add(ThingKind::kWall, kOneWall, *wall);
  return found;
}

ContactWatch::State& ContactWatch::state_of(const Thing& thing) {
  for (State& state : states_)
    if (state.kind == thing.kind && state.number == thing.number)
      return state;
  return states_.emplace_back(State{thing.kind, thing.number});
}

void ContactWatch::judge(const Thing& thing) {
  if (thing.kind == ThingKind::kPerson)
    closest_person_ = std::min(closest_person_, thing.gap);
  State& state = state_of(thing);
  if (thing.gap > kParted)
    state.touches = false;
  if (state.touches || thing.gap >= kTouch)
    return;
  const Robot& robot = scene_->robot(robot_);
  const Pose& pose = robot.pose_in_world();
  // A contact ends the robot's motion, so the velocity before it counts. The turning of a round
  // hull does not approach anything.
  const double velocity =
      std::abs(velocity_) > std::abs(robot.velocity()) ? velocity_ : robot.velocity();
  const double towards =
      velocity * pose.direction().dot((thing.nearest - pose.position()).normalized());
  state.touches = true;
  contacts_.push_back(blame(thing, towards));
}

Contact ContactWatch::blame(const Thing& thing, double towards) const {
  Contact contact;
  contact.tick = scene_->ticks();
  contact.kind = thing.kind;
  contact.walks =
      thing.kind == ThingKind::kPerson && !scene_->persons()[thing.number].plan->script.empty();
  contact.name = name_of(thing);
  contact.towards = towards;
  contact.heard = heard(thing);
  contact.needed = kReaction;
  contact.at_in_world = thing.nearest;
  contact.needed += std::max(0.0, towards) / parameters_.deceleration;
  if (stood_ >= kAtRest || towards <= kTowards)
    contact.blame = Blame::kWalkedInto;
  else if (contact.heard < contact.needed)
    contact.blame = Blame::kUnseen;
  return contact;
}

// Things other than people are assumed to have stood still.
double ContactWatch::heard(const Thing& thing) const {
  std::size_t ticks = 0;
  for (const Past& past : past_) {
    const bool heard = thing.kind == ThingKind::kPerson
                           ? in_a_lobe(past.robot_in_world, past.persons[2 * thing.number]) ||
                                 in_a_lobe(past.robot_in_world, past.persons[2 * thing.number + 1])
                           : in_a_lobe(past.robot_in_world, thing.nearest);
    ticks += heard ? 1U : 0U;
  }
  return static_cast<double>(ticks) * kTick;
}

bool ContactWatch::in_a_lobe(const Pose& robot, const Vec2& point) const {
  const double cosine = std::cos(kLobe);
  return std::ranges::any_of(parameters_.sonars, [&](const protocol::SonarUnit& unit) {
    const Pose at = compose(robot, unit.pose_in_robot);
    const Vec2 way = point - at.position();
    const double range = way.norm();
    if (range < kLeastRange || range > most_range_ || way.dot(at.direction()) < range * cosine)
      return false;
    return !cast_ray(near_.around(robot.position()), at.position(), way / range,
                     range - kSameThing);
  });
}

std::string ContactWatch::name_of(const Thing& thing) const {
  const MovablePlans& plans = scene_->world().movable;
  switch (thing.kind) {
    case ThingKind::kPerson:
      return plans.persons[thing.number].look.name;
    case ThingKind::kPost:
      return plans.posts[thing.number].look.name;
    case ThingKind::kBox:
      return plans.boxes[thing.number].look.name;
    case ThingKind::kDoor:
      return plans.doors[thing.number].look.name;
    case ThingKind::kRobot:
      return std::to_string(thing.number + 1);
    case ThingKind::kWall:
      break;
  }
  return {};
}

}  // namespace saphira::sim
