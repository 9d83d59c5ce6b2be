#include "saphira/sim/resume.hpp"

#include <map>
#include <vector>

#include "saphira/base/archive.hpp"
#include "saphira/base/text.hpp"

namespace saphira::sim {
namespace {

struct Places {
  std::string world;
  std::vector<Robot::Memory> robots;
  std::map<std::string, Vec2> persons;
  std::map<std::string, Pose> boxes;
  std::map<std::string, bool> open_doors;
};

}  // namespace

std::string places_text(const Scene& scene, const std::string& world) {
  Places places;
  places.world = world;
  for (RobotNumber i = 0; i < scene.robots(); ++i)
    places.robots.push_back(scene.robot(i).memory());
  for (const Person& person : scene.persons())
    places.persons[person.plan->look.name] = person.at;
  for (const Box& box : scene.boxes())
    places.boxes[box.plan->look.name] = box.pose_in_world;
  for (const Door& door : scene.doors())
    places.open_doors[door.plan->look.name] = door.opens;
  return saved(places);
}

std::string resume(Scene& scene, std::string_view text, const std::string& world) {
  const auto places = restored<Places>(text);
  if (places.world != world)
    return "this world, which is another one";
  std::vector<std::string> without_place;
  const auto expect = [&](bool placed, const std::string& thing) {
    if (!placed)
      without_place.push_back(thing);
  };
  for (RobotNumber i = 0; i < places.robots.size(); ++i)
    expect(i < scene.robots() && scene.robot(i).resume(places.robots[i]),
           "robot " + std::to_string(i));
  for (const auto& [name, at] : places.persons)
    expect(scene.set_person(name, at), "person " + name);
  for (const auto& [name, pose] : places.boxes)
    expect(scene.set_box(name, pose), "box " + name);
  for (const auto& [name, open] : places.open_doors)
    expect(scene.set_door(name, open), "door " + name);
  return joined(without_place);
}

}  // namespace saphira::sim
