#include "saphira/ros2/outward.hpp"

#include <cmath>
#include <limits>

#include "geometry/shell/convert.hpp"
#include "saphira/base/format.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::ros2 {

namespace {

constexpr const char* kMapFrame = "map";
constexpr const char* kOdomFrame = "odom";
constexpr const char* kRobotFrame = "base_link";

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr double kSonarHeight = 0.2;           // [m]
constexpr float kBeam = 0.26F;                 // [rad] of a Polaroid transducer
constexpr float kNearest = 0.1F;               // [m] that it hears
constexpr float kFarthest = 5.0F;              // [m] manual 5.1.3: 5000 mm is no echo
constexpr double kPathStep = 0.05;             // [m]
constexpr std::size_t kLongestPath = 2000;     // poses
constexpr double kCell = 0.05;                 // [m] of the map
constexpr double kBorder = 0.5;                // [m] around it
constexpr std::size_t kMostCells = 4'000'000;  // of the map
constexpr double kOldStatus = situation::kLostAge;

// Numbers of the messages.
constexpr std::int8_t kUnknown = -1;
constexpr std::int8_t kFree = 0;
constexpr std::int8_t kOccupied = 100;
constexpr std::uint8_t kFloat32 = 7;
constexpr std::int32_t kCylinder = 3;
constexpr std::int32_t kLineList = 5;
constexpr std::int32_t kText = 9;
constexpr std::int32_t kDelete = 2;

Quaternion turn_of(double th) {
  return {0.0, 0.0, std::sin(th / 2), std::cos(th / 2)};
}

Header header_of(const char* frame, std::int64_t time_ns) {
  return {time_of(time_ns), frame};
}

Transform transform_of(const char* parent, const std::string& child, const v1::Pose2& pose,
                       std::int64_t time_ns, double z = 0.0) {
  return {header_of(parent, time_ns), child, {{pose.x, pose.y, z}, turn_of(pose.th)}};
}

std::string sonar_frame(std::uint8_t sonar) {
  return "sonar_" + std::to_string(sonar);
}

Marker marker(const char* space, std::int32_t id, std::int32_t type, const char* frame,
              std::int64_t time_ns, const Color& color) {
  return {.header = header_of(frame, time_ns),
          .ns = space,
          .id = id,
          .type = type,
          .pose = pose_of({}),
          .color = color};
}

/// Without lines: their withdrawal.
Marker lines(const char* space, std::int32_t id, const char* frame, std::int64_t time_ns,
             const std::vector<viewer::Line>& all, const Color& color) {
  Marker made = marker(space, id, kLineList, frame, time_ns, color);
  made.scale.x = kCell;
  for (const viewer::Line& line : all)
    for (const Vec2& end : {line.from, line.to})
      made.points.push_back({end.x(), end.y(), 0.0});
  if (all.empty())
    made.action = kDelete;
  return made;
}

Marker text(const char* space, std::int32_t id, const char* frame, std::int64_t time_ns,
            const std::string& words, const v1::Pose2& at, double height) {
  Marker made = marker(space, id, kText, frame, time_ns, {0.2F, 0.2F, 0.2F, 1.0F});
  made.pose.position = {at.x, at.y, height};
  made.scale.z = 0.3;
  made.text = words;
  return made;
}

/// A map that is drawn cell by cell.
class Canvas {
 public:
  explicit Canvas(const std::vector<viewer::Line>& walls) {
    Vec2 low = walls.front().from;
    Vec2 high = low;
    for (const viewer::Line& wall : walls)
      for (const Vec2& end : {wall.from, wall.to}) {
        low = low.cwiseMin(end);
        high = high.cwiseMax(end);
      }
    corner_ = low - Vec2(kBorder, kBorder);
    const Vec2 size = high - low + 2 * Vec2(kBorder, kBorder);
    while (size.x() / cell_ * (size.y() / cell_) > static_cast<double>(kMostCells))
      cell_ *= 2;
    columns_ = static_cast<std::size_t>(std::ceil(size.x() / cell_));
    rows_ = static_cast<std::size_t>(std::ceil(size.y() / cell_));
    cells_.assign(columns_ * rows_, kUnknown);
  }

  void line(const Vec2& from, const Vec2& to, std::int8_t value) {
    const int steps = static_cast<int>(std::ceil((to - from).norm() / (cell_ / 2))) + 1;
    for (int i = 0; i <= steps; ++i)
      put(from + (to - from) * (static_cast<double>(i) / steps), value);
  }
  /// The floor of a room or corridor.
  void floor(const v1::MapArtifact& artifact) {
    const Pose middle = from_bus(artifact.pose_in_map);
    for (double y = -artifact.width / 2; y <= artifact.width / 2; y += cell_ / 2)
      line(transform(middle, Vec2(-artifact.length / 2, y)),
           transform(middle, Vec2(artifact.length / 2, y)), kFree);
  }
  OccupancyGrid grid(std::int64_t time_ns) && {
    return {header_of(kMapFrame, time_ns),
            {time_of(time_ns), static_cast<float>(cell_), static_cast<std::uint32_t>(columns_),
             static_cast<std::uint32_t>(rows_), pose_of({corner_.x(), corner_.y(), 0.0})},
            std::move(cells_)};
  }

 private:
  void put(const Vec2& point, std::int8_t value) {
    const Vec2 place = (point - corner_) / cell_;
    if (place.x() < 0.0 || place.y() < 0.0)
      return;
    const auto column = static_cast<std::size_t>(place.x());
    const auto row = static_cast<std::size_t>(place.y());
    if (column < columns_ && row < rows_)
      cells_[row * columns_ + column] = value;
  }

  double cell_ = kCell;
  Vec2 corner_{0.0, 0.0};
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<std::int8_t> cells_;
};

DiagnosticStatus diagnosis(const situation::Program& program) {
  const v1::ServiceStatus& status = program.status;
  DiagnosticStatus made{
      .level = static_cast<std::uint8_t>(status.state == v1::SERVICE_RUNNING ? 0 : 1),
      .name = "saphira: " + status.name,
      .message = status.reason.empty() ? situation::name_of(status.state) : status.reason,
      .hardware_id = status.host};
  if (program.age > kOldStatus) {
    made.level = 3;
    made.message = "silent for " + situation::seconds_text(program.age);
  }
  made.values = {{"late cycles", std::to_string(status.late_cycles)},
                 {"step [ms]", format("%.2f", status.step_ms_max)},
                 {"processor [%]", format("%.1f", status.cpu_percent)},
                 {"memory [MB]", format("%.1f", status.rss_mb)}};
  return made;
}

DiagnosticStatus diagnosis(const v1::Grant& grant) {
  const int level = grant.estopped ? 2 : grant.guard >= v1::GUARD_SLOW ? 1 : 0;
  return {.level = static_cast<std::uint8_t>(level),
          .name = "saphira: drive",
          .message = situation::describe(grant),
          .values = {{"driver", grant.source},
                     {"role", situation::name_of(grant.role)},
                     {"guard", situation::name_of(grant.guard)}}};
}

}  // namespace

Time time_of(std::int64_t time_ns) {
  return {static_cast<std::int32_t>(time_ns / kSecond),
          static_cast<std::uint32_t>(time_ns % kSecond)};
}

Pose3 pose_of(const v1::Pose2& pose) {
  return {{pose.x, pose.y, 0.0}, turn_of(pose.th)};
}

Messages Outward::take(const v1::RobotState& state, std::int64_t time_ns) {
  Messages made;
  place_ = placing_.of(state);
  Odometry odom{.header = header_of(kOdomFrame, time_ns), .child_frame_id = kRobotFrame};
  odom.pose.pose = pose_of(state.pose_in_odom);
  odom.twist.twist.linear.x = state.velocity;
  odom.twist.twist.angular.z = state.rotation_velocity;
  made.odom = std::move(odom);
  made.tf.emplace();
  if (with_map_ && place_->odom_in_map)
    made.tf->transforms.push_back(
        transform_of(kMapFrame, kOdomFrame, *place_->odom_in_map, time_ns));
  made.tf->transforms.push_back(transform_of(kOdomFrame, kRobotFrame, state.pose_in_odom, time_ns));
  for (const v1::SonarReading& reading : state.sonars) {
    const float range = reading.echo ? reading.range : std::numeric_limits<float>::infinity();
    made.sonar.push_back({header_of(sonar_frame(reading.sonar).c_str(), time_ns), 0, kBeam,
                          kNearest, kFarthest, range, 0.0F});
  }
  if (state.odom != odom_) {
    path_.poses.clear();
    odom_ = state.odom;
  }
  const Pose3 here = pose_of(state.pose_in_odom);
  if (path_.poses.empty() ||
      std::hypot(here.position.x - path_.poses.back().pose.position.x,
                 here.position.y - path_.poses.back().pose.position.y) >= kPathStep)
    path_.poses.push_back({header_of(kOdomFrame, time_ns), here});
  if (path_.poses.size() > kLongestPath)
    path_.poses.erase(path_.poses.begin());
  if (time_ns - slow_ns_ < kSecond && time_ns >= slow_ns_)
    return made;
  slow_ns_ = time_ns;
  path_.header = header_of(kOdomFrame, time_ns);
  made.path = path_;
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  BatteryState battery;
  battery.header = header_of(kRobotFrame, time_ns);
  battery.voltage = static_cast<float>(state.battery);
  for (float* const value : {&battery.temperature, &battery.current, &battery.charge,
                             &battery.capacity, &battery.design_capacity, &battery.percentage})
    *value = unknown;
  battery.present = true;
  made.battery = std::move(battery);
  return made;
}

Messages Outward::take(const v1::RobotDescription& description, std::int64_t time_ns) {
  Messages made;
  made.tf_static.emplace();
  for (const v1::SonarPose& sonar : description.sonars)
    made.tf_static->transforms.push_back(transform_of(kRobotFrame, sonar_frame(sonar.sonar),
                                                      sonar.pose_in_robot, time_ns, kSonarHeight));
  Marker body = marker("robot", 0, kCylinder, kRobotFrame, time_ns, {0.75F, 0.1F, 0.1F, 0.8F});
  body.scale = {2 * description.radius, 2 * description.radius, 2 * kSonarHeight};
  body.frame_locked = true;
  made.markers = MarkerArray{{std::move(body)}};
  return made;
}

Messages Outward::take(const v1::Registration& registration, std::int64_t time_ns) {
  placing_.take(registration);
  if (!with_map_ || registration.state != v1::REGISTRATION_TRACKING)
    return {};
  PoseWithCovarianceStamped pose{.header = header_of(kMapFrame, time_ns)};
  pose.pose.pose = pose_of(registration.pose_in_map);
  const v1::Covariance2& c = registration.covariance;
  auto& all = pose.pose.covariance;  // of x, y, z and three turns, by rows
  all[0] = c.xx;
  all[1] = all[6] = c.xy;
  all[7] = c.yy;
  all[5] = all[30] = c.xth;
  all[11] = all[31] = c.yth;
  all[35] = c.thth;
  Messages made;
  made.pose = std::move(pose);
  return made;
}

Messages Outward::take(const v1::FloorMap& map, std::int64_t time_ns) const {
  if (!with_map_)
    return {};
  Messages made;
  const viewer::Plan plan = viewer::plan_of(map);
  made.map_markers.emplace();
  std::vector<Marker>& markers = made.map_markers->markers;
  markers.push_back(lines("walls", 0, kMapFrame, time_ns, plan.walls, {0.3F, 0.3F, 0.3F, 1.0F}));
  markers.push_back(lines("doors", 0, kMapFrame, time_ns, plan.openings, {0.1F, 0.6F, 0.2F, 1.0F}));
  std::int32_t id = 0;
  for (const viewer::Label& name : plan.names)
    markers.push_back(text("places", id++, kMapFrame, time_ns, name.text, name.at, 0.1));
  if (plan.walls.empty())
    return made;
  Canvas canvas(plan.walls);
  for (const v1::MapArtifact& artifact : map.artifacts)
    if (artifact.type == v1::ARTIFACT_CORRIDOR || artifact.type == v1::ARTIFACT_OFFICE ||
        artifact.type == v1::ARTIFACT_JUNCTION)
      canvas.floor(artifact);
  for (const viewer::Line& opening : plan.openings)
    canvas.line(opening.from, opening.to, kFree);
  for (const viewer::Line& wall : plan.walls)
    canvas.line(wall.from, wall.to, kOccupied);
  made.map = std::move(canvas).grid(time_ns);
  return made;
}

Messages Outward::take(const v1::GridTile& tile, bool disposed, std::int64_t time_ns) {
  Messages made;
  const std::optional<viewer::Cells> cells = tiles_.take(tile, disposed, time_ns);
  if (!cells)
    return made;
  OccupancyGrid grid{
      .header = header_of(kOdomFrame, time_ns),
      .info = {time_of(time_ns), static_cast<float>(cells->resolution),
               static_cast<std::uint32_t>(cells->columns), static_cast<std::uint32_t>(cells->rows),
               pose_of({cells->x, cells->y, 0.0})}};
  for (const char cell : cells->cells) {
    const auto value = static_cast<std::uint8_t>(cell);
    grid.data.push_back(value > 200 ? kUnknown : static_cast<std::int8_t>(value / 2));
  }
  made.local_map = std::move(grid);
  return made;
}

Messages Outward::take(const v1::SonarBuckets& sonars, std::int64_t time_ns) {
  const std::string points = viewer::echoes_of(sonars);
  PointCloud2 cloud{.header = header_of(kOdomFrame, time_ns),
                    .height = 1,
                    .width = static_cast<std::uint32_t>(points.size() / viewer::kEchoBytes)};
  for (std::uint32_t i = 0; i < 3; ++i)
    cloud.fields.push_back({std::string(1, "xyz"[i]), 4 * i, kFloat32, 1});
  cloud.point_step = viewer::kEchoBytes;
  cloud.row_step = static_cast<std::uint32_t>(points.size());
  cloud.data.assign(points.begin(), points.end());
  cloud.is_dense = true;
  Messages made;
  made.echoes = std::move(cloud);
  return made;
}

Messages Outward::take(const v1::Perception& perception, std::int64_t time_ns) {
  const viewer::Plan plan = viewer::plan_of(perception);
  Messages made;
  made.markers = MarkerArray{
      {lines("percepts", 0, kOdomFrame, time_ns, plan.walls, {0.1F, 0.3F, 0.9F, 1.0F}),
       lines("percepts", 1, kOdomFrame, time_ns, plan.openings, {0.9F, 0.5F, 0.0F, 1.0F})}};
  return made;
}

Messages Outward::why(const std::string& sentence, std::int64_t time_ns) {
  Messages made;
  made.markers = MarkerArray{{text("why", 0, kRobotFrame, time_ns, sentence, {}, 1.0)}};
  return made;
}

Messages Outward::diagnostics(const situation::Situation& situation, std::int64_t time_ns) {
  Messages made;
  made.diagnostics.emplace();
  made.diagnostics->header = header_of("", time_ns);
  for (const situation::Program& program : situation.programs)
    made.diagnostics->status.push_back(diagnosis(program));
  if (situation.grant)
    made.diagnostics->status.push_back(diagnosis(*situation.grant));
  return made;
}

}  // namespace saphira::ros2
