#include "saphira/vision/core.hpp"

#include <algorithm>

namespace saphira::vision {
namespace {

constexpr std::size_t kPlaces = 32;    // [cycles] a picture may be late
constexpr std::uint64_t kRecent = 20;  // [cycles] a camera silent for longer counts as off
constexpr std::uint64_t kSecond = 10;  // [cycles] over which the bridge counts the channels

}  // namespace

Core::Outputs Core::step(const Inputs& inputs) {
  begin(inputs);
  Outputs outputs;
  if (inputs.no_pictures != no_pictures_) {
    if (inputs.no_pictures.empty())
      outputs.notes.info("stereo pictures come");
    else
      outputs.notes.warn("no stereo pictures: " + inputs.no_pictures);
    no_pictures_ = inputs.no_pictures;
  }
  places_.push_back({inputs.cycle, inputs.pose_in_odom});
  if (places_.size() > kPlaces)
    places_.pop_front();
  if (inputs.picture)
    look_at(*inputs.picture);
  look_at_channels(inputs);
  outputs.things = vision_.things(inputs.cycle, inputs.pose_in_odom);
  outputs.picture = picture_;
  outputs.sees_people = picture_ != 0 && picture_ + kRecent >= inputs.cycle;
  outputs.sees_colors = color_ != 0 && color_ + kRecent >= inputs.cycle;
  return outputs;
}

void Core::begin(const Inputs& inputs) {
  if (inputs.new_robot) {
    newer_.clear();
    counted_.clear();
    joined_ = inputs.cycle;
    picture_ = color_ = 0;
  }
  if (inputs.new_robot || inputs.new_frame) {
    places_.clear();
    vision_.reset();
  }
}

void Core::look_at(const StereoPicture& picture) {
  if (picture.cycle <= picture_ || !stereo_.works())
    return;
  const auto place = std::find_if(places_.begin(), places_.end(),
                                  [&](const Place& one) { return one.cycle == picture.cycle; });
  if (place == places_.end())
    return;
  picture_ = picture.cycle;
  vision_.see(picture, place->pose_in_odom);
}

/// The channels come after their cycle: a step sees those of earlier cycles.
void Core::look_at_channels(const Inputs& inputs) {
  newer_.insert(newer_.end(), inputs.seen.begin(), inputs.seen.end());
  while (!newer_.empty() && newer_.front().cycle < inputs.cycle) {
    const Seen& seen = newer_.front();
    counted_.push_back(seen.cycle);
    if (seen.odom == inputs.odom && seen.cycle > color_ && colors_.works()) {
      color_ = seen.cycle;
      vision_.see(seen.channels, seen.cycle, seen.pose_in_odom);
    }
    newer_.pop_front();
  }
  while (!counted_.empty() && counted_.front() + kSecond < inputs.cycle)
    counted_.pop_front();
}

bool Core::has_channels(std::uint64_t cycle, unsigned channels_per_s,
                        const std::vector<Seen>& waiting) const {
  // The number is of the second before the cycle; a service that joined within it cannot count.
  if (joined_ != 1 && joined_ + kSecond > cycle)
    return true;
  const auto counts = [&](std::uint64_t one) { return one < cycle && one + kSecond >= cycle; };
  const auto here =
      std::count_if(counted_.begin(), counted_.end(), counts) +
      std::count_if(newer_.begin(), newer_.end(), [&](const Seen& s) { return counts(s.cycle); }) +
      std::count_if(waiting.begin(), waiting.end(), [&](const Seen& s) { return counts(s.cycle); });
  return here >= static_cast<std::ptrdiff_t>(channels_per_s);
}

}  // namespace saphira::vision
