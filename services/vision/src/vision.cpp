#include "saphira/vision/vision.hpp"

namespace saphira::vision {

using Kind = lps::SeenThing::Kind;

namespace {

/// The robot's pose as if it had turned about its cameras instead of them.
Pose looking(const Rig& rig, const Pose& robot_in_odom) {
  const Pose eye = compose(robot_in_odom, {rig.forward, 0.0, rig.pan});
  return compose(eye, {-rig.forward, 0.0, 0.0});
}

}  // namespace

void Vision::see(const StereoPicture& picture, const Pose& robot_in_odom) {
  const auto [first, last] = torso_rows(picture.rig, picture.rows);
  const DisparityMap& map = census_.match(picture.left(), picture.right(), first, last);
  const Bands bands = bands_of(map, picture.rig, picture.rows);
  std::vector<Sight> people = find_people(bands);
  for (Sight& person : people)
    person.points = arm_of(person, map, picture.rig, picture.rows);
  see_people(bands, people, picture.cycle, looking(picture.rig, robot_in_odom));
}

void Vision::see(const Bands& bands, std::uint64_t cycle, const Pose& robot_in_odom) {
  see_people(bands, find_people(bands), cycle, robot_in_odom);
}

void Vision::see_people(const Bands& bands, const std::vector<Sight>& people, std::uint64_t cycle,
                        const Pose& robot_in_odom) {
  tracker_.see(Kind::person, cycle, robot_in_odom, people,
               [&](const Vec2& place) { return in_view(bands, place); });
}

void Vision::see(const Channels& channels, std::uint64_t cycle, const Pose& robot_in_odom) {
  tracker_.see(Kind::blob, cycle, robot_in_odom, find_blobs(channels, camera_),
               [&](const Vec2& place) { return in_view(camera_, place); });
}

}  // namespace saphira::vision
