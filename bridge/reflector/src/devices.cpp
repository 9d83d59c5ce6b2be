#include "saphira/reflector/devices.hpp"

#include <algorithm>

namespace saphira::reflector {

namespace {

constexpr double kTick = 1e-6;

/// How often a command is sent that no packet shows; 0: until it is shown.
int times(const protocol::Command& command) {
  if (std::holds_alternative<protocol::Timer>(command))
    return 1;
  if (std::holds_alternative<protocol::Polling>(command) ||
      std::holds_alternative<protocol::Gripper>(command))
    return 3;
  return 0;
}

const char* name(const protocol::Command& command) {
  if (std::holds_alternative<protocol::DigitalOutput>(command))
    return "digital output";
  if (std::holds_alternative<protocol::Ptu>(command))
    return "position servo";
  return "set origin";
}

}  // namespace

void Devices::request(const protocol::Command& command) {
  std::erase_if(waiting_,
                [&](const Item& item) { return item.command.index() == command.index(); });
  waiting_.push_back({command});
}

void Devices::reflect(const protocol::InformationPacket& packet, bool origin) {
  std::erase_if(waiting_, [&](const Item& item) {
    if (item.tries == 0)
      return false;
    if (const auto* out = std::get_if<protocol::DigitalOutput>(&item.command))
      return packet.digital_output == out->bits;
    if (const auto* ptu = std::get_if<protocol::Ptu>(&item.command))
      return packet.ptu == ptu->width;
    if (std::holds_alternative<protocol::SetOrigin>(item.command))
      return origin;
    return false;
  });
}

bool Devices::pending(double now) const {
  return std::any_of(waiting_.begin(), waiting_.end(), [&](const Item& item) {
    return item.tries == 0 || now - item.at >= kRetry - kTick;
  });
}

std::vector<protocol::Command> Devices::due(double now) {
  std::vector<protocol::Command> out;
  for (Item& item : waiting_) {
    if (item.tries != 0 && now - item.at < kRetry - kTick)
      continue;
    if (item.tries == kTries) {
      trouble_ = std::string("the robot does not take the command: ") + name(item.command);
      ++item.tries;
      continue;
    }
    ++item.tries;
    item.at = now;
    out.push_back(item.command);
  }
  std::erase_if(waiting_, [](const Item& item) {
    return item.tries > kTries || (times(item.command) > 0 && item.tries >= times(item.command));
  });
  return out;
}

std::optional<std::string> Devices::take_trouble() {
  std::optional<std::string> out;
  out.swap(trouble_);
  return out;
}

}  // namespace saphira::reflector
