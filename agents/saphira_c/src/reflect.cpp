// From a robot's state to a C program's view of it.

#include <algorithm>
#include <cmath>

#include "os.hpp"

namespace saphira::c {
namespace {

std::mutex of_newest;
View newest;  // under that mutex
std::uint64_t newest_number = 0;

struct Mine {
  View view;
  std::uint64_t number = 0;
  bool owned = false;
};
Mine& mine() {
  thread_local const std::unique_ptr<Mine> of_thread = std::make_unique<Mine>();
  return *of_thread;
}

/// Takes the next view. A sonar reading counts as new for each thread once.
void take(Mine& of_thread, const View& next) {
  const View before = of_thread.view;
  of_thread.view = next;
  for (std::size_t i = 0; i < next.sonars.size(); ++i) {
    const bool same = next.read[i] == before.read[i];
    of_thread.view.sonars[i].snew = same ? before.sonars[i].snew : 0xFFFF;
  }
}

float mm(double meters) {
  return static_cast<float>(meters * 1000.0);
}

cbuf to_c(const lps::SonarBuffer& buffer) {
  cbuf shown{};
  const std::vector<lps::SonarEntry>& entries = buffer.entries();
  shown.limit = static_cast<int>(std::min<std::size_t>(buffer.limit(), CBUF_LEN));
  shown.end = static_cast<int>(std::min<std::size_t>(entries.size(), CBUF_LEN));
  for (std::size_t i = 0; i < static_cast<std::size_t>(shown.end); ++i) {
    shown.valid[i] = entries[i].valid ? 1 : 0;
    if (entries[i].valid) {
      shown.xbuf[i] = mm(entries[i].in_robot.x());
      shown.ybuf[i] = mm(entries[i].in_robot.y());
    }
  }
  return shown;
}

int status_of(const protocol::Information& information) {
  if (information.left_stalled && information.right_stalled)
    return STATUS_NO_HIGH_POWER;
  return information.motors == protocol::Motors::kMoving ? STATUS_MOVING : STATUS_STOPPED;
}

void show_vision(View& next, const protocol::VisionPacket& seen) {
  for (std::size_t i = 0; i < next.vision.size(); ++i) {
    const protocol::VisionChannel& channel = seen.channels[i];
    next.vision[i] = {static_cast<int>(channel.mode),  channel.x,      channel.y,
                      static_cast<int>(channel.area),  channel.height, channel.width,
                      static_cast<int>(channel.first), channel.count};
  }
}

wall to_c(const lps::Percept& percept, const Pose& robot_in_odom, const Pose& odom_in_global) {
  wall shown{};
  put(relative(robot_in_odom, percept.pose_in_odom), shown.x, shown.y, shown.th);
  put(compose(odom_in_global, percept.pose_in_odom), shown.ax, shown.ay, shown.ath);
  shown.type = WALL;
  shown.cat = PERCEPT;
  shown.viewable = TRUE;
  shown.id = static_cast<int>(percept.id);
  shown.length = mm(percept.length);
  return shown;
}

}  // namespace

void put(const Pose& pose, float& x, float& y, float& th) {
  x = mm(pose.x);
  y = mm(pose.y);
  th = real(pose.th / Os::get().angle_unit);
}

View& view() {
  Mine& of_thread = mine();
  if (of_thread.owned)
    return of_thread.view;
  const std::lock_guard lock(of_newest);
  if (of_thread.number != newest_number) {
    take(of_thread, newest);
    of_thread.number = newest_number;
  }
  return of_thread.view;
}

void own_view() {
  mine().owned = true;
}

void publish(const View& next) {
  take(mine(), next);
  const std::lock_guard lock(of_newest);
  newest = next;
  ++newest_number;
}

/// Registers all geometry with the present pose of the robot.
void Os::clamp(const reflector::State& now) {
  const Pose before = robot_in_odom;
  new_frame_ = !first_ && now.odom != odom_;
  odom_ = now.odom;
  robot_in_odom = now.pose_in_odom;
  if (new_frame_) {
    // The robot keeps its place in the global frame.
    odom_in_global = compose(compose(odom_in_global, before), relative(robot_in_odom, Pose{}));
    lps.reset();
  }
  if (!first_ && !new_frame_) {
    const Pose moved = relative(before, robot_in_odom);
    travelled += moved.x;
  }
  if (first_)
    target_heading = robot_in_odom.th;
  state = now;
  readings_.clear();
  if (!suspended(sonar_proc))
    for (const protocol::Sonar& sonar : now.information.sonars)
      readings_.push_back({sonar.number, sonar.range, sonar.echo});
  if (std::abs(sfFrontMaxRange - mm(lps.settings().front_max_range)) > 0.5F)
    lps.set_front_max_range(sfFrontMaxRange / 1000.0);
  lps.update(robot_in_odom, readings_, cycle);
}

View Os::shown() {
  View next = view();
  next.cycle = cycle;
  const protocol::Information& now = state.information;
  struct robot& robot = next.robot;
  robot = {};
  put(robot_in_global(), robot.ax, robot.ay, robot.ath);
  robot.tv = mm(now.velocity);
  robot.mtv = mm(parameters.max_velocity);
  robot.rv = real(degrees(now.rotation_velocity));
  robot.mrv = real(degrees(parameters.max_rotation_velocity));
  robot.leftv = mm(now.left_velocity);
  robot.rightv = mm(now.right_velocity);
  robot.status = status_of(now);
  robot.battery = static_cast<int>(std::lround(now.battery * 10.0));
  robot.bumpers = now.bumpers;
  robot.ptu = now.ptu;
  robot.diginput = now.digital_input;
  robot.digoutput = now.digital_output;
  robot.analog = now.analog;
  robot.motor_packet_count = static_cast<int>(state.motor_packets_per_s);
  robot.sonar_packet_count = static_cast<int>(state.sonar_readings_per_s);
  if (!seen_times_.empty())
    robot.vision_packet_count =
        static_cast<int>(seen_times_.back().second - seen_times_.front().second);
  if (robot_) {
    std::uint64_t count = 0;
    show_vision(next, robot_->vision(count));
  }
  show_sonars(next);
  next.buffers = {to_c(lps.front()), to_c(lps.left()), to_c(lps.right())};
  next.walls = {};
  if (percepts_ && percepts_->left_wall)
    next.walls[0] = to_c(*percepts_->left_wall, robot_in_odom, odom_in_global);
  if (percepts_ && percepts_->right_wall)
    next.walls[1] = to_c(*percepts_->right_wall, robot_in_odom, odom_in_global);
  return next;
}

void Os::show_sonars(View& next) {
  for (const reflector::Bucket& bucket : state.buckets) {
    const std::size_t number = bucket.reading.number;
    if (number >= next.sonars.size())
      continue;
    sdata& shown = next.sonars[number];
    const Pose then = relative(robot_in_odom, bucket.pose_in_odom);
    put(then, shown.fx, shown.fy, shown.fth);
    put(compose(odom_in_global, bucket.pose_in_odom), shown.afx, shown.afy, shown.afth);
    const Vec2 at = transform(then, bucket.point);
    shown.x = mm(at.x());
    shown.y = mm(at.y());
    shown.range =
        bucket.reading.echo ? static_cast<int>(std::lround(bucket.reading.range * 1000.0)) : 5000;
    next.read[number] = bucket.cycle;
  }
}

void Os::reflect(const reflector::State& now, const protocol::RobotParameters& robot) {
  const std::lock_guard lock(mutex);
  if (cycle == 0 || parameters.file != robot.file) {
    parameters = robot;
    lps = lps::LocalPerceptualSpace(model_of(robot).lps);
    first_ = true;
  }
  ++cycle;
  clamp(now);
  publish(shown());
  first_ = false;
}

}  // namespace saphira::c
