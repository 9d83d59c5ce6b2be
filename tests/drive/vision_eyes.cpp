#include "drive/vision_eyes.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <string_view>

#include "saphira/sim/stereo.hpp"
#include "saphira/sim/vision.hpp"
#include "saphira/vision/vision.hpp"

namespace saphira::test {
namespace {

// Of the channels, untrained.
constexpr std::array<std::string_view, 3> kColors{"red", "green", "blue"};

vision::Bands bands_of(const std::array<sim::RangeBand, 3>& seen, const sim::StereoCamera& camera) {
  vision::Bands bands{.eye_forward = camera.pose_in_robot.x,
                      .uncertainty = 0.5 * camera.disparity / camera.baseline};
  for (std::size_t band = 0; band < seen.size(); ++band)
    for (std::size_t column = 0; column < seen[band].size(); ++column) {
      const auto& range = seen[band][column];
      const double across = (static_cast<double>(column) + 0.5) / camera.columns * 2.0 - 1.0;
      const double tangent = -across * std::tan(camera.field_of_view / 2.0);
      bands.bands[band].push_back(
          range ? std::optional(Vec2(*range + bands.eye_forward, *range * tangent)) : std::nullopt);
    }
  return bands;
}

struct Looker {
  Stereo stereo;
  vision::Vision vision{};
  Random noise{3};

  std::vector<lps::SeenThing> look(Drive& drive) {
    const Seen& seen = drive.seen();
    const sim::RobotNumber robot = drive.robot().number();
    if (stereo == Stereo::bands) {
      const sim::StereoCamera camera;
      vision.see(bands_of(sim::see_bands(drive.scene(), robot, camera, noise), camera), seen.cycle,
                 seen.pose_in_odom);
    } else {
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

std::function<std::vector<lps::SeenThing>(Drive&)> vision_eyes(Stereo stereo) {
  return [looker = std::make_shared<Looker>(Looker{stereo})](Drive& drive) {
    return looker->look(drive);
  };
}

}  // namespace saphira::test
