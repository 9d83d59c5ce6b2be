#include "saphira/vision/vision.hpp"

namespace saphira::vision {

using Kind = lps::SeenThing::Kind;

void Vision::see(const StereoPicture& picture, const Pose& robot_in_odom) {
  const auto [first, last] = torso_rows(picture.rig, picture.rows);
  see(bands_of(census_.match(picture.left(), picture.right(), first, last), picture.rig,
               picture.rows),
      picture.cycle, robot_in_odom);
}

void Vision::see(const Bands& bands, std::uint64_t cycle, const Pose& robot_in_odom) {
  tracker_.see(Kind::person, cycle, robot_in_odom, find_people(bands),
               [&](const Vec2& place) { return in_view(bands, place); });
}

void Vision::see(const Channels& channels, std::uint64_t cycle, const Pose& robot_in_odom) {
  tracker_.see(Kind::blob, cycle, robot_in_odom, find_blobs(channels, camera_),
               [&](const Vec2& place) { return in_view(camera_, place); });
}

}  // namespace saphira::vision
