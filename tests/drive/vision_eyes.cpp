#include "drive/vision_eyes.hpp"

#include <array>
#include <memory>
#include <string_view>

#include "saphira/sim/stereo.hpp"
#include "saphira/sim/vision.hpp"
#include "saphira/vision/vision.hpp"

namespace saphira::test {
namespace {

// Of the channels, untrained.
constexpr std::array<std::string_view, 3> kColors{"red", "green", "blue"};

struct Looker {
  bool people;
  vision::Vision vision{};
  Random noise{3};

  std::vector<lps::SeenThing> look(Drive& drive) {
    const Seen& seen = drive.seen();
    const sim::RobotNumber robot = drive.robot().number();
    if (people) {
      sim::StereoRig rig;
      rig.pose_in_robot.th = seen.head;
      vision::PictureStream stream;
      stream.feed(
          sim::to_pgm(sim::render_stereo(drive.scene(), robot, rig, noise), rig, seen.cycle));
      vision.see(stream.take().value(), seen.pose_in_odom);
    }
    vision::Channels channels;
    for (std::size_t i = 0; i < channels.size(); ++i)
      if (const auto blob = sim::see_blob(drive.scene(), robot, sim::Camera{}, kColors.at(i)))
        channels[i] = {blob->x, blob->y, blob->area, blob->width, blob->height};
    vision.see(channels, seen.cycle, seen.pose_in_odom);
    return vision.things(seen.cycle, seen.pose_in_odom);
  }
};

}  // namespace

std::function<std::vector<lps::SeenThing>(Drive&)> vision_eyes(bool people) {
  return [looker = std::make_shared<Looker>(Looker{people})](Drive& drive) {
    return looker->look(drive);
  };
}

}  // namespace saphira::test
