#pragma once

#include <cstdint>
#include <optional>
#include <tuple>

#include "device.h"
#include "requests/shell/desk.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/reflector/reflector.hpp"

namespace saphira::bridge {

/// The robot's devices on the bus: what is asked of them comes in, what became of it and what they
/// say goes out.
class DeviceTopics {
 public:
  DeviceTopics(bus::Node& node, reflector::Reflector& reflector);

  /// Takes the requests, and publishes what became of them. Without a session they are refused.
  void take(const Stamp& stamp, bool session);
  /// Any packet but an information packet.
  void packet(const protocol::ServerPacket& packet, std::uint8_t type, const v1::Stamp& stamp);
  /// Where there is something new to tell.
  void publish(const v1::Stamp& stamp);

  /// Requests, since the start, that could not be done.
  std::uint64_t refused() const { return desk_.refused(); }

 private:
  std::optional<Answer> act(const Request& request);
  void tell(const protocol::ConfigPacket& robot);

  bus::Node& node_;
  reflector::Reflector& reflector_;
  bus::Writer<v1::Devices> devices_;
  bus::Writer<v1::SerialData> serial_data_;
  Desk desk_;
  bool session_ = false;
  /// Of the information packet, what robot/devices shows; it is written when this changes.
  using Shown =
      std::tuple<std::uint8_t, std::uint8_t, std::optional<bool>, std::optional<bool>,
                 std::optional<std::uint16_t>, std::optional<std::uint8_t>, std::optional<double>,
                 std::optional<double>, std::uint8_t, std::optional<double>>;
  Shown shown_;
};

}  // namespace saphira::bridge
