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
RobotNumber robot_in(const Json& object) {
  return static_cast<RobotNumber>(number(object, "robot", 0.0, 1000.0));
}

SetInput input_in(const Json& object) {
  SetInput input{robot_in(object), {}, 0, {}};
  if (object.contains("digital"))
    input.digital = byte_in(object, "digital");
  if (object.contains("analog"))
    input.analog = byte_in(object, "analog");
  if (object.contains("port"))
    input.port = byte_in(object, "port");
  if (!input.digital && !input.analog)
    throw std::invalid_argument("expected \"digital\" or \"analog\"");
  return input;
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

std::string set_input(Simulation& simulation, const SetInput& input) {
  if (input.robot >= simulation.size())
    return "there is no robot " + std::to_string(input.robot);
  Devices& devices = simulation.server(input.robot).devices();
  if (input.port >= devices.analog_ports())
    return "this robot has the analog ports 0 to " + std::to_string(devices.analog_ports() - 1);
  if (input.digital)
    devices.set_digital_input(*input.digital);
  if (input.analog)
    devices.set_analog(*input.analog, input.port);
  return {};
}

}  // namespace

std::string describe_files(const Choice& choice) {
  const Json all{{"type", "files"}, {"worlds", choice.worlds}, {"robots", choice.robots}};
  return all.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
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
  const Json all{{"type", "world"},         {"world", choice.world},  {"width", world.width},
                 {"height", world.height},  {"walls", walls},         {"posts", posts},
                 {"worlds", choice.worlds}, {"robots", choice.robots}};
  return all.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
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
  const Json all{
      {"type", "scene"},         {"time", rounded(static_cast<double>(scene.ticks()) * kTick)},
      {"paused", pacing.paused}, {"rate", pacing.rate},
      {"robots", robots},        {"people", people},
      {"doors", doors},          {"boxes", boxes}};
  return all.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string complaint(const std::string& text) {
  const Json all{{"type", "trouble"}, {"text", text}};
  return all.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Wish parse_wish(std::string_view text) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object())
    throw std::invalid_argument("expected one JSON object");
  const std::string what = name_in(json, "do");
  if (what == "place")
    return PlaceRobot{robot_in(json), pose_in(json)};
  if (what == "person")
    return PlacePerson{name_in(json, "name"), place_in(json)};
  if (what == "point") {
    RaiseArm wish{name_in(json, "name"), {}};
    if (json.contains("th"))
      wish.direction_in_world = norm2_angle(number(json, "th", -1e3, 1e3));
    return wish;
  }
  if (what == "box")
    return PlaceBox{name_in(json, "name"), pose_in(json)};
  if (what == "door")
    return SetDoor{name_in(json, "name"), truth(json, "open")};
  if (what == "input")
    return input_in(json);
  if (what == "pause")
    return Pause{truth(json, "on")};
  if (what == "step")
    return StepOnce{};
  if (what == "rate")
    return SetRate{number(json, "rate", 0.1, 100.0)};
  if (what == "disconnect")
    return Disconnect{robot_in(json)};
  if (what == "load")
    return Load{name_in(json, "world", true), name_in(json, "robot", true)};
  if (what == "files")
    return ListFiles{};
  throw std::invalid_argument(
      "\"do\": expected place, person, point, box, door, input, pause, step, rate, disconnect, "
      "load or files");
}

std::string change_scene(Simulation& simulation, const Wish& wish) {
  Scene& scene = simulation.scene();
  if (const auto* place = std::get_if<PlaceRobot>(&wish)) {
    if (place->robot >= scene.robots())
      return "there is no robot " + std::to_string(place->robot);
    return scene.robot(place->robot).place(place->pose_in_world) ? "" : "there is no room for it";
  }
  if (const auto* person = std::get_if<PlacePerson>(&wish))
    return scene.set_person(person->name, person->at) ? "" : "there is no room for " + person->name;
  if (const auto* raise = std::get_if<RaiseArm>(&wish))
    return scene.set_arm(raise->name, raise->direction_in_world)
               ? ""
               : "there is no person " + raise->name;
  if (const auto* box = std::get_if<PlaceBox>(&wish))
    return scene.set_box(box->name, box->pose_in_world) ? "" : "there is no room for " + box->name;
  if (const auto* door = std::get_if<SetDoor>(&wish))
    return scene.set_door(door->name, door->open) ? "" : "there is no door " + door->name;
  if (const auto* input = std::get_if<SetInput>(&wish))
    return set_input(simulation, *input);
  return {};
}

}  // namespace saphira::sim
