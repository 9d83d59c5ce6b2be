#include "drive/eyes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saphira/sim/vision.hpp"

namespace saphira::test {
namespace {

constexpr double kReach = 6.0;               // [m]
constexpr double kField = radians(30.0);     // to each side
constexpr std::uint64_t kForget = 50;        // [cycles]
constexpr double kTick = 0.1;                // [s]
constexpr double kNominal = 2.0;             // [m] without a known range
constexpr std::uint32_t kFirstBlob = 1'000;  // people are numbered from 1

class TrueEyes {
 public:
  explicit TrueEyes(std::vector<std::string> colors) : colors_(std::move(colors)) {}

  std::vector<lps::SeenThing> operator()(Drive& drive) {
    const Seen& seen = drive.seen();
    const auto& persons = drive.scene().persons();
    for (std::size_t i = 0; i < persons.size(); ++i)
      look_at(drive, static_cast<std::uint32_t>(i) + 1, persons[i].at);
    const sim::Camera camera;
    for (std::size_t i = 0; i < colors_.size(); ++i)
      if (const auto blob = sim::see_blob(drive.scene(), 0, camera, colors_[i])) {
        lps::SeenThing& thing = known(kFirstBlob + static_cast<std::uint32_t>(i), seen.cycle);
        thing.kind = lps::SeenThing::Kind::blob;
        thing.channel = static_cast<int>(i);
        thing.range_known = false;
        const double bearing = -blob->x * camera.pixel;
        thing.pose_in_odom = compose(
            seen.pose_in_odom, {kNominal * std::cos(bearing), kNominal * std::sin(bearing), 0.0});
        thing.area = static_cast<double>(blob->area) / (camera.columns * camera.rows);
      }
    std::erase_if(things_,
                  [&](const lps::SeenThing& thing) { return seen.cycle > thing.seen + kForget; });
    for (lps::SeenThing& thing : things_)
      if (thing.seen < seen.cycle) {
        thing.pose_in_odom.x += kTick * thing.velocity_in_odom.x();
        thing.pose_in_odom.y += kTick * thing.velocity_in_odom.y();
      }
    return things_;
  }

 private:
  void look_at(Drive& drive, std::uint32_t id, const Vec2& at) {
    const Seen& seen = drive.seen();
    const Pose& robot = seen.true_pose_in_world;
    const Vec2 there = to_frame(robot, at);
    const double far = there.norm();
    if (far > kReach || far < 0.1 || std::abs(std::atan2(there.y(), there.x())) > kField ||
        sim::cast_ray(drive.world().segments, robot.position(), (at - robot.position()) / far, far))
      return;
    const auto before = find(id);
    const bool again = before != things_.end() && before->seen + 1 == seen.cycle;
    const Vec2 was = again ? before->pose_in_odom.position() : Vec2{0.0, 0.0};
    lps::SeenThing& thing = known(id, seen.cycle);
    const Vec2 in_odom = transform(seen.pose_in_odom, there);
    thing.pose_in_odom = {in_odom.x(), in_odom.y(), 0.0};
    if (again)
      thing.velocity_in_odom = (in_odom - was) / kTick;
  }

  std::vector<lps::SeenThing>::iterator find(std::uint32_t id) {
    return std::find_if(things_.begin(), things_.end(),
                        [id](const lps::SeenThing& thing) { return thing.id == id; });
  }

  lps::SeenThing& known(std::uint32_t id, std::uint64_t cycle) {
    auto thing = find(id);
    if (thing == things_.end()) {
      things_.emplace_back();
      thing = std::prev(things_.end());
      thing->id = id;
      thing->since = cycle;
    }
    thing->seen = cycle;
    thing->confidence = 1.0;
    return *thing;
  }

  std::vector<std::string> colors_;
  std::vector<lps::SeenThing> things_;
};

}  // namespace

std::function<std::vector<lps::SeenThing>(Drive&)> true_eyes(std::vector<std::string> colors) {
  return TrueEyes(std::move(colors));
}

}  // namespace saphira::test
