#include "saphira/reflector/devices.hpp"

#include <algorithm>

namespace saphira::reflector {

namespace {

constexpr double kRetryTick = 1e-6;

}  // namespace

void Devices::begin(const protocol::RobotParameters& parameters) {
  if (parameters.protocol == protocol::Protocol::kPsos)
    return;
  const Request motors{.functor = "motors", .arguments = {{"on", true}}, .source = "bridge"};
  const Request report{.functor = "report",
                       .arguments = {{"packet", std::string("configuration")}},
                       .source = "bridge"};
  for (const Request& request : {motors, report}) {
    Item& item = put(request, parameters);
    item.quiet = true;
    note(item);
    if (request.functor == "motors")
      continue;
    // Before the question for the configuration, so that the answer shows the accepted values.
    std::vector<protocol::Command> brakes;
    if (parameters.stop_deceleration > 0.0)
      brakes.emplace_back(protocol::Acceleration{-parameters.stop_deceleration});
    if (parameters.stop_rotation_deceleration > 0.0)
      brakes.emplace_back(protocol::RotationAcceleration{-parameters.stop_rotation_deceleration});
    item.wish.commands.insert(item.wish.commands.begin(), brakes.begin(), brakes.end());
  }
}

void Devices::connect() {
  for (auto& [key, item] : items_)
    if (!ended(item.request.answer.code))
      end(item, AnswerCode::lost, "the connection to the robot ended");
  digital_output_ = 0;
  reports_ = {};
}

void Devices::request(const Request& request, const protocol::RobotParameters& parameters) {
  note(put(request, parameters));
}

Devices::Item& Devices::put(const Request& request, const protocol::RobotParameters& parameters) {
  Wish wish = wish_of(request, parameters, digital_output_);
  Item& item = items_[{wish.device, wish.setting}];
  if (!ended(item.request.answer.code) && !item.quiet) {
    item.request.answer = {AnswerCode::lost, item.request.asked + ": a request of " +
                                                 request.source + " took its place"};
    answered_.push_back(item.request);
  }
  const Answer answer = wish.refusal.empty()
                            ? Answer{AnswerCode::underway, wish.text + ": not shown yet"}
                            : Answer{AnswerCode::refused, wish.text + ": refused; " + wish.refusal};
  item = {};
  item.request = {request.asker, request.number, request.source, wish.text, answer, 0, wish.device};
  item.deadline = request.deadline;
  item.wish = std::move(wish);
  return item;
}

void Devices::end(Item& item, AnswerCode code, const std::string& words) {
  item.request.answer = {code, item.request.asked + ": " + words};
  item.wish.commands.clear();
  note(item);
}

void Devices::note(const Item& item) {
  changed_ = true;
  if (item.quiet)
    return;
  answered_.push_back(item.request);
  if (!well(item.request.answer.code))
    troubles_.push_back("a request of " + item.request.source + ": " + item.request.answer.text);
}

bool Devices::shown(const Item& item, const protocol::InformationPacket& packet,
                    const protocol::Information& information, bool origin) const {
  switch (item.wish.proof) {
    case Proof::output:
      return (packet.digital_output & item.wish.mask) == item.wish.value;
    case Proof::servo:
      return packet.ptu == item.wish.value;
    case Proof::origin:
      return origin;
    case Proof::motors:
      return information.motors_on == (item.wish.value != 0);
    case Proof::sonar:  // ARCOS has its flags where the servo's width was
      return ((packet.ptu & protocol::kFlagSonars) != 0) == (item.wish.value != 0);
    case Proof::analog:  // and the chosen port in the timer's low byte
      return (packet.timer & 0xFFU) == static_cast<unsigned>(item.wish.value);
    case Proof::once:
    case Proof::thrice:
    case Proof::packet:
      break;
  }
  return false;
}

void Devices::reflect(const protocol::InformationPacket& packet,
                      const protocol::Information& information, bool origin) {
  digital_output_ = packet.digital_output;
  for (auto& [key, item] : items_)
    if (!ended(item.request.answer.code) && item.request.sent > 0 &&
        shown(item, packet, information, origin))
      end(item, AnswerCode::done, "the robot shows it");
}

void Devices::reflect(const protocol::ServerPacket& packet, std::uint8_t type) {
  const auto take = [&](auto& kept, const auto& came) {
    changed_ = changed_ || kept != came;
    kept = came;
    for (auto& [key, item] : items_)
      if (!ended(item.request.answer.code) && item.request.sent > 0 &&
          item.wish.proof == Proof::packet && item.wish.value == type)
        end(item, AnswerCode::done, "the robot shows it");
  };
  if (const auto* configuration = std::get_if<protocol::ConfigPacket>(&packet))
    take(reports_.configuration, *configuration);
  else if (const auto* encoders = std::get_if<protocol::EncoderPacket>(&packet))
    take(reports_.encoders, *encoders);
  else if (const auto* io = std::get_if<protocol::IoPacket>(&packet))
    take(reports_.io, *io);
  else if (const auto* gripper = std::get_if<protocol::GripperPacket>(&packet))
    take(reports_.gripper, *gripper);
  else  // news when it is the first of its type; the number of them alone is none
    changed_ = ++reports_.unread[type] == 1 || changed_;
}

bool Devices::pending(double now) const {
  return std::any_of(items_.begin(), items_.end(), [&](const auto& entry) {
    const Item& item = entry.second;
    return !ended(item.request.answer.code) &&
           (item.request.sent == 0 || now - item.at >= kRetry - kRetryTick);
  });
}

std::vector<protocol::Command> Devices::due(double now, std::size_t room) {
  std::vector<protocol::Command> out;
  for (auto& [key, item] : items_) {
    if (ended(item.request.answer.code) ||
        (item.request.sent != 0 && now - item.at < kRetry - kRetryTick))
      continue;
    if (item.deadline > 0.0 && now - item.first.value_or(now) >= item.deadline) {
      end(item, AnswerCode::too_late, "given up; the robot has not shown it before the deadline");
      continue;
    }
    if (item.request.sent >= (item.quiet ? 3 : kTries)) {
      end(item, AnswerCode::given_up,
          "given up after " + std::to_string(item.request.sent) +
              " times; the robot does not show it");
      continue;
    }
    std::size_t size = 0;
    for (const protocol::Command& command : item.wish.commands)
      size += protocol::encode(command).size();
    if (size > room)
      continue;
    room -= size;
    ++item.request.sent;
    item.first = item.first.value_or(now);
    item.at = now;
    out.insert(out.end(), item.wish.commands.begin(), item.wish.commands.end());
    if (item.wish.proof == Proof::once ||
        (item.wish.proof == Proof::thrice && item.request.sent == 3))
      end(item, AnswerCode::sent, "sent; no packet of this robot would show it");
  }
  return out;
}

std::vector<DeviceRequest> Devices::requests() const {
  std::vector<DeviceRequest> out;
  for (const auto& [key, item] : items_)
    out.push_back(item.request);
  return out;
}

}  // namespace saphira::reflector
