#include "saphira/sim/view.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace saphira::sim {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kFarthest = 1e4;  // [m]

double rounded(double value) {
  return std::round(value * 1000.0) / 1000.0;
}
Json point(const Vec2& at) {
  return Json::array({rounded(at.x()), rounded(at.y())});
}
Json segment(const Segment& line) {
  return Json::array(
      {rounded(line.from.x()), rounded(line.from.y()), rounded(line.to.x()), rounded(line.to.y())});
}

const Json& member(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end())
    throw std::invalid_argument(std::string("\"") + name + "\" is missing");
  return *found;
}
double number(const Json& object, const char* name, double least, double most) {
  const Json& value = member(object, name);
  if (!value.is_number() || !(value.get<double>() >= least && value.get<double>() <= most))
    throw std::invalid_argument(std::string("\"") + name + "\": expected a number from " +
                                Json(least).dump() + " to " + Json(most).dump());
  return value.get<double>();
}
std::uint8_t byte_in(const Json& object, const char* name, int most = 255) {
  const double value = number(object, name, 0.0, most);
  if (value != std::floor(value))
    throw std::invalid_argument(std::string("\"") + name + "\": expected a whole number");
  return static_cast<std::uint8_t>(value);
}
std::string name_in(const Json& object, const char* name, bool may_miss = false) {
  if (may_miss && !object.contains(name))
    return {};
  const Json& value = member(object, name);
  // A name is no path: a person who may move the robot may not read files.
  if (!value.is_string() || value.get_ref<const std::string&>().size() > 100 ||
      value.get_ref<const std::string&>().find('/') != std::string::npos)
    throw std::invalid_argument(std::string("\"") + name +
                                "\": expected a name of at most 100 characters, without /");
  return value.get<std::string>();
}
bool truth(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_boolean())
    throw std::invalid_argument(std::string("\"") + name + "\": expected true or false");
  return value.get<bool>();
}
Vec2 place_in(const Json& object) {
  return {number(object, "x", -kFarthest, kFarthest), number(object, "y", -kFarthest, kFarthest)};
}
Pose pose_in(const Json& object) {
  const Vec2 at = place_in(object);
  return {at.x(), at.y(), norm2_angle(number(object, "th", -1e3, 1e3))};
}
Json describe_inputs(const Devices& devices) {
  Json analogs = Json::array();
  for (std::size_t port = 0; port < devices.analog_ports(); ++port)
    analogs.push_back(devices.analog(port));
  return {{"digital", devices.digital_input()}, {"analog", analogs}, {"timer", devices.timer()}};
}

Json describe_robot(const Server& server) {
  const Robot& robot = server.robot();
  const Pose& pose = robot.pose_in_world();
  Json beams = Json::array();
  for (const auto& [unit, range] : server.beams()) {
    const Pose sonar = compose(pose, unit);
    beams.push_back(segment({sonar.position(), transform(sonar, Vec2(range, 0.0))}));
  }
  Json out{{"x", rounded(pose.x)},
           {"y", rounded(pose.y)},
           {"th", rounded(pose.th)},
           {"name", server.parameters().name},
           {"radius", server.parameters().radius},
           {"velocity", rounded(robot.velocity())},
           {"rotation", rounded(robot.rotation_velocity())},
           {"contacts", robot.contacts()},
           {"connected", server.is_open()},
           {"inputs", describe_inputs(server.devices())},
           {"outputs", server.devices().digital_output()},
           {"sonars", beams}};
  if (server.parameters().head_reach > 0.0)
    out["head"] = rounded(server.devices().head());
  return out;
}

/// A person at the robot's inputs: bits of pins [digital], [5 V / 255] at a port [analog].
std::string set_input(const Json& wish, Devices& devices) {
  const bool digital = wish.contains("digital");
  const bool analog = wish.contains("analog");
  const std::uint8_t bits = digital ? byte_in(wish, "digital") : std::uint8_t{0};
  const std::uint8_t value = analog ? byte_in(wish, "analog") : std::uint8_t{0};
  const std::size_t port = wish.contains("port") ? byte_in(wish, "port") : 0;
  if (!digital && !analog)
    throw std::invalid_argument("expected \"digital\" or \"analog\"");
  if (port >= devices.analog_ports())
    return "this robot has the analog ports 0 to " + std::to_string(devices.analog_ports() - 1);
  if (digital)
    devices.set_digital_input(bits);
  if (analog)
    devices.set_analog(value, port);
  return {};
}

std::string line(const Json& all) {
  return all.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string describe_files(const Choice& choice) {
  return line({{"type", "files"}, {"worlds", choice.worlds}, {"robots", choice.robots}});
}

std::string describe_world(const World& world, const Choice& choice) {
  Json walls = Json::array();
  for (const Segment& wall : world.segments)
    walls.push_back(segment(wall));
  Json posts = Json::array();
  for (const PostPlan& post : world.movable.posts)
    posts.push_back({{"name", post.look.name},
                     {"x", rounded(post.at.x())},
                     {"y", rounded(post.at.y())},
                     {"radius", post.radius},
                     {"color", post.look.color}});
  return line({{"type", "world"},
               {"world", choice.world},
               {"width", world.width},
               {"height", world.height},
               {"walls", walls},
               {"posts", posts},
               {"worlds", choice.worlds},
               {"robots", choice.robots}});
}

std::string describe_scene(const Simulation& simulation, const Pacing& pacing) {
  const Scene& scene = simulation.scene();
  Json robots = Json::array();
  for (RobotNumber i = 0; i < simulation.size(); ++i)
    robots.push_back(describe_robot(simulation.server(i)));
  Json people = Json::array();
  for (const Person& person : scene.persons()) {
    people.push_back({{"name", person.plan->look.name},
                      {"x", rounded(person.at.x())},
                      {"y", rounded(person.at.y())},
                      {"th", rounded(person.heading)},
                      {"radius", person.plan->radius}});
    if (const auto line = arm(person))
      people.back()["arm"] = segment(*line);
  }
  Json doors = Json::array();
  for (const Door& door : scene.doors())
    doors.push_back({{"name", door.plan->look.name},
                     {"leaf", segment(scene.leaf(door))},
                     {"open", door.opens}});
  Json boxes = Json::array();
  for (const Box& box : scene.boxes()) {
    Json corners = Json::array();
    for (const Segment& side : scene.sides(box))
      corners.push_back(point(side.from));
    boxes.push_back({{"name", box.plan->look.name},
                     {"x", rounded(box.pose_in_world.x)},
                     {"y", rounded(box.pose_in_world.y)},
                     {"th", rounded(box.pose_in_world.th)},
                     {"corners", corners}});
  }
  return line({{"type", "scene"},
               {"time", rounded(static_cast<double>(scene.ticks()) * kTick)},
               {"paused", pacing.paused},
               {"rate", pacing.rate},
               {"robots", robots},
               {"people", people},
               {"doors", doors},
               {"boxes", boxes}});
}

std::string complaint(const std::string& text) {
  return line({{"type", "trouble"}, {"text", text}});
}

std::string obey(std::string_view request, Simulation& simulation, ViewedHost& host) {
  const Json wish = Json::parse(request, nullptr, /*allow_exceptions=*/false);
  if (!wish.is_object())
    throw std::invalid_argument("expected one JSON object");
  Scene& scene = simulation.scene();
  const std::string what = name_in(wish, "do");
  if (what == "place" || what == "input" || what == "disconnect") {
    const auto robot = static_cast<RobotNumber>(number(wish, "robot", 0.0, 1000.0));
    const Pose pose = what == "place" ? pose_in(wish) : Pose{};
    if (robot >= simulation.size())
      return "there is no robot " + std::to_string(robot);
    if (what == "place")
      return scene.robot(robot).place(pose) ? "" : "there is no room for it";
    return what == "input" ? set_input(wish, simulation.server(robot).devices())
                           : host.disconnect(robot);
  }
  if (what == "person" || what == "point" || what == "box" || what == "door") {
    const std::string name = name_in(wish, "name");
    if (what == "person")
      return scene.set_person(name, place_in(wish)) ? "" : "there is no room for " + name;
    if (what == "box")
      return scene.set_box(name, pose_in(wish)) ? "" : "there is no room for " + name;
    if (what == "door")
      return scene.set_door(name, truth(wish, "open")) ? "" : "there is no door " + name;
    std::optional<double> direction;  // [rad] in the world; none: the arm is lowered
    if (wish.contains("th"))
      direction = norm2_angle(number(wish, "th", -1e3, 1e3));
    return scene.set_arm(name, direction) ? "" : "there is no person " + name;
  }
  if (what == "pause")
    return host.pause(truth(wish, "on"));
  if (what == "step")
    return host.step_once();
  if (what == "rate")
    return host.set_rate(number(wish, "rate", 0.1, 100.0));
  if (what == "load")
    return host.load({name_in(wish, "world", true), name_in(wish, "robot", true)});
  if (what == "files")
    return host.list_files();
  throw std::invalid_argument(
      "\"do\": expected place, person, point, box, door, input, pause, step, rate, disconnect, "
      "load or files");
}

}  // namespace saphira::sim
