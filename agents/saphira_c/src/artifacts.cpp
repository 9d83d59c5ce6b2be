// The Local Perceptual Space (manual 6.6), interpretation (6.7) and maps (6.9) for C programs.

#include <algorithm>
#include <cmath>

#include "os.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/lps/point.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::c {
namespace {

// The local pose of a point, or of a type that begins like one.
Pose local_of(const point& p) {
  return {p.x / 1000.0, p.y / 1000.0, p.th * Os::get().angle_unit};
}
template <class Artifact>
Pose global_of(const Artifact& p) {
  return {p.ax / 1000.0, p.ay / 1000.0, p.ath * Os::get().angle_unit};
}
template <class Artifact>
void set_local(Artifact& p, const Pose& pose) {
  put(pose, p.x, p.y, p.th);
}
template <class Artifact>
void set_global(Artifact& p, const Pose& pose) {
  put(pose, p.ax, p.ay, p.ath);
}

point system_point(int id) {
  point p{};
  p.type = POS;
  p.cat = SYSTEM;
  p.id = id;
  return p;
}
point global_origin = system_point(-1);
point robot_origin = system_point(-2);

}  // namespace

void Os::add_point(point* p) {
  for (const Listed& listed : points)
    if (listed.artifact == p)
      return;
  if (p->id == 0)
    for (p->id = 1000000; sfFindArtifact(p->id) != nullptr; ++p->id) {
    }
  // An artifact with only a local place gets its global one from that.
  const Pose global = global_of(*p);
  if (global == Pose{} && !(local_of(*p) == Pose{}))
    set_global(*p, compose(robot_in_global(), local_of(*p)));
  else
    set_local(*p, relative(robot_in_global(), global));
  points.push_back({p, {p->x, p->y, p->th}, {p->ax, p->ay, p->ath}});
}

/// The local place follows from the global one, which stays. If the program has written one of them
/// since, that one counts: 8.1 moves a target in the LPS.
void Os::update_points() {
  const Pose robot = robot_in_global();
  for (Listed& listed : points) {
    point& p = *listed.artifact;
    const std::array<float, 3> local{p.x, p.y, p.th};
    const std::array<float, 3> global{p.ax, p.ay, p.ath};
    const bool moved_local = local != listed.local;
    const bool moved_global = global != listed.global;
    if (moved_local && !moved_global)
      set_global(p, compose(robot, local_of(p)));
    set_local(p, relative(robot, global_of(p)));
    listed.local = {p.x, p.y, p.th};
    listed.global = {p.ax, p.ay, p.ath};
  }
  set_local(global_origin, relative(robot, Pose{}));
  set_global(robot_origin, robot);
  for (const auto& artifact : map_points_)
    set_local(*artifact, relative(robot, global_of(*artifact)));
}

void Os::move_robot(const Pose& by) {
  const Pose moved = compose(robot_in_global(), by);
  if (robot_ && robot_->found()) {
    robot_->place(moved);
  } else if (registration_) {
    const Request place{"place", {saphira::point("position", moved, Frame::map)}, "this program"};
    const Answer said = registration_->between({&place, 1}).front();
    if (said.code != AnswerCode::done)
      return say("sfMoveRobot: " + said.text, true);
  }
  odom_in_global = compose(moved, relative(robot_in_odom, Pose{}));
  update_points();
}

bool Os::load_map(const std::string& name) {
  registration::Core::Settings settings;
  try {
    const std::string path = find_file(configuration() + "/maps", name, ".map");
    settings.map = maps::load_map(path);
    settings.source = path;
    const std::lock_guard lock(mutex);
    if (robot_ && robot_->found())
      robot_->load_map(read_file(path), path);
  } catch (const std::exception& error) {
    say("sfLoadMapFile: " + std::string(error.what()), true);
    return false;
  }
  settings.start = robot_in_global();
  map_points_.clear();
  current_environment = nullptr;
  for (const maps::Feature& feature : settings.map.features)
    map_points_.push_back(std::make_unique<wall>(to_c(feature)));
  map_ = std::move(settings);
  update_points();
  return true;
}

wall to_c(const maps::Feature& feature) {
  wall shown{};
  shown.type = static_cast<pt_type>(feature.type);
  shown.cat = ARTIFACT;
  shown.viewable = TRUE;
  shown.id = static_cast<int>(feature.id);
  set_global(shown, feature.pose_in_map);
  shown.length = static_cast<float>(feature.length * 1000.0);
  shown.width = static_cast<float>(feature.width * 1000.0);
  return shown;
}

point* Os::find_on_map(int id) {
  for (const auto& artifact : map_points_)
    if (artifact->id == id)
      return reinterpret_cast<point*>(artifact.get());
  return nullptr;
}

/// Takes registration's changes to the map. A remaining artifact keeps its address: the program may
/// have a pointer to it.
void Os::read_map() {
  if (!registration_ || registration_->map_revision() == map_revision_)
    return;
  map_revision_ = registration_->map_revision();
  show_map(registration_->map());
}

void Os::show_map(const maps::Map& map) {
  std::vector<std::unique_ptr<wall>> next;
  for (const maps::Feature& feature : map.features) {
    const auto same = std::ranges::find_if(map_points_, [&](const auto& each) {
      return each && feature.id != 0 && each->id == static_cast<int>(feature.id);
    });
    const wall now = to_c(feature);
    if (same == map_points_.end()) {
      next.push_back(std::make_unique<wall>(now));
    } else {
      **same = now;
      next.push_back(std::move(*same));
    }
  }
  for (std::unique_ptr<wall>& gone : map_points_)
    if (gone) {
      gone->viewable = FALSE;
      gone->type = INVALID;
      gone_points_.push_back(std::move(gone));
    }
  map_points_ = std::move(next);
  update_points();
}

/// The micro-task occgrid_proc, with the others of interpretation.
void Os::interpret() {
  const std::lock_guard lock(mutex);
  if (const auto found = robot_ ? robot_->found() : std::nullopt) {
    percepts_.emplace();
    if (!suspended(test_wall_proc)) {
      percepts_->left_wall = found->left_wall;
      percepts_->right_wall = found->right_wall;
    }
    return;
  }
  const behaviors::RobotModel model = model_of(parameters);
  interpretation::Core::Inputs inputs{
      .cycle = cycle,
      .new_robot = interpretation_began_ ? nullptr : &model.lps.sonars,
      .new_frame = new_frame_,
      .pose_in_odom = robot_in_odom,
      .readings = readings_};
  interpretation_began_ = true;
  constexpr std::pair<void (*)(), const char*> parts[] = {
      {side_segment_proc, "side-segment"},
      {test_wall_proc, "test-wall"},
      {test_wall_break_proc, "test-wall-break"}};
  for (const auto& [ours, theirs] : parts) {
    Process* const part = interpretation_->processes().find(theirs);
    const bool off = find(ours) == nullptr || suspended(ours);
    if (part != nullptr && part->suspended() != off)
      off ? part->suspend() : part->resume();
  }
  interpretation_->processes().step(cycle);
  percepts_ = *interpretation_->step(inputs).output;
}

/// Takes the results of the registration service. The global frame is that of its map.
void Os::match_on_bus(const Found& found) {
  environment_ = found.environment;
  if (found.odom_in_map)
    odom_in_global = *found.odom_in_map;
  if (found.map && found.map != services_map_) {
    services_map_ = found.map;
    show_map(*found.map);
  }
  update_points();
}

/// The micro-task test_match_proc.
void Os::match() {
  const std::lock_guard lock(mutex);
  if (const auto found = robot_ ? robot_->found() : std::nullopt)
    return match_on_bus(*found);
  const behaviors::RobotModel model = model_of(parameters);
  const bool begins = !registration_ || map_;
  if (begins) {
    registration::Core::Settings settings;
    settings.start = robot_in_global();
    if (map_)
      settings = *std::exchange(map_, std::nullopt);
    settings.add_features = add_new_features != 0;
    settings.snap = snap_to_right_angle_grid != 0;
    registration_ = std::make_unique<registration::Core>(std::move(settings));
    map_revision_ = registration_->map_revision();
  }
  registration::Core::Inputs inputs;
  inputs.cycle = cycle;
  inputs.new_robot = begins ? &model.lps.sonars : nullptr;
  inputs.odom = odom_;
  inputs.pose_in_odom = robot_in_odom;
  if (percepts_)
    inputs.percepts = percepts_->percepts;
  inputs.readings = readings_;
  registration_->processes().step(cycle);
  const registration::Core::Outputs said = registration_->step(inputs);
  environment_ = said.environment;
  if (said.state == v1::REGISTRATION_TRACKING) {
    odom_in_global = compose(said.pose_in_map, relative(robot_in_odom, Pose{}));
    update_points();
  }
  for (const v1::Match& matched : said.matches)
    for (const auto& artifact : map_points_)
      if (matched.accepted && artifact->id == static_cast<int>(matched.artifact))
        artifact->matched = static_cast<unsigned>(cycle);
  read_map();
}

}  // namespace saphira::c

using saphira::Pose;
using saphira::c::Os;
using saphira::c::real;
namespace lps = saphira::lps;

namespace {

/// True where no pointer is NULL; otherwise reports the function.
template <class... Points>
bool given(const char* function, const Points*... p) {
  if (((p != nullptr) && ...))
    return true;
  Os::get().say(std::string(function) + ": a point is NULL", true);
  return false;
}

point* created(const Pose& local, const Pose& global) {
  point* const p = static_cast<point*>(std::calloc(1, sizeof(wall)));
  p->type = POS;
  p->cat = ARTIFACT;
  p->viewable = TRUE;
  saphira::c::set_local(*p, local);
  saphira::c::set_global(*p, global);
  return p;
}

int answer(const lps::Occupancy& found, int* x, int* y) {
  if (found.point && x != nullptr)
    *x = static_cast<int>(std::lround(found.point->x() * 1000.0));
  if (found.point && y != nullptr)
    *y = static_cast<int>(std::lround(found.point->y() * 1000.0));
  return static_cast<int>(std::lround(found.distance * 1000.0));
}

bool wrong(const char* function, const char* expected) {
  Os::get().say(std::string(function) + ": expected " + expected, true);
  return true;
}

}  // namespace

extern "C" {

point* sfGlobalOrigin = &saphira::c::global_origin;
point* sfRobotOrigin = &saphira::c::robot_origin;
point* current_environment = nullptr;
int add_new_features = TRUE;
int snap_to_right_angle_grid = TRUE;
float sfFrontMaxRange = 2500.0F;

void sfSetFrontBuffer(int n) {
  const std::lock_guard lock(Os::get().mutex);
  Os::get().lps.set_front_buffer(static_cast<std::size_t>(n > 0 ? n : 0));
}
void sfSetSideBuffer(int n) {
  const std::lock_guard lock(Os::get().mutex);
  Os::get().lps.set_side_buffer(static_cast<std::size_t>(n > 0 ? n : 0));
}

int sfOccBox(int xy, int cx, int cy, int h, int w, ...) {
  return sfOccBoxRet(xy, cx, cy, h, w, nullptr, nullptr);
}
int sfOccBoxRet(int xy, int cx, int cy, int h, int w, int* x, int* y) {
  if (xy != sfFRONT && xy != sfSIDES && wrong("sfOccBox", "sfFRONT or sfSIDES"))
    return 5000;
  const std::lock_guard lock(Os::get().mutex);
  return answer(Os::get().lps.box(xy == sfFRONT ? lps::Axis::front : lps::Axis::sides, cx / 1000.0,
                                  cy / 1000.0, h / 1000.0, w / 1000.0),
                x, y);
}
int sfOccPlane(int xy, int source, int d, int s1, int s2) {
  return sfOccPlaneRet(xy, source, d, s1, s2, nullptr, nullptr);
}
int sfOccPlaneRet(int xy, int source, int d, int s1, int s2, int* x, int* y) {
  if (xy != sfFRONT && xy != sfBACK && xy != sfLEFT && xy != sfRIGHT &&
      wrong("sfOccPlane", "a direction: sfFRONT, sfBACK, sfLEFT or sfRIGHT"))
    return 5000;
  if (source != sfFRONT && source != sfSIDES && source != sfALL &&
      wrong("sfOccPlane", "a source: sfFRONT, sfSIDES or sfALL"))
    return 5000;
  const lps::Direction direction = xy == sfFRONT  ? lps::Direction::front
                                   : xy == sfBACK ? lps::Direction::back
                                   : xy == sfLEFT ? lps::Direction::left
                                                  : lps::Direction::right;
  const lps::Source from = source == sfFRONT   ? lps::Source::front
                           : source == sfSIDES ? lps::Source::sides
                                               : lps::Source::all;
  const std::lock_guard lock(Os::get().mutex);
  return answer(
      Os::get().lps.plane(direction, from, std::abs(d) / 1000.0, s1 / 1000.0, s2 / 1000.0), x, y);
}

point* sfCreateLocalPoint(float x, float y, float th) {
  const std::lock_guard lock(Os::get().mutex);
  const Pose local{x / 1000.0, y / 1000.0, th * Os::get().angle_unit};
  return created(local, compose(Os::get().robot_in_global(), local));
}
point* sfCreateGlobalPoint(float x, float y, float th) {
  const std::lock_guard lock(Os::get().mutex);
  const Pose global{x / 1000.0, y / 1000.0, th * Os::get().angle_unit};
  return created(relative(Os::get().robot_in_global(), global), global);
}
void sfSetLocalCoords(point* p) {
  const std::lock_guard lock(Os::get().mutex);
  if (given("sfSetLocalCoords", p))
    saphira::c::set_local(*p, relative(Os::get().robot_in_global(), saphira::c::global_of(*p)));
}
void sfSetGlobalCoords(point* p) {
  const std::lock_guard lock(Os::get().mutex);
  if (given("sfSetGlobalCoords", p))
    saphira::c::set_global(*p, compose(Os::get().robot_in_global(), saphira::c::local_of(*p)));
}
void sfAddPoint(point* p) {
  const std::lock_guard lock(Os::get().mutex);
  if (given("sfAddPoint", p))
    Os::get().add_point(p);
}
void sfAddPointCheck(point* p) {
  const std::lock_guard lock(Os::get().mutex);
  if (given("sfAddPointCheck", p))
    Os::get().add_point(p);
}
void sfRemPoint(point* p) {
  const std::lock_guard lock(Os::get().mutex);
  if (given("sfRemPoint", p))
    std::erase_if(Os::get().points, [p](const auto& listed) { return listed.artifact == p; });
}
point* sfFindArtifact(int id) {
  const std::lock_guard lock(Os::get().mutex);
  for (const auto& listed : Os::get().points)
    if (listed.artifact->id == id)
      return listed.artifact;
  return Os::get().find_on_map(id);
}

#define ANGLE(name, function)                          \
  float name(float ang) {                              \
    const double unit = Os::get().angle_unit;          \
    return real(saphira::function(ang * unit) / unit); \
  }
ANGLE(sfNormAngle, norm_angle)
ANGLE(sfNorm2Angle, norm2_angle)
ANGLE(sfNorm3Angle, norm3_angle)
#undef ANGLE
float sfAddAngle(float a1, float a2) {
  return sfNormAngle(a1 + a2);
}
float sfSubAngle(float a1, float a2) {
  return sfNormAngle(a1 - a2);
}
float sfAdd2Angle(float a1, float a2) {
  return sfNorm2Angle(a1 + a2);
}
float sfSub2Angle(float a1, float a2) {
  return sfNorm2Angle(a1 - a2);
}

#define LOCAL(p) saphira::c::local_of(*(p))
float sfPointPhi(point* p) {
  return given("sfPointPhi", p) ? real(lps::phi(LOCAL(p)) / Os::get().angle_unit) : 0.0F;
}
float sfPointDist(point* p) {
  return given("sfPointDist", p) ? real(lps::distance(LOCAL(p)) * 1000.0) : 0.0F;
}
float sfPointNormalDist(point* p) {
  return given("sfPointNormalDist", p) ? real(lps::normal_distance(LOCAL(p)) * 1000.0) : 0.0F;
}
float sfPointDistPoint(point* p1, point* p2) {
  return given("sfPointDistPoint", p1, p2) ? real(lps::distance(LOCAL(p1), LOCAL(p2)) * 1000.0)
                                           : 0.0F;
}
float sfPointNormalDistPoint(point* p, point* q) {
  return given("sfPointNormalDistPoint", p, q)
             ? real(lps::normal_distance(LOCAL(p), LOCAL(q)) * 1000.0)
             : 0.0F;
}
void sfPointBaricenter(point* p1, point* p2, point* p3) {
  if (given("sfPointBaricenter", p1, p2, p3))
    saphira::c::set_local(*p3, lps::baricenter(LOCAL(p1), LOCAL(p2)));
}
void sfChangeVP(point* p1, point* p2, point* p3) {
  if (given("sfChangeVP", p1, p2, p3))
    saphira::c::set_local(*p3, lps::change_vp(LOCAL(p1), LOCAL(p2)));
}
void sfUnchangeVP(point* p1, point* p2, point* p3) {
  if (given("sfUnchangeVP", p1, p2, p3))
    saphira::c::set_local(*p3, lps::unchange_vp(LOCAL(p1), LOCAL(p2)));
}
float sfPointXo(point* p) {
  return given("sfPointXo", p) ? real(lps::xo(LOCAL(p)) * 1000.0) : 0.0F;
}
float sfPointYo(point* p) {
  return given("sfPointYo", p) ? real(lps::yo(LOCAL(p)) * 1000.0) : 0.0F;
}
float sfPointXoPoint(point* p, point* q) {
  return given("sfPointXoPoint", p, q) ? real(lps::xo(LOCAL(p), LOCAL(q)) * 1000.0) : 0.0F;
}
float sfPointYoPoint(point* p, point* q) {
  return given("sfPointYoPoint", p, q) ? real(lps::yo(LOCAL(p), LOCAL(q)) * 1000.0) : 0.0F;
}
void sfPointMove(point* p1, float dx, float dy, point* p2) {
  if (given("sfPointMove", p1, p2))
    saphira::c::set_local(*p2, lps::move(LOCAL(p1), dx / 1000.0, dy / 1000.0));
}
#undef LOCAL
void sfMoveRobot(float dx, float dy, float dth) {
  const std::lock_guard lock(Os::get().mutex);
  Os::get().move_robot({dx / 1000.0, dy / 1000.0, dth * Os::get().angle_unit});
}

float aligned_in_lane(point* lane_point, point* target, double near_angle, double far_angle) {
  if (!given("aligned_in_lane", lane_point, target))
    return 0.0F;
  // A lane has no direction of its own: the target gives it.
  const bool back = sfPointXoPoint(lane_point, target) < sfPointXo(lane_point);
  const double th = saphira::c::local_of(*lane_point).th;
  const double off = std::abs(saphira::norm2_angle(th + (back ? saphira::kPi : 0.0)));
  return down_straight(real(saphira::degrees(off)), real(near_angle), real(far_angle));
}

int sfLoadMapFile(const char* name) {
  const std::lock_guard lock(Os::get().mutex);
  if (name == nullptr)
    return Os::get().say("sfLoadMapFile: the name is NULL", true), -1;
  return Os::get().load_map(name) ? 0 : -1;
}

}  // extern "C"
