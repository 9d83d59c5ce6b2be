#pragma once

#include <cstdint>
#include <optional>
#include <tuple>

#include "camera.hpp"
#include "requests/shell/desk.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/idl/device.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/reflector/reflector.hpp"

namespace saphira::bridge {

/// The robot's devices on the bus: requests in, results and reports out.
class DeviceTopics {
 public:
  DeviceTopics(bus::Node& node, reflector::Reflector& reflector);

  /// The robot's vision system, which outlives it; without one, requests to it are refused.
  void know(Camera& camera) { camera_ = &camera; }
  /// Takes the requests, and publishes their results. Without a session they are refused.
  void take(const v1::Stamp& stamp, bool session);
  /// Any packet but an information packet.
  void packet(const protocol::ServerPacket& packet, std::uint8_t type, const v1::Stamp& stamp);
  /// Publishes news, if any.
  void publish(const v1::Stamp& stamp);

  /// Failed requests since the start.
  std::uint64_t refused() const { return desk_.refused(); }

 private:
  std::optional<Answer> act(const Request& request);
  void tell(const protocol::ConfigPacket& robot);

  bus::Node& node_;
  reflector::Reflector& reflector_;
  bus::Writer<v1::Devices> devices_ = node_.writer(bus::topics::kDevices);
  bus::Writer<v1::SerialData> serial_data_ = node_.writer(bus::topics::kSerialData);
  Desk desk_;
  Camera* camera_ = nullptr;
  bool session_ = false;
  /// The fields of the information packet that robot/devices shows; a change writes the topic.
  using Shown =
      std::tuple<std::uint8_t, std::uint8_t, std::optional<bool>, std::optional<bool>,
                 std::optional<std::uint16_t>, std::optional<std::uint8_t>, std::optional<double>,
                 std::optional<double>, std::uint8_t, std::optional<double>>;
  Shown shown_;
};

}  // namespace saphira::bridge
