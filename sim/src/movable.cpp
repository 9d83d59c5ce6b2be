#include "saphira/sim/movable.hpp"

#include <algorithm>

#include "world_check.hpp"

namespace saphira::sim {

namespace {

constexpr double kMostTime = 1e6;   // [s]
constexpr double kMostLoss = 60.0;  // [dB]
constexpr double kMostSpeed = 5e3;  // [mm/s]

Vec2 point(LineReader& in, const std::string& of, const Pose& frame) {
  const double x = in.number("x of " + of + " in mm", -kMax, kMax) * kMillimetre;
  const double y = in.number("y of " + of + " in mm", -kMax, kMax) * kMillimetre;
  return transform(frame, Vec2(x, y));
}

double angle(LineReader& in, const std::string& what) {
  return norm2_angle(radians(in.number(what + " in degrees", -3600, 3600)));
}

Pose pose(LineReader& in, const std::string& of) {
  const double x = in.number("x of " + of + " in mm", -kMax, kMax) * kMillimetre;
  const double y = in.number("y of " + of + " in mm", -kMax, kMax) * kMillimetre;
  return {x, y, angle(in, "theta of " + of)};
}

double size(LineReader& in, const std::string& what) {
  return in.number(what + " in mm", 1.0, 20000.0) * kMillimetre;
}

}  // namespace

Look MovableReader::read_look(LineReader& in, double height) {
  Look look;
  look.name = in.word("a name");
  look.height = height;
  const auto has = [&](const auto& plans) {
    return std::ranges::any_of(plans,
                               [&](const auto& plan) { return plan.look.name == look.name; });
  };
  if (has(plans_.persons) || has(plans_.doors) || has(plans_.boxes) || has(plans_.posts))
    in.fail("expected another name: there is one called \"" + look.name + "\" already");
  return look;
}

Look& MovableReader::last_look(LineReader& in, std::string_view word) {
  switch (last_) {
    case Last::kPerson:
      return plans_.persons.back().look;
    case Last::kDoor:
      return plans_.doors.back().look;
    case Last::kBox:
      return plans_.boxes.back().look;
    case Last::kPost:
      return plans_.posts.back().look;
    case Last::kNone:
      break;
  }
  in.fail("expected a person, door, box or post before this " + std::string(word));
}

bool MovableReader::read(std::string_view word, LineReader& in, const Pose& frame_in_world) {
  const auto needs = [&](Last last, const char* what) {
    if (last_ != last)
      in.fail("expected a " + std::string(what) + " before this " + std::string(word));
  };
  if (word == "robot") {
    plans_.robots.push_back(pose(in, "the robot"));
  } else if (word == "person") {
    PersonPlan person;
    person.look = read_look(in, kPersonHeight);
    person.at = point(in, "the person", frame_in_world);
    plans_.persons.push_back(person);
    last_ = Last::kPerson;
  } else if (word == "walk" || word == "lead") {
    needs(Last::kPerson, "person");
    PersonPlan::Leg leg;
    leg.to = point(in, "where to", frame_in_world);
    leg.speed = in.number("speed in mm/s", 1.0, kMostSpeed) * kMillimetre;
    leg.leads = word == "lead";
    plans_.persons.back().script.push_back(leg);
  } else if (word == "wait") {
    needs(Last::kPerson, "person");
    PersonPlan::Leg leg;
    leg.wait = in.number("time in s", 0.0, kMostTime);
    plans_.persons.back().script.push_back(leg);
  } else if (word == "point") {
    needs(Last::kPerson, "person");
    PersonPlan::Leg leg;
    leg.points = norm2_angle(frame_in_world.th + angle(in, "direction"));
    leg.wait = in.number("time in s", 0.0, kMostTime);
    plans_.persons.back().script.push_back(leg);
  } else if (word == "repeat") {
    needs(Last::kPerson, "person");
    if (plans_.persons.back().script.empty())
      in.fail("expected walk, lead, wait or point before this repeat");
    plans_.persons.back().repeats = true;
  } else if (word == "stubborn") {
    needs(Last::kPerson, "person");
    plans_.persons.back().stubborn = true;
  } else if (word == "door") {
    DoorPlan door;
    door.look = read_look(in, kDoorHeight);
    door.hinge = point(in, "the hinge", frame_in_world);
    door.end = point(in, "the other end", frame_in_world);
    if ((door.end - door.hinge).norm() < 0.01)
      in.fail("expected a door that is wider than 10 mm");
    door.swing = radians(in.number("swing in degrees", -180.0, 180.0));
    plans_.doors.push_back(door);
    last_ = Last::kDoor;
  } else if (word == "open" || word == "close") {
    needs(Last::kDoor, "door");
    DoorPlan& door = plans_.doors.back();
    const double time = in.number("time in s", 0.0, kMostTime);
    if (!door.schedule.empty() && time < door.schedule.back().time)
      in.fail("expected the times of a door in order");
    door.schedule.push_back({time, word == "open"});
  } else if (word == "period") {
    needs(Last::kDoor, "door");
    DoorPlan& door = plans_.doors.back();
    if (door.schedule.empty())
      in.fail("expected open or close before this period");
    door.period = in.number("time in s", 0.1, kMostTime);
    if (door.period < door.schedule.back().time)
      in.fail("expected a period that is no shorter than the schedule");
  } else if (word == "box") {
    BoxPlan box;
    box.look = read_look(in, kBoxHeight);
    box.pose_in_world = compose(frame_in_world, pose(in, "the box"));
    box.length = size(in, "length");
    box.width = size(in, "width");
    box.mass = in.number("mass in kg", 0.0, 1e6);
    plans_.boxes.push_back(box);
    last_ = Last::kBox;
  } else if (word == "post") {
    PostPlan post;
    post.look = read_look(in, kPostHeight);
    post.at = point(in, "the post", frame_in_world);
    post.radius = size(in, "radius");
    plans_.posts.push_back(post);
    last_ = Last::kPost;
  } else if (word == "color" || word == "colour") {
    Look& look = last_look(in, word);
    look.color = in.word("a color");
  } else if (word == "wide") {
    needs(Last::kPerson, "person");
    plans_.persons.back().radius = size(in, "width") / 2.0;
  } else if (word == "tall") {
    Look& look = last_look(in, word);
    look.height = size(in, "height");
  } else if (word == "cloth") {
    Look& look = last_look(in, word);
    look.cloth = in.number("loss of an echo in dB", 0.0, kMostLoss);
  } else {
    return false;
  }
  return true;
}

}  // namespace saphira::sim
