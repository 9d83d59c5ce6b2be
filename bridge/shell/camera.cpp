#include "camera.hpp"

#include <utility>

#include "convert.hpp"

namespace saphira::bridge {
namespace {

constexpr std::uint64_t kSecond = 10;   // [cycles]
constexpr std::uint64_t kSilence = 20;  // [cycles] then the command is sent again

}  // namespace

Camera::Camera(bus::Node& node, std::vector<std::string> words)
    : words_(std::move(words)), channels_(node.writer(bus::topics::kVisionChannels)) {}

void Camera::keep(const std::string& text) {
  const std::string name = text.substr(0, text.find('=') + 1);
  std::erase_if(words_, [&](const std::string& word) { return word.starts_with(name); });
  words_.push_back(text);
}

void Camera::connect() {
  packets_.clear();
  asked_ = 0;
}

std::vector<protocol::Bytes> Camera::begin(std::uint64_t cycle) {
  while (!packets_.empty() && packets_.front() + kSecond < cycle)
    packets_.pop_front();
  if (!packets_.empty() || (asked_ != 0 && cycle < asked_ + kSilence))
    return {};
  asked_ = cycle;
  std::vector<protocol::Bytes> said;
  for (const std::string& text : words_)
    said.push_back(
        protocol::encode(protocol::VisionCommand(protocol::Bytes(text.begin(), text.end()))));
  return said;
}

void Camera::packet(const protocol::VisionPacket& packet, const v1::RobotState& state) {
  packets_.push_back(state.stamp.cycle);
  v1::VisionChannels channels = to_bus(packet);
  channels.stamp = state.stamp;
  channels.odom = state.odom;
  channels.pose_in_odom = state.pose_in_odom;
  channels_.write(channels);
}

}  // namespace saphira::bridge
