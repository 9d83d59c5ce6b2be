#include "saphira/sim/resume.hpp"

#include <initializer_list>

#include "saphira/base/fnv1a.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"

namespace saphira::sim {
namespace {

std::string numbers(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values)
    text += " " + exact(value);
  return text + "\n";
}

std::string sum_of(const std::string& world) {
  Fnv1a sum;
  sum.add(world);
  return sum.text();
}

Pose pose_in(LineReader& words) {
  const double x = words.number("x");
  const double y = words.number("y");
  return {x, y, words.number("th")};
}

}  // namespace

std::string places_text(const Scene& scene, const std::string& world) {
  std::string text = "world " + sum_of(world) + "\n";
  for (RobotNumber i = 0; i < scene.robots(); ++i) {
    const Robot::Memory robot = scene.robot(i).memory();
    const Pose& at = robot.pose_in_world;
    const Pose& counted = robot.pose_in_odom;
    text += "robot " + std::to_string(i) +
            numbers({at.x, at.y, at.th, counted.x, counted.y, counted.th, robot.charge});
  }
  for (const Person& person : scene.persons())
    text += "person " + person.plan->look.name + numbers({person.at.x(), person.at.y()});
  for (const Box& box : scene.boxes())
    text += "box " + box.plan->look.name +
            numbers({box.pose_in_world.x, box.pose_in_world.y, box.pose_in_world.th});
  for (const Door& door : scene.doors())
    text += "door " + door.plan->look.name + (door.opens ? " open\n" : " closed\n");
  return text;
}

std::string resume(Scene& scene, const std::string& text, const std::string& file,
                   const std::string& world) {
  std::string without_place;
  bool same = false;
  const auto expect = [&](bool placed, const std::string& thing) {
    if (!placed)
      without_place += (without_place.empty() ? "" : ", ") + thing;
  };
  for (const Line& line : split_lines(text)) {
    LineReader words(file, line);
    const std::string_view kind = words.word("the kind of thing");
    if (kind == "world") {
      same = words.word("the world") == sum_of(world);
      if (!same)
        return "this world, which is another one";
      continue;
    }
    if (!same)
      words.fail("expected the world first");
    const std::string name(words.word("a name"));
    const std::string thing = std::string(kind) + " " + name;
    if (kind == "robot") {
      const Pose at = pose_in(words);
      const Pose counted = pose_in(words);
      const double charge = words.number("the battery's charge", 0.0, 1.0);
      const auto number = number_in<RobotNumber>(name);
      expect(
          number && *number < scene.robots() && scene.robot(*number).resume({at, counted, charge}),
          thing);
    } else if (kind == "person") {
      const double x = words.number("x");
      expect(scene.set_person(name, {x, words.number("y")}), thing);
    } else if (kind == "box") {
      expect(scene.set_box(name, pose_in(words)), thing);
    } else if (kind == "door") {
      expect(scene.set_door(name, words.word("open or closed") == "open"), thing);
    } else {
      words.fail("expected robot, person, box or door");
    }
  }
  return without_place;
}

}  // namespace saphira::sim
