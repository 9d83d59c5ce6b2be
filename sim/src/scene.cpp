#include "saphira/sim/scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "saphira/base/format.hpp"

namespace saphira::sim {

namespace {

// A walking person keeps at least this distance from a robot, a stubborn one less, and more from
// one that comes nearer: the way that it may make in that time.
constexpr double kManners = 0.18;  // [m]
constexpr double kRude = 0.10;     // [m]
constexpr double kStops = 0.8;     // [s]

// The waiting time after which a stubborn person chooses another target, and another person gives
// way to a robot.
constexpr double kPatience = 4.0;  // [s]
constexpr double kCourtesy = 2.0;  // [s]
constexpr int kMostYields = 3;     // then the next leg

// A person who gives way steps to the nearest place, within this distance, where a robot has room
// beside him, and waits there until it has passed, for so long at most. Without such a place he
// goes back.
constexpr double kStepsAside = 2.0;  // [m]
constexpr double kBerth = 0.45;      // [m] between him and its hull
constexpr double kItsRoom = 0.25;    // [m] on its other side
constexpr double kDetour = 2.0;      // the robot's metre aside costs as much as two of his
constexpr double kGivesWay = 15.0;   // [s]
constexpr double kGoesBack = 1.5;    // [m]
constexpr int kCourses = 16;

// A person who passes a robot sees it from this far, and keeps these distances from its hull and
// from other things. Without room for that he stops earlier.
constexpr double kSees = 2.5;      // [m]
constexpr double kBeside = 0.20;   // [m]
constexpr double kRoom = 0.10;     // [m]
constexpr double kPolite = 1.20;   // [m]
constexpr double kStride = 0.10;   // [m] between the places that he looks at
constexpr double kOnLine = 0.001;  // [m]

// A leading person waits for the robot beyond this distance, from middle to middle.
constexpr double kLeash = 2.5;  // [m]

constexpr double kDoorSpeed = kPi / 2.0;  // [rad/s]

// A robot of this class cannot accelerate a lighter box beyond the grip of its own tyres.
constexpr double kMostPushed = 10.0;  // [kg]

// The additional displacement of a pushed box, so that it is out of the way at the next check.
constexpr double kGiven = 1e-7;  // [m]

// Ticks after which a sonar's sound has passed all listeners: 14 m.
constexpr std::uint64_t kPingTicks = 4;

// A person's legs at the height of a robot's sonars, and their pace.
constexpr double kShin = 0.06;   // [m] radius
constexpr double kApart = 0.10;  // [m] from the person's middle, to each side
constexpr double kStep = 0.30;   // [m] before the middle and behind it

// A person's outstretched arm, from the person's middle: inside of the body, and the finger tips.
constexpr double kArmBegin = 0.20;  // [m]
constexpr double kArmEnd = 0.80;    // [m]

// Numbers of things for sonars, kind by kind.
constexpr std::uint32_t kOfPersons = 1U << 24U;
constexpr std::uint32_t kOfPosts = 2U << 24U;
constexpr std::uint32_t kOfSegments = 3U << 24U;

void look_towards(Person& person, const Vec2& point) {
  const Vec2 way = point - person.at;
  if (way.squaredNorm() > 0.0)
    person.heading = std::atan2(way.y(), way.x());
}

double distance_to(const Segment& segment, const Vec2& point) {
  return (nearest_point(segment, point) - point).norm();
}

}  // namespace

std::array<Shin, 2> shins(const Person& person) {
  std::array<Shin, 2> pair;
  for (std::size_t i = 0; i < 2; ++i) {
    double ahead = 0.0;
    if (person.way > 0.0) {
      // While a foot stands, the middle passes over it; then the foot overtakes the middle.
      const double pace = person.way / (4.0 * kStep) + 0.25 + 0.5 * static_cast<double>(i);
      const double part = pace - std::floor(pace);
      pair[i].swings = part >= 0.5;
      ahead = part < 0.5 ? kStep * (1.0 - 4.0 * part) : kStep * (4.0 * part - 3.0);
    }
    const Pose pose{person.at.x(), person.at.y(), person.heading};
    pair[i].disc = {transform(pose, Vec2(ahead, i == 0 ? kApart : -kApart)), kShin};
  }
  return pair;
}

std::optional<Segment> arm(const Person& person) {
  if (!person.points)
    return std::nullopt;
  const Vec2 way(std::cos(*person.points), std::sin(*person.points));
  return Segment{person.at + kArmBegin * way, person.at + kArmEnd * way};
}

Scene::Scene(const World& world)
    : world_(&world),
      hulls_near_(world.width, world.height),
      persons_near_(world.width, world.height) {
  const MovablePlans& plans = world.movable;
  for (const PersonPlan& plan : plans.persons) {
    persons_near_.put(static_cast<std::uint32_t>(persons_.size()), plan.at);
    widest_person_ = std::max(widest_person_, plan.radius + kStep);
    persons_.push_back({&plan, plan.at});
    persons_.back().from = plan.at;
    const auto walk = std::ranges::find_if(
        plan.script, [](const PersonPlan::Leg& leg) { return leg.speed > 0.0; });
    if (walk != plan.script.end())
      look_towards(persons_.back(), walk->to);
    if (!plan.script.empty())
      persons_.back().points = plan.script.front().points;
    for (const PersonPlan::Leg& leg : plan.script)
      fastest_ = std::max(fastest_, leg.speed);
  }
  for (const DoorPlan& plan : plans.doors) {
    doors_.push_back({&plan});
    segments_.push_back(leaf(doors_.back()));
    fastest_ = std::max(fastest_, (plan.end - plan.hinge).norm() * kDoorSpeed);
  }
  for (const BoxPlan& plan : plans.boxes) {
    boxes_.push_back({&plan, plan.pose_in_world});
    for (const Segment& side : outline(boxes_.back(), plan.pose_in_world))
      segments_.push_back(side);
  }
  for (const PostPlan& plan : plans.posts)
    posts_.push_back({plan.at, plan.radius});
}

Segment Scene::leaf(const Door& door, double angle) {
  const DoorPlan& plan = *door.plan;
  return {plan.hinge,
          transform(Pose{plan.hinge.x(), plan.hinge.y(), angle}, Vec2(plan.end - plan.hinge))};
}

std::array<Segment, 4> Scene::outline(const Box& box, const Pose& pose_in_world) {
  const double x = box.plan->length / 2.0;
  const double y = box.plan->width / 2.0;
  const std::array<Vec2, 4> corners{
      transform(pose_in_world, Vec2(x, y)), transform(pose_in_world, Vec2(-x, y)),
      transform(pose_in_world, Vec2(-x, -y)), transform(pose_in_world, Vec2(x, -y))};
  return {{{corners[0], corners[1]},
           {corners[1], corners[2]},
           {corners[2], corners[3]},
           {corners[3], corners[0]}}};
}

Robot& Scene::add_robot(const protocol::RobotParameters& parameters, const Pose& start_in_world,
                        std::uint64_t seed) {
  const Vec2 at = start_in_world.position();
  if (const double overlap = parameters.radius - distance(at); overlap > 0.0)
    throw std::invalid_argument("the robot would stand in " + nearest(at) +
                                format(": with its radius of %.2f m the two overlap by %.2f m",
                                       parameters.radius, overlap));
  hulls_near_.put(static_cast<std::uint32_t>(hulls_.size()), start_in_world.position());
  widest_hull_ = std::max(widest_hull_, parameters.radius);
  hulls_.push_back({start_in_world.position(), parameters.radius});
  robots_.push_back(
      std::make_unique<Robot>(*this, robots_.size(), parameters, start_in_world, seed));
  // A box turns as it is pushed, and its far end may move faster than the robot.
  fastest_ = std::max(fastest_, robots_.back()->fastest() * (boxes_.empty() ? 1.0 : 4.0));
  return *robots_.back();
}

void Scene::tick() {
  ++ticks_;
  // In order of time: the oldest are dropped first.
  const auto fresh = std::ranges::find_if(
      pings_, [this](const Ping& ping) { return ping.tick + kPingTicks > ticks_; });
  pings_.erase(pings_.begin(), fresh);
  for (std::uint32_t i = 0; i < persons_.size(); ++i) {
    walk(persons_[i]);
    persons_near_.put(i, persons_[i].at);
  }
  for (std::size_t i = 0; i < doors_.size(); ++i)
    turn(i);
  for (const auto& robot : robots_)
    robot->tick();
}

void Scene::sound(const Ping& ping) {
  if (robots_.size() > 1 && ping.robot != kNobody)
    pings_.push_back(ping);
}

void Scene::moved(RobotNumber number) {
  hulls_[number].centre = robots_[number]->pose_in_world().position();
  hulls_near_.put(static_cast<std::uint32_t>(number), hulls_[number].centre);
}

bool Scene::set_door(std::string_view name, bool open) {
  for (Door& door : doors_) {
    if (door.plan->look.name != name)
      continue;
    door.opens = open;
    return true;
  }
  return false;
}

bool Scene::set_box(std::string_view name, const Pose& pose_in_world) {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (boxes_[i].plan->look.name != name)
      continue;
    if (!is_free(i, pose_in_world, kNobody))
      return false;
    put(i, pose_in_world);
    return true;
  }
  return false;
}

bool Scene::set_person(std::string_view name, const Vec2& at) {
  for (std::uint32_t i = 0; i < persons_.size(); ++i) {
    Person& person = persons_[i];
    if (person.plan->look.name != name)
      continue;
    const double radius = person.plan->radius;
    const auto near = [&](const Segment& segment) { return distance_to(segment, at) < radius; };
    if (sim::distance(world_->segments, at) < radius || std::ranges::any_of(segments_, near) ||
        std::ranges::any_of(hulls_, [&](const Disc& hull) {
          return (hull.centre - at).norm() < radius + hull.radius;
        }))
      return false;
    person.at = person.from = at;
    person.waited = 0.0;
    person.refuge.reset();
    person.back.clear();
    person.aside = false;
    persons_near_.put(i, at);
    return true;
  }
  return false;
}

bool Scene::set_arm(std::string_view name, std::optional<double> direction_in_world) {
  for (Person& person : persons_) {
    if (person.plan->look.name != name)
      continue;
    person.points = direction_in_world;
    return true;
  }
  return false;
}

void Scene::walk(Person& person) {
  const std::vector<PersonPlan::Leg>& script = person.plan->script;
  if (person.leg >= script.size()) {
    person.way = 0.0;
    return;
  }
  const PersonPlan::Leg& leg = script[person.leg];
  bool done = false;
  if (leg.speed == 0.0) {
    person.way = 0.0;
    person.waited += kTick;
    done = person.waited > leg.wait - kTick / 2.0;
  } else if (leg.leads && !has_robot_within(kLeash, person.at)) {
    person.way = 0.0;
  } else {
    if (person.waited < 0.0) {
      person.way = 0.0;
      person.waited += kTick;
      if (person.waited > kPatience - kGivesWay && person.waited < -kPatience &&
          !has_robot_ahead(person))
        person.waited = 0.0;
      return;
    }
    const auto aim = person.refuge ? std::optional(person.refuge->at) : next_place(person);
    const double step = leg.speed * kTick;
    const Vec2 target = aim.value_or(leg.to);
    const Vec2 way = target - person.at;
    const double left = way.norm();
    const Vec2 to = left <= step ? target : Vec2(person.at + way * (step / left));
    if (!aim || !lets_pass(person, to)) {
      person.way = 0.0;
      person.waited += kTick;
      if (person.plan->stubborn) {
        if (person.waited > kPatience)
          next_leg(person);
      } else if (!aim || person.waited > kCourtesy) {
        if (++person.yielded > kMostYields) {
          next_leg(person);
          person.from = leg.to;  // he goes on from the line between the two
          person.aside = true;
          return;
        }
        person.refuge = refuge(person);
        person.back.push_back(person.at);
        person.aside = true;
        person.waited = 0.0;
      }
      return;
    }
    person.waited = 0.0;
    look_towards(person, *aim);
    person.way += std::min(left, step);
    person.at = to;
    if (!person.refuge) {
      done = to == leg.to;
    } else if (left <= step) {
      person.waited = -person.refuge->stay;
      person.refuge.reset();
    }
  }
  if (done)
    next_leg(person);
}

void Scene::next_leg(Person& person) {
  person.waited = 0.0;
  if (person.plan->script[person.leg].speed > 0.0) {
    person.from = person.at;
    person.aside = false;
    person.back.clear();
  }
  person.refuge.reset();
  person.yielded = 0;
  ++person.leg;
  if (person.leg == person.plan->script.size() && person.plan->repeats)
    person.leg = 0;
  person.points.reset();
  if (person.leg < person.plan->script.size())
    person.points = person.plan->script[person.leg].points;
}

bool Scene::has_robot_within(double reach, const Vec2& point) const {
  const auto& near = hulls_near_.near(point, reach);
  return std::ranges::any_of(
      near, [&](std::uint32_t i) { return (hulls_[i].centre - point).norm() <= reach; });
}

bool Scene::has_robot_ahead(const Person& person) const {
  const Vec2 way = person.plan->script[person.leg].to - person.at;
  const auto& near = hulls_near_.near(person.at, kSees);
  return std::ranges::any_of(near, [&](std::uint32_t i) {
    const Vec2 there = hulls_[i].centre - person.at;
    return there.norm() < kSees && way.dot(there) > 0.0;
  });
}

/// [m] Beside a person's body at that place; the leaves of doors, which he opens, do not count.
double Scene::room(const Person& person, const Vec2& at) const {
  double best = room_but_robots(person, at);
  for (const Disc& hull : hulls_)
    best = std::min(best, (hull.centre - at).norm() - hull.radius);
  return best - person.plan->radius;
}

/// [m] From that place to the nearest wall, box, post or other person.
double Scene::room_but_robots(const Person& person, const Vec2& at) const {
  double best = sim::distance(world_->segments, at);
  for (std::size_t i = doors_.size(); i < segments_.size(); ++i)
    best = std::min(best, distance_to(segments_[i], at));
  const auto look = [&](const Disc& disc) {
    best = std::min(best, (disc.centre - at).norm() - disc.radius);
  };
  std::ranges::for_each(posts_, look);
  for (const Person& other : persons_)
    if (&other != &person)
      look({other.at, other.plan->radius});
  return best;
}

/// True where he has room all along that straight way.
bool Scene::is_free(const Person& person, const Vec2& to) const {
  const Vec2 way = to - person.at;
  const int strides = static_cast<int>(std::ceil(way.norm() / kStride));
  for (int i = 1; i <= strides; ++i)
    if (room(person, person.at + way * i / strides) < kRoom)
      return false;
  return true;
}

/// A place beside the nearest robot in his way to `aim`, on the side that bends the way less;
/// `aim` where there is no robot. None: there is no room, and he is near.
std::optional<Vec2> Scene::way_past(const Person& person, const Vec2& aim,
                                    const Vec2& target) const {
  const Vec2 way = aim - person.at;
  const double left = way.norm();
  std::optional<Vec2> nearest;
  double gap = 0.0;
  double room = 0.0;
  bool taken = false;  // the robot stands where he wants to go
  for (const std::uint32_t i : hulls_near_.near(person.at, kSees)) {
    const Vec2 there = hulls_[i].centre - person.at;
    const double touch = person.plan->radius + hulls_[i].radius;
    const double along = left > 0.0 ? way.dot(there) / left : 0.0;
    if (along <= 0.0 || there.norm() > kSees ||
        (there - way * (std::min(along, left) / left)).norm() >= touch + kBeside ||
        (nearest && nearest->norm() <= there.norm()))
      continue;
    nearest = there;
    taken = (hulls_[i].centre - target).norm() < touch + kBeside;
    room = touch + kBeside;
    gap = there.norm() - touch;
  }
  if (!nearest)
    return aim;
  const double far = nearest->norm();
  const double bend = std::asin(std::min(1.0, room / far));
  const double stretch = std::max(std::sqrt(std::max(far * far - room * room, 0.0)), room);
  const double straight = std::atan2(way.y(), way.x());
  const double bearing = std::atan2(nearest->y(), nearest->x());
  const bool left_first = norm2_angle(bearing - straight) < 0.0;
  for (const double side : {left_first ? 1.0 : -1.0, left_first ? -1.0 : 1.0}) {
    const double course = bearing + side * bend;
    const Vec2 beside = person.at + stretch * Vec2(std::cos(course), std::sin(course));
    if (!taken && is_free(person, beside))
      return beside;
  }
  if (gap < kPolite)
    return std::nullopt;
  return aim;
}

/// The place where he lets the nearest robot ahead pass: the one with the shortest ways for him
/// and, to the side, for the robot. Each second time, and without such a place: the farthest one
/// from it. Without such a robot: where he is.
Person::Refuge Scene::refuge(const Person& person) const {
  const Vec2 ahead = (person.plan->script[person.leg].to - person.at).normalized();
  const Disc* robot = nullptr;
  double near = kSees;
  for (const std::uint32_t i : hulls_near_.near(person.at, kSees)) {
    const Vec2 there = hulls_[i].centre - person.at;
    if (there.norm() < near && ahead.dot(there) > 0.0) {
      robot = &hulls_[i];
      near = there.norm();
    }
  }
  Person::Refuge best{person.at, kPatience};
  if (!robot)
    return best;
  const Vec2 aside(-ahead.y(), ahead.x());
  const double apart = person.plan->radius + kBerth + robot->radius;
  std::vector<Vec2> places{person.at};
  for (double far = kStride; far < kStepsAside; far += kStride)
    for (int i = 0; i < kCourses; ++i) {
      const double course = 2.0 * kPi * i / kCourses;
      const Vec2 at = person.at + far * Vec2(std::cos(course), std::sin(course));
      if ((robot->centre - at).norm() >= near && is_free(person, at))
        places.push_back(at);
    }
  double least = std::numeric_limits<double>::infinity();
  for (const Vec2& at : places)
    for (const double side : {apart, -apart}) {
      const Vec2 its = at + side * aside;
      const double cost =
          (at - person.at).norm() + kDetour * std::abs(aside.dot(its - robot->centre));
      if (person.yielded % 2 == 1 && cost < least &&
          room_but_robots(person, its) >= robot->radius + kItsRoom &&
          std::ranges::none_of(world_->segments, [&](const Segment& wall) {
            return intersect(wall, {at, its});
          })) {
        best = {at, kGivesWay};
        least = cost;
      }
    }
  if (least < std::numeric_limits<double>::infinity())
    return best;
  for (const Vec2& at : places)
    if ((at - person.at).norm() <= kGoesBack &&
        (at - robot->centre).norm() > (best.at - robot->centre).norm())
      best.at = at;
  return best;
}

/// The point that he walks towards: the target of his leg; beside a robot, and behind it to the
/// straight line of his leg again. None: he waits.
std::optional<Vec2> Scene::next_place(Person& person) const {
  const PersonPlan::Leg& leg = person.plan->script[person.leg];
  if (person.plan->stubborn)
    return leg.to;
  Vec2 aim = leg.to;
  if (person.aside) {
    const Vec2 ahead = (leg.to - person.from).normalized();
    const double done = ahead.dot(person.at - person.from);
    const auto on_line = [&](double further) {
      return done + further < (leg.to - person.from).norm()
                 ? Vec2(person.from + ahead * (done + further))
                 : leg.to;
    };
    person.aside = (on_line(0.0) - person.at).norm() > kOnLine;
    if (!person.back.empty() && (person.back.back() - person.at).norm() <= kOnLine)
      person.back.pop_back();
    if (!person.aside || is_free(person, on_line(1.0)))
      person.back.clear();
    if (person.aside)
      aim = is_free(person, on_line(1.0)) ? on_line(1.0)
            : person.back.empty()         ? on_line(0.2)
                                          : person.back.back();
  }
  const auto place = way_past(person, aim, leg.to);
  if (place && *place != aim)
    person.aside = true;
  return place;
}

// True where his way is free, apart from obstacles that were behind him.
bool Scene::lets_pass(const Person& person, const Vec2& to) {
  const double radius = person.plan->radius;
  for (const std::uint32_t i : hulls_near_.near(to, radius + widest_hull_ + kSees)) {
    const Disc& hull = hulls_[i];
    const double after = (hull.centre - to).norm();
    if (after >= (hull.centre - person.at).norm())
      continue;
    const Vec2 coming = robots_[i]->pose_in_world().direction() * robots_[i]->velocity();
    const double speed = std::max(0.0, coming.dot(to - hull.centre) / after);
    const double manners = person.plan->stubborn ? kRude : kManners + kStops * speed;
    if (after < radius + hull.radius + manners)
      return false;
  }
  if (person.aside && room(person, to) < std::min(0.0, room(person, person.at)))
    return false;
  if (std::ranges::any_of(world_->segments, [&](const Segment& wall) {
        return intersect(wall, {person.at, to});
      }))
    return false;
  bool free = true;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const double after = distance_to(segments_[i], to);
    if (after >= radius || after >= distance_to(segments_[i], person.at))
      continue;
    free = false;
    if (i < doors_.size())
      doors_[i].opens = true;
  }
  return free;
}

void Scene::turn(std::size_t number) {
  Door& door = doors_[number];
  const DoorPlan& plan = *door.plan;
  const double now = static_cast<double>(ticks_) * kTick;
  if (plan.period > 0.0 && now >= door.since + plan.period) {
    door.since += plan.period;
    door.event = 0;
  }
  while (door.event < plan.schedule.size() &&
         now >= door.since + plan.schedule[door.event].time - kTick / 2.0)
    door.opens = plan.schedule[door.event++].open;
  const double target = door.opens ? plan.swing : 0.0;
  if (door.angle == target)
    return;
  const double angle =
      std::clamp(target, door.angle - kDoorSpeed * kTick, door.angle + kDoorSpeed * kTick);
  const Segment before = segments_[number];
  const Segment after = leaf(door, angle);
  const auto hits = [&](const Disc& disc) {
    const double left = distance_to(after, disc.centre);
    return left < disc.radius && left < distance_to(before, disc.centre);
  };
  for (const Disc& hull : hulls_)
    if (hits(hull))
      return;
  for (const Person& person : persons_)
    if (hits({person.at, person.plan->radius}))
      return;
  for (std::size_t i = doors_.size(); i < segments_.size(); ++i)
    if (intersect(after, segments_[i]) && !intersect(before, segments_[i]))
      return;
  door.angle = angle;
  segments_[number] = after;
}

bool Scene::is_free(std::size_t number, const Pose& pose_in_world, RobotNumber pusher) const {
  const Box& box = boxes_[number];
  const auto sides = outline(box, pose_in_world);
  const auto contains = [&, inside_of = ToFrame(pose_in_world)](const Vec2& point) {
    const Vec2 inside = inside_of(point);
    return std::abs(inside.x()) < box.plan->length / 2.0 &&
           std::abs(inside.y()) < box.plan->width / 2.0;
  };
  const auto hits_segment = [&](const Segment& segment) {
    return contains(segment.from) || std::ranges::any_of(sides, [&](const Segment& side) {
             return intersect(side, segment);
           });
  };
  const auto hits_disc = [&](const Disc& disc) {
    return contains(disc.centre) || std::ranges::any_of(sides, [&](const Segment& side) {
             return distance_to(side, disc.centre) < disc.radius;
           });
  };
  const std::size_t own = doors_.size() + 4 * number;
  for (std::size_t i = 0; i < segments_.size(); ++i)
    if ((i < own || i >= own + 4) && hits_segment(segments_[i]))
      return false;
  for (RobotNumber i = 0; i < hulls_.size(); ++i)
    if (i != pusher && hits_disc(hulls_[i]))
      return false;
  for (const Person& person : persons_)
    if (hits_disc({person.at, person.plan->radius}))
      return false;
  return std::ranges::none_of(posts_, hits_disc) &&
         std::ranges::none_of(world_->segments, hits_segment);
}

bool Scene::push(RobotNumber number, const Vec2& centre, const Vec2& way) {
  std::size_t nearest = boxes_.size();
  double best = hulls_[number].radius + 1e-4;
  Vec2 contact = centre;
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    for (std::size_t side = 0; side < 4; ++side) {
      const Vec2 point = nearest_point(segments_[doors_.size() + 4 * i + side], centre);
      const double far = (point - centre).norm();
      if (far < best) {
        best = far;
        nearest = i;
        contact = point;
      }
    }
  if (nearest == boxes_.size() || boxes_[nearest].plan->mass > kMostPushed)
    return false;
  const Box& box = boxes_[nearest];
  const Vec2 normal = (contact - centre).normalized();
  const double depth = way.dot(normal);
  if (depth <= 0.0)
    return false;
  // A slowly pushed box moves by its floor friction: with an ellipsoidal limit surface, a force
  // along the normal gives a motion along it and a turn in proportion to its lever.
  const double lever = cross(contact - box.pose_in_world.position(), normal);
  const double size =
      (box.plan->length * box.plan->length + box.plan->width * box.plan->width) / 12.0;
  const double share = (depth + kGiven) / (1.0 + lever * lever / size);
  const Pose moved{box.pose_in_world.x + share * normal.x(),
                   box.pose_in_world.y + share * normal.y(),
                   norm2_angle(box.pose_in_world.th + share * lever / size)};
  if (!is_free(nearest, moved, number))
    return false;
  put(nearest, moved);
  return true;
}

void Scene::put(std::size_t number, const Pose& pose_in_world) {
  boxes_[number].pose_in_world = pose_in_world;
  const auto sides = outline(boxes_[number], pose_in_world);
  std::ranges::copy(sides,
                    segments_.begin() + static_cast<std::ptrdiff_t>(doors_.size() + 4 * number));
}

void Scene::add_movable(const Vec2& point, double reach, RobotNumber but, Things& things) const {
  for (const std::uint32_t i : hulls_near_.near(point, reach + widest_hull_)) {
    const double far = reach + hulls_[i].radius;
    if (i != but && (hulls_[i].centre - point).squaredNorm() <= far * far)
      things.discs.push_back(hulls_[i]);
  }
  const auto add = [&](const Disc& disc) {
    const double far = reach + disc.radius;
    if ((disc.centre - point).squaredNorm() <= far * far)
      things.discs.push_back(disc);
  };
  for (const std::uint32_t i : persons_near_.near(point, reach + widest_person_))
    add({persons_[i].at, persons_[i].plan->radius});
  for (const Disc& post : posts_)
    add(post);
  for (const Segment& segment : segments_)
    if ((nearest_point(segment, point) - point).squaredNorm() <= reach * reach)
      things.segments.push_back(segment);
}

void Scene::add_echoes(const Vec2& point, double reach, RobotNumber but, double cloth,
                       Echoes& echoes) const {
  const auto add = [&](const Disc& disc, const Surface& surface) {
    const double far = reach + disc.radius;
    if ((disc.centre - point).squaredNorm() > far * far)
      return;
    echoes.things.discs.push_back(disc);
    echoes.discs.push_back(surface);
  };
  for (const std::uint32_t i : hulls_near_.near(point, reach + widest_hull_))
    if (i != but)
      add(hulls_[i], {0.0, false, i});
  for (const std::uint32_t i : persons_near_.near(point, reach + widest_person_)) {
    std::uint32_t id = kOfPersons + 2 * i;
    for (const Shin& shin : shins(persons_[i]))
      add(shin.disc, {persons_[i].plan->look.cloth.value_or(cloth), shin.swings, id++});
  }
  for (std::uint32_t i = 0; i < posts_.size(); ++i)
    add(posts_[i], {world_->movable.posts[i].look.cloth.value_or(0.0), false, kOfPosts + i});
  for (std::uint32_t i = 0; i < segments_.size(); ++i) {
    if ((nearest_point(segments_[i], point) - point).squaredNorm() > reach * reach)
      continue;
    const Look& look =
        i < doors_.size() ? doors_[i].plan->look : boxes_[(i - doors_.size()) / 4].plan->look;
    echoes.things.segments.push_back(segments_[i]);
    echoes.segments.push_back({look.cloth.value_or(0.0), false, kOfSegments + 3 * i});
  }
}

double Scene::distance(const Vec2& point, RobotNumber but) const {
  double best = sim::distance(world_->segments, point);
  for (std::size_t i = 0; i < hulls_.size(); ++i)
    if (i != but)
      best = std::min(best, (hulls_[i].centre - point).norm() - hulls_[i].radius);
  for (const Person& person : persons_)
    best = std::min(best, (person.at - point).norm() - person.plan->radius);
  for (const Disc& post : posts_)
    best = std::min(best, (post.centre - point).norm() - post.radius);
  return std::min(best, sim::distance(segments_, point));
}

std::string Scene::nearest(const Vec2& point) const {
  const double free = distance(point);
  for (std::size_t i = 0; i < hulls_.size(); ++i)
    if ((hulls_[i].centre - point).norm() - hulls_[i].radius == free)
      return "robot " + std::to_string(i + 1);
  for (const Person& person : persons_)
    if ((person.at - point).norm() - person.plan->radius == free)
      return "the person \"" + person.plan->look.name + "\"";
  if (sim::distance(world_->segments, point) == free)
    return "a wall";
  return sim::distance(segments_, point) == free ? "a door or a box" : "a post";
}

}  // namespace saphira::sim
