// State reflection (manual 6.3) and direct motion control (6.4) for C programs.

#include <cmath>
#include <set>

#include "os.hpp"

using namespace saphira;
using c::Os;

namespace {

/// True where there is a robot, and the state reflector that moves it.
bool ready(const char* function) {
  static bool told = false;
  if (Os::get().connected() && Os::get().find(motor_proc) != nullptr)
    return true;
  if (!std::exchange(told, true))
    Os::get().say(std::string(function) + (Os::get().connected()
                                               ? ": the state reflector is not started: call "
                                                 "sfInitBasicProcs in the connect callback"
                                               : ": no robot is connected"),
                  true);
  return false;
}

/// The heading setpoint, and with it the rotation channel.
void turn_to(double heading_in_odom) {
  Os& os = Os::get();
  os.target_heading = norm2_angle(heading_in_odom);
  os.motion.rotation = reflector::Rotation::heading;
  os.motion.heading = os.target_heading;
}

/// Reports a speed beyond the robot's own limit, each function's once for each robot.
void tell_limit(const char* function, int wanted, const char* unit, double most) {
  static std::set<std::pair<std::string, std::string>> told;
  if (std::abs(wanted) > std::lround(most) &&
      told.insert({function, Os::get().parameters.file}).second)
    Os::get().say(std::string(function) + ": the robot's limit is " +
                      std::to_string(std::lround(most)) + " " + unit + ", not " +
                      std::to_string(wanted),
                  true);
}

}  // namespace

extern "C" {

float flakey_radius = 0.0F;

void sfSetVelocity(int vel) {
  const std::lock_guard lock(Os::get().mutex);
  if (!ready("sfSetVelocity"))
    return;
  Os& os = Os::get();
  if (vel == 0 && os.stopped)
    os.let_go();
  os.motion.translation = reflector::Translation::velocity;
  os.motion.velocity = vel / 1000.0;
  tell_limit("sfSetVelocity", vel, "mm/s", os.parameters.max_velocity * 1000.0);
  os.position_target.reset();
  os.position_dropped = false;
}

void sfSetRVelocity(int rvel) {
  const std::lock_guard lock(Os::get().mutex);
  if (!ready("sfSetRVelocity"))
    return;
  Os::get().motion.rotation = reflector::Rotation::velocity;
  Os::get().motion.rotation_velocity = radians(rvel);
  tell_limit("sfSetRVelocity", rvel, "deg/s", degrees(Os::get().parameters.max_rotation_velocity));
}

void sfSetHeading(int head) {
  const std::lock_guard lock(Os::get().mutex);
  if (ready("sfSetHeading"))
    turn_to(radians(head) - Os::get().odom_in_global.th);
}

void sfSetDHeading(int dhead) {
  const std::lock_guard lock(Os::get().mutex);
  Os& os = Os::get();
  if (!ready("sfSetDHeading"))
    return;
  const bool holds = os.motion.rotation == reflector::Rotation::heading;
  turn_to((holds ? os.target_heading : os.robot_in_odom.th) + radians(dhead));
}

void sfSetPosition(int dist) {
  const std::lock_guard lock(Os::get().mutex);
  Os& os = Os::get();
  if (!ready("sfSetPosition"))
    return;
  os.motion.translation = reflector::Translation::position;
  os.motion.velocity = os.max_velocity;
  os.motion.distance = dist / 1000.0;
  ++os.motion.move;
  os.position_target = os.travelled + os.motion.distance;
  os.position_dropped = false;
}

void sfSetMaxVelocity(int vel) {
  const std::lock_guard lock(Os::get().mutex);
  Os& os = Os::get();
  os.max_velocity = std::abs(vel) / 1000.0;
  if (os.connected())
    tell_limit("sfSetMaxVelocity", vel, "mm/s", os.parameters.max_velocity * 1000.0);
  if (os.motion.translation == reflector::Translation::position)
    os.motion.velocity = os.max_velocity;
}

void sfStopRobot(void) {
  Os::get().stop_robot();
}

int sfDonePosition(int dist) {
  const std::lock_guard lock(Os::get().mutex);
  const Os& os = Os::get();
  return os.position_target
             ? std::abs(*os.position_target - os.travelled) <= std::abs(dist) / 1000.0
             : !os.position_dropped;
}

int sfDoneHeading(int ang) {
  const std::lock_guard lock(Os::get().mutex);
  const Os& os = Os::get();
  return std::abs(norm2_angle(os.robot_in_odom.th - os.target_heading)) <= radians(std::abs(ang));
}

float sfTargetVel(void) {
  const std::lock_guard lock(Os::get().mutex);
  return static_cast<float>(Os::get().state.target_velocity * 1000.0);
}

float sfTargetHead(void) {
  const std::lock_guard lock(Os::get().mutex);
  const Os& os = Os::get();
  return static_cast<float>(
      degrees(norm_angle(os.state.target_heading_in_odom + os.odom_in_global.th)));
}

struct robot* sf_robot(void) {
  return &c::view().robot;
}
sdata* sf_sbucket(void) {
  return c::view().sonars.data();
}
cbuf* sf_sonar_buffer(int which) {
  return &c::view().buffers[which == sfLEFT ? 1 : which == sfRIGHT ? 2 : 0];
}
wall* sf_wall_hypothesis(int side) {
  return &c::view().walls[side == sfRIGHT ? 1 : 0];
}
struct vinfo* sf_vision(int channel) {
  return &c::view().vision[channel == 1 || channel == 2 ? static_cast<std::size_t>(channel) : 0];
}

int sfStalledMotor(int which) {
  const std::lock_guard lock(Os::get().mutex);
  const protocol::Information& now = Os::get().state.information;
  return which == sfRIGHT ? now.right_stalled : which == sfLEFT ? now.left_stalled : 0;
}

static sdata* sonar(int num) {
  static sdata none{};
  if (num >= 0 && num < SF_MAX_SONARS)
    return &sf_sbucket()[num];
  none.range = 5000;
  none.snew = 0;
  return &none;
}
int sfSonarRange(int num) {
  return sonar(num)->range;
}
float sfSonarXCoord(int num) {
  return sonar(num)->x;
}
float sfSonarYCoord(int num) {
  return sonar(num)->y;
}
int sfSonarNew(int num) {
  return std::exchange(sonar(num)->snew, 0) != 0 ? 1 : 0;
}

}  // extern "C"
