#include "saphira/viewer/scene.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "saphira/base/base64.hpp"

namespace saphira::viewer {

namespace {

using nlohmann::json;

enum Which : std::size_t { kTransforms, kPose, kSonars, kGrid, kScene, kLog, kCamera };

constexpr std::array<DrawnChannel, 7> kChannels{{{"viewer/transforms", "foxglove.FrameTransforms"},
                                                 {"viewer/pose", "foxglove.PoseInFrame"},
                                                 {"viewer/sonars", "foxglove.PointCloud"},
                                                 {"viewer/grid", "foxglove.Grid"},
                                                 {"viewer/scene", "foxglove.SceneUpdate"},
                                                 {"viewer/log", "foxglove.Log"},
                                                 {"viewer/camera", "foxglove.CompressedImage"}}};

// Numbers of the format.
constexpr int kUint8 = 1;
constexpr int kFloat32 = 7;
constexpr int kLineList = 2;

constexpr double kLetters = 0.4;  // [m] of drawn names

json time_of(std::int64_t time_ns) {
  return {{"sec", time_ns / 1'000'000'000}, {"nsec", time_ns % 1'000'000'000}};
}

json vector_of(double x, double y, double z = 0.0) {
  return {{"x", x}, {"y", y}, {"z", z}};
}

json turn_of(double th) {
  return {{"x", 0.0}, {"y", 0.0}, {"z", std::sin(th / 2)}, {"w", std::cos(th / 2)}};
}

json pose_of(const v1::Pose2& pose, double z = 0.0) {
  return {{"position", vector_of(pose.x, pose.y, z)}, {"orientation", turn_of(pose.th)}};
}

json color_of(double red, double green, double blue, double alpha = 1.0) {
  return {{"r", red}, {"g", green}, {"b", blue}, {"a", alpha}};
}

json field_of(const char* name, std::size_t offset, int type) {
  return {{"name", name}, {"offset", offset}, {"type", type}};
}

json transform_of(const char* parent, const char* child, const v1::Pose2& pose, std::int64_t ns) {
  return {{"timestamp", time_of(ns)},
          {"parent_frame_id", parent},
          {"child_frame_id", child},
          {"translation", vector_of(pose.x, pose.y)},
          {"rotation", turn_of(pose.th)}};
}

json entity_of(const char* name, const char* frame, bool moves_with_frame, std::int64_t ns) {
  json made{{"timestamp", time_of(ns)},
            {"frame_id", frame},
            {"id", name},
            {"lifetime", time_of(0)},
            {"frame_locked", moves_with_frame}};
  for (const char* const list : {"metadata", "arrows", "cubes", "spheres", "cylinders", "lines",
                                 "triangles", "texts", "models"})
    made[list] = json::array();
  return made;
}

json lines_of(json points, double thickness, json color) {
  return {{"type", kLineList},        {"pose", pose_of({})},         {"thickness", thickness},
          {"scale_invariant", false}, {"points", std::move(points)}, {"color", std::move(color)},
          {"colors", json::array()},  {"indices", json::array()}};
}

json text_of(const std::string& text, const v1::Pose2& at) {
  return {{"pose", pose_of({at.x, at.y, 0.0}, 0.1)},
          {"billboard", true},
          {"font_size", kLetters},
          {"scale_invariant", false},
          {"color", color_of(0.2, 0.2, 0.2)},
          {"text", text}};
}

json cylinder_of(double radius, double height) {
  return {{"pose", pose_of({}, height / 2)},
          {"size", vector_of(2 * radius, 2 * radius, height)},
          {"bottom_scale", 1.0},
          {"top_scale", 1.0},
          {"color", color_of(0.75, 0.1, 0.1, 0.8)}};
}

json arrow_of(double length) {
  return {{"pose", pose_of({}, 0.3)}, {"shaft_length", length * 0.6},
          {"shaft_diameter", 0.04},   {"head_length", length * 0.4},
          {"head_diameter", 0.12},    {"color", color_of(0.1, 0.1, 0.1)}};
}

json points_of(const std::vector<Line>& lines) {
  json points = json::array();
  for (const Line& line : lines)
    for (const Vec2& end : {line.from, line.to})
      points.push_back(vector_of(end.x(), end.y()));
  return points;
}

DrawnMessage message(Which channel, const json& content) {
  return {channel,
          content.dump(-1, ' ', false, json::error_handler_t::replace)};  // texts of programs
}

DrawnMessage scene(const json& entity) {
  return message(kScene, {{"deletions", json::array()}, {"entities", json::array({entity})}});
}

/// A message with one of everything, for its schema.
json example(const std::string& type) {
  const json stamp = time_of(0);
  if (type == "foxglove.FrameTransforms")
    return {{"transforms", json::array({transform_of("", "", {}, 0)})}};
  if (type == "foxglove.PoseInFrame")
    return {{"timestamp", stamp}, {"frame_id", ""}, {"pose", pose_of({})}};
  if (type == "foxglove.PointCloud")
    return json::parse(Scene::take(v1::SonarBuckets(), 0).front().json);
  if (type == "foxglove.Grid")
    return json::parse(Scene(0.0).take(v1::GridTile(), false, 1).front().json);
  if (type == "foxglove.Log")
    return json::parse(Scene::take(v1::LogRecord()).front().json);
  if (type == "foxglove.CompressedImage")
    return json::parse(Scene::take(v1::CameraPicture(), 1).front().json);
  json entity = entity_of("", "", false, 0);
  entity["metadata"].push_back({{"key", ""}, {"value", ""}});
  entity["arrows"].push_back(arrow_of(1.0));
  entity["cylinders"].push_back(cylinder_of(1.0, 1.0));
  json line = lines_of(json::array({vector_of(0.0, 0.0)}), 0.1, color_of(0.0, 0.0, 0.0));
  line["colors"].push_back(color_of(0.0, 0.0, 0.0));
  line["indices"].push_back(0);
  entity["lines"].push_back(line);
  entity["texts"].push_back(text_of("", {}));
  for (const char* const unused : {"cubes", "spheres", "triangles", "models"})
    entity[unused].push_back({{"color", color_of(0.0, 0.0, 0.0)}});
  return {{"deletions", json::array({{{"timestamp", stamp}, {"type", 0}, {"id", ""}}})},
          {"entities", json::array({entity})}};
}

json schema_of_example(const std::string& name, const json& value) {
  if (value.is_object()) {
    json made{{"type", "object"}, {"properties", json::object()}};
    if (value.size() == 2 && value.contains("sec"))
      made["title"] = name == "lifetime" ? "duration" : "time";
    for (const auto& [member, each] : value.items())
      made["properties"][member] = schema_of_example(member, each);
    return made;
  }
  if (value.is_array())
    return {{"type", "array"}, {"items", schema_of_example(name, value.front())}};
  if (name == "data")
    return {{"type", "string"}, {"contentEncoding", "base64"}};
  return {{"type", value.is_string()         ? "string"
                   : value.is_boolean()      ? "boolean"
                   : value.is_number_float() ? "number"
                                             : "integer"}};
}

}  // namespace

std::span<const DrawnChannel> drawn_channels() {
  return kChannels;
}

std::string drawn_schema(const std::string& type) {
  json schema = schema_of_example("", example(type));
  schema["title"] = type;
  return schema.dump();
}

Scene::Scene(double grid_period) : tiles_(grid_period) {}

Scene::Messages Scene::take(const v1::RobotState& state, std::int64_t time_ns) {
  json transforms = json::array();
  const Place place = placing_.of(state);
  if (place.odom_in_map)
    transforms.push_back(transform_of("map", "odom", *place.odom_in_map, time_ns));
  transforms.push_back(transform_of("odom", "base_link", state.pose_in_odom, time_ns));
  return {message(kTransforms, {{"transforms", std::move(transforms)}}),
          message(kPose, {{"timestamp", time_of(time_ns)},
                          {"frame_id", place.odom_in_map ? "map" : "odom"},
                          {"pose", pose_of(place.pose)}})};
}

Scene::Messages Scene::take(const v1::RobotDescription& description, std::int64_t time_ns) {
  json body = entity_of("robot", "base_link", true, time_ns);
  body["cylinders"].push_back(cylinder_of(description.radius, 0.25));
  body["arrows"].push_back(arrow_of(2 * description.radius));
  return {scene(body)};
}

Scene::Messages Scene::take(const v1::SonarBuckets& sonars, std::int64_t time_ns) {
  return {message(kSonars, {{"timestamp", time_of(time_ns)},
                            {"frame_id", "odom"},
                            {"pose", pose_of({})},
                            {"point_stride", kEchoBytes},
                            {"fields", json::array({field_of("x", 0, kFloat32),
                                                    field_of("y", sizeof(float), kFloat32),
                                                    field_of("z", 2 * sizeof(float), kFloat32)})},
                            {"data", base64(echoes_of(sonars))}})};
}

Scene::Messages Scene::take(const v1::Perception& perception, std::int64_t time_ns) {
  const Plan plan = plan_of(perception);
  json entity = entity_of("percepts", "odom", false, time_ns);
  entity["lines"] = {lines_of(points_of(plan.walls), 0.05, color_of(0.1, 0.3, 0.9)),
                     lines_of(points_of(plan.openings), 0.05, color_of(0.9, 0.5, 0.0))};
  return {scene(entity)};
}

Scene::Messages Scene::take(const v1::GridTile& tile, bool disposed, std::int64_t time_ns) {
  const std::optional<Cells> grid = tiles_.take(tile, disposed, time_ns);
  if (!grid)
    return {};
  return {message(kGrid, {{"timestamp", time_of(time_ns)},
                          {"frame_id", "odom"},
                          {"pose", pose_of({grid->x, grid->y, 0.0})},
                          {"column_count", grid->columns},
                          {"cell_size", {{"x", grid->resolution}, {"y", grid->resolution}}},
                          {"row_stride", grid->columns},
                          {"cell_stride", 1},
                          {"fields", json::array({field_of("occupied", 0, kUint8)})},
                          {"data", base64(grid->cells)}})};
}

Scene::Messages Scene::take(const v1::FloorMap& map, std::int64_t time_ns) {
  const Plan plan = plan_of(map);
  json entity = entity_of("map", "map", false, time_ns);
  for (const Label& name : plan.names)
    entity["texts"].push_back(text_of(name.text, name.at));
  entity["lines"] = {lines_of(points_of(plan.walls), 0.05, color_of(0.3, 0.3, 0.3)),
                     lines_of(points_of(plan.openings), 0.04, color_of(0.1, 0.6, 0.2))};
  return {scene(entity)};
}

Scene::Messages Scene::take(const v1::LogRecord& record) {
  return {message(kLog, {{"timestamp", time_of(record.time_ns)},
                         {"level", static_cast<int>(record.level) + 1},
                         {"message", record.text},
                         {"name", record.name},
                         {"file", ""},
                         {"line", 0}})};
}

Scene::Messages Scene::take(const v1::CameraPicture& picture, std::int64_t time_ns) {
  return {message(kCamera, {{"timestamp", time_of(time_ns)},
                            {"frame_id", "base_link"},
                            {"data", base64(picture.jpeg)},
                            {"format", "jpeg"}})};
}

}  // namespace saphira::viewer
