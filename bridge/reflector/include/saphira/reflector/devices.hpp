#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/protocol/command.hpp"
#include "saphira/protocol/information.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/reflector/wishes.hpp"

namespace saphira::reflector {

/// A request to a device, and its state.
struct DeviceRequest {
  std::uint64_t asker = 0;
  std::uint64_t number = 0;
  std::string source;
  std::string asked;  ///< in words
  Answer answer;      ///< the newest
  unsigned sent = 0;  ///< how often
  Device device = Device::servo;
};

/// Sends requests to the devices until the robot's packets show their effect (manual 5.1.3). A
/// request without a visible effect is sent three times where that is harmless, and once where a
/// second one would have another meaning. Keeps the newest request of each device and setting, and
/// its result.
class Devices {
 public:
  static constexpr double kRetry = 0.2;   ///< [s]
  static constexpr unsigned kTries = 25;  ///< then the request fails: 5 s

  /// A connection begins, or ended: requests under way are lost.
  void connect();
  /// A request to a device (wish_of). A newer request replaces an older one of the same device and
  /// setting.
  void request(const Request& request, const protocol::RobotParameters& parameters);
  /// The commands at the start of a session: a robot since P2OS needs a command to switch its
  /// motors on, and reports its configuration. No answer is harmless.
  void begin(const protocol::RobotParameters& parameters);
  /// An information packet came. `origin`: its raw pose is (0, 0, 0), within the way of a moving
  /// robot.
  void reflect(const protocol::InformationPacket& packet, const protocol::Information& information,
               bool origin);
  /// A packet of another type came; types without a reader are counted.
  void reflect(const protocol::ServerPacket& packet, std::uint8_t type);
  /// The commands to be sent now, of no more than `room` bytes in all: the rest waits.
  std::vector<protocol::Command> due(double now, std::size_t room = SIZE_MAX);
  bool pending(double now) const;

  /// The newest request of each device and setting, in the order of the devices.
  std::vector<DeviceRequest> requests() const;
  /// The requests with news since the last call, in that order.
  std::vector<DeviceRequest> take_answered() { return std::exchange(answered_, {}); }
  /// The newest contents of the packets besides the information packet, in this session.
  struct Reports {
    std::optional<protocol::ConfigPacket> configuration;
    std::optional<protocol::EncoderPacket> encoders;
    std::optional<protocol::IoPacket> io;
    std::optional<protocol::GripperPacket> gripper;
    std::map<std::uint8_t, std::uint32_t> unread;  ///< packets of types without a reader, by type
  };
  const Reports& reports() const { return reports_; }
  /// True where requests() or reports() have changed since the last call.
  bool take_changed() { return std::exchange(changed_, false); }
  /// Requests that failed since the last call, in words.
  std::vector<std::string> take_troubles() { return std::exchange(troubles_, {}); }

  SAPHIRA_ARCHIVE(items_, digital_output_, reports_, changed_, answered_, troubles_)

 private:
  struct Item {
    DeviceRequest request;
    double deadline = 0.0;        ///< [s] from the first time that it is sent; 0: none
    std::optional<double> first;  ///< [s] time of that
    Wish wish;
    bool quiet = false;  ///< our own request: no message where it fails
    double at = 0.0;
  };

  Item& put(const Request& request, const protocol::RobotParameters& parameters);
  void note(const Item& item);
  bool shown(const Item& item, const protocol::InformationPacket& packet,
             const protocol::Information& information, bool origin) const;

  void end(Item& item, AnswerCode code, const std::string& words);

  std::map<std::pair<Device, int>, Item> items_;  ///< by device and setting
  std::uint8_t digital_output_ = 0;               ///< as the robot shows it
  Reports reports_;
  bool changed_ = false;
  std::vector<DeviceRequest> answered_;
  std::vector<std::string> troubles_;
};

}  // namespace saphira::reflector
