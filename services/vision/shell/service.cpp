#include "vision/shell/service.hpp"

#include <utility>

#include "lps/shell/convert.hpp"
#include "saphira/command_line/command_line.hpp"
#include "vision/shell/convert.hpp"

namespace saphira::vision {

Service::Service(runtime::Ports& ports, const Options& options)
    : ports_(ports),
      stereo_(!options.stereo_socket.empty()),
      channels_(ports.events(bus::topics::kVisionChannels)),
      output_(ports.each_cycle(bus::topics::kVision)),
      pictures_(options.stereo_socket, [&ports] { ports.wake(); }),
      camera_(options.camera),
      core_(std::in_place, camera_) {
  ports.gate([this](const v1::RobotState& state) { return missing(state); });
}

void Service::step(const runtime::Turn& turn) {
  take_channels(turn.stamp.epoch);
  epoch_ = turn.stamp.epoch;
  Core::Inputs inputs{.cycle = turn.stamp.cycle,
                      .new_robot = turn.new_robot,
                      .new_frame = turn.new_frame,
                      .odom = turn.robot.odom,
                      .pose_in_odom = lps::from_bus(turn.robot.pose_in_odom),
                      .channels_per_s = turn.robot.vision_packets_per_s,
                      .picture = pictures_.take(turn.stamp.cycle),
                      .seen = std::exchange(seen_, {}),
                      .no_pictures = pictures_.trouble()};

  const Core::Outputs outputs = core_->step(inputs);
  v1::Vision sample = to_bus(outputs.things);
  sample.odom = turn.robot.odom;
  sample.picture = outputs.picture;
  sample.sees_people = outputs.sees_people;
  sample.sees_colors = outputs.sees_colors;
  output_.write(std::move(sample));
  ports_.say(outputs.notes.lines());
}

void Service::take_channels(std::uint64_t epoch) {
  if (epoch != epoch_)
    seen_.clear();
  for (const auto& sample : channels_.take()) {
    const v1::VisionChannels& channels = sample.data;
    if (!sample.info.disposed && channels.stamp.epoch == epoch)
      seen_.push_back({channels.stamp.cycle, channels.odom, lps::from_bus(channels.pose_in_odom),
                       from_bus(channels)});
  }
}

std::string Service::missing(const v1::RobotState& state) {
  const std::uint64_t cycle = state.stamp.cycle;
  if (stereo_ && !pictures_.has(cycle))
    return "the stereo picture of cycle " + std::to_string(cycle);
  if (state.stamp.epoch != epoch_)
    return {};  // the first step of an epoch: their number is unknown
  take_channels(epoch_);
  if (!core_->has_channels(cycle, state.vision_packets_per_s, seen_))
    return std::string(bus::topics::kVisionChannels.name) + " of cycle " +
           std::to_string(cycle - 1);
  return {};
}

runtime::Component component() {
  const auto options = std::make_shared<Options>();
  return {"vision", "Finds people in stereo pictures, and what has the camera's colors",
          [options](CommandLine& app) {
            app.add_option("--stereo-socket", options->stereo_socket,
                           "local socket that the pairs of pictures come from");
            app.add_option("--camera-height", options->camera.height,
                           "of the color camera above the floor [m]")
                .positive();
            app.add_option("--camera-forward", options->camera.forward,
                           "of the color camera before the robot's center [m]")
                .in_range(-10.0, 10.0);
            for (std::size_t i = 0; i < options->camera.heights.size(); ++i)
              app.add_option(std::string("--height-") + static_cast<char>('a' + i),
                             options->camera.heights.at(i),
                             "how high the things of that channel are [m]; without it they are "
                             "taken to stand on the floor")
                  .positive();
          },
          [options](runtime::Ports& ports) { return std::make_unique<Service>(ports, *options); }};
}

}  // namespace saphira::vision
