#include "vision/shell/shell.hpp"

#include <algorithm>

#include "lps/shell/convert.hpp"
#include "vision/shell/convert.hpp"

namespace saphira::vision {
namespace {

constexpr std::size_t kPlaces = 32;    // [cycles] a picture may be late
constexpr std::uint64_t kRecent = 20;  // [cycles] eyes that showed nothing for longer are shut
/// Lockstep: what belongs to a cycle is waited for, for as long. A run is the same each time where
/// that is longer than a busy machine needs.
constexpr std::chrono::milliseconds kWait{2000};

}  // namespace

Shell::Shell(bus::Node& node, const ShellOptions& options)
    : node_(node),
      cycle_(node),
      channels_(node.reader(bus::topics::kVisionChannels)),
      writer_(node.writer(bus::topics::kVision)),
      processes_(node, table_),
      pictures_(options.stereo_socket),
      vision_(options.camera) {}

bool Shell::step(const bus::Stop& stop) {
  const auto step = cycle_.next(stop, [this] {
    processes_.idle();
    tell_of_pictures();
  });
  if (!step)
    return false;
  processes_.step(cycle_.stamp());
  tell_of_pictures();
  const v1::RobotState& robot = step->robot;
  const std::uint64_t cycle = cycle_.stamp().cycle();
  if (step->new_epoch) {
    places_.clear();
    newer_.clear();
    picture_ = color_ = 0;
    vision_.reset();
  }
  if (odom_ && *odom_ != robot.odom()) {
    places_.clear();
    vision_.reset();
  }
  odom_ = robot.odom();
  const Pose pose = lps::from_bus(robot.pose_in_odom());
  places_.push_back({cycle, pose});
  if (places_.size() > kPlaces)
    places_.pop_front();
  look(cycle);
  look_at_colors(robot, stop);
  v1::Vision sample = to_bus(vision_.things(cycle, pose));
  sample.stamp(cycle_.stamp());
  sample.odom(robot.odom());
  sample.picture(picture_);
  sample.sees_people(picture_ != 0 && picture_ + kRecent >= cycle);
  sample.sees_colors(color_ != 0 && color_ + kRecent >= cycle);
  writer_.write(sample);
  cycle_.done();
  return true;
}

/// Looks at the newest picture that is not of a later cycle.
void Shell::look(std::uint64_t cycle) {
  const bool lockstep = node_.options().lockstep;
  const auto picture = pictures_.take(cycle, lockstep ? kWait : std::chrono::milliseconds::zero());
  if (!picture || picture->cycle <= picture_ || !stereo_.works())
    return;
  const auto place = std::find_if(places_.begin(), places_.end(),
                                  [&](const Place& one) { return one.cycle == picture->cycle; });
  if (place == places_.end())
    return;
  picture_ = picture->cycle;
  vision_.see(*picture, place->pose_in_odom);
}

/// The channels come behind the cycle that they are of: a step sees those of the cycle before, for
/// which lockstep waits where the robot's state says that they come.
void Shell::look_at_colors(const v1::RobotState& robot, const bus::Stop& stop) {
  const std::uint64_t before = cycle_.stamp().cycle() - 1;
  const auto limit = std::chrono::steady_clock::now() + kWait;
  while (true) {
    for (auto& sample : channels_.take())
      if (!sample.info.disposed && sample.data.stamp().epoch() == cycle_.stamp().epoch())
        newer_.push_back(std::move(sample.data));
    const bool here = !newer_.empty() && newer_.back().stamp().cycle() >= before;
    const auto left = limit - std::chrono::steady_clock::now();
    if (here || robot.vision_packets_per_s() == 0 || !node_.options().lockstep ||
        stop.requested() || left <= left.zero())
      break;
    node_.wait(std::chrono::ceil<std::chrono::milliseconds>(left), &stop);
  }
  while (!newer_.empty() && newer_.front().stamp().cycle() < cycle_.stamp().cycle()) {
    const v1::VisionChannels& seen = newer_.front();
    if (seen.odom() == robot.odom() && seen.stamp().cycle() > color_ && colors_.works()) {
      color_ = seen.stamp().cycle();
      vision_.see(from_bus(seen), color_, lps::from_bus(seen.pose_in_odom()));
    }
    newer_.pop_front();
  }
}

void Shell::tell_of_pictures() {
  const std::string trouble = pictures_.trouble();
  if (trouble == told_)
    return;
  if (trouble.empty())
    node_.info("stereo pictures come");
  else
    node_.warn("no stereo pictures: " + trouble);
  told_ = trouble;
}

}  // namespace saphira::vision
