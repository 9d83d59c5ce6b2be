#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "saphira/protocol/command.hpp"
#include "saphira/protocol/information.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/protocol/server_packet.hpp"

namespace saphira::reflector {

// ---- What may be asked of the robot's devices. SI units, but where a number is the robot's own.

struct ServoWish {
  std::uint16_t width = 0;  ///< [us]
};
enum class GripperAction {
  open,
  close,
  stop,
  lift_up,
  lift_down,
  lift_stop,
  store,
  deploy,
  halt,
  pressure,
  carry,
  number
};
struct GripperWish {
  GripperAction action = GripperAction::stop;
  std::uint16_t value = 0;  ///< of pressure, carry and number, in the robot's own units
};
struct OutputWish {
  std::uint8_t mask = 0;
  std::uint8_t bits = 0;
};
struct AnalogWish {
  std::uint8_t port = 0;
};
struct TimerWish {
  std::uint8_t pin = 0;
};
struct SonarWish {
  bool on = true;
  std::vector<std::uint8_t> polling;  ///< empty: all, in order
};
struct Tone {
  std::uint8_t duration = 0;  ///< [20 ms]
  std::uint8_t pitch = 0;     ///< the robot's own; 0 is silence
};
struct SoundWish {
  std::vector<Tone> tones;  ///< empty: a stored sound
  std::uint8_t stored = 0;
};
enum class ServerAction { set_origin, motors, bump_stall, configuration, encoders, io, gripper };
struct ServerWish {
  ServerAction action = ServerAction::set_origin;
  int value = 0;
};
struct SerialWish {
  std::uint8_t port = 1;
  std::vector<std::uint8_t> data;
  std::uint8_t answer = 0;
};
/// In the order of enum Device of the contract.
using Wish = std::variant<ServoWish, GripperWish, OutputWish, AnalogWish, TimerWish, SonarWish,
                          SoundWish, ServerWish, SerialWish>;

/// A wish in words, such as "servo 1500 us".
std::string text(const Wish& wish);

// ---- What became of it.

enum class RequestState { sending, shown, sent, given_up, refused, lost };

struct Request {
  std::size_t device = 0;  ///< index into Wish
  std::string source;
  std::uint64_t number = 0;
  std::string text;
  RequestState state = RequestState::sending;
  std::string reason;
  unsigned sent = 0;
};

/// Sends what is asked of the devices until the robot's packets show it (manual 5.1.3). What no
/// packet shows is sent three times where that does no harm, and once where a second one would mean
/// something else. Keeps the newest request of each device and action, and what became of it.
class Devices {
 public:
  static constexpr double kRetry = 0.2;   ///< [s]
  static constexpr unsigned kTries = 25;  ///< then it is given up: 5 s

  /// A connection begins, or ended: what was under way is lost.
  void connect();
  /// A newer request takes the place of an older one of the same device and action.
  void request(const std::string& source, std::uint64_t number, const Wish& wish,
               const protocol::RobotParameters& parameters);
  /// One that is not to be sent.
  void refuse(std::size_t device, const std::string& source, std::uint64_t number,
              const std::string& text, const std::string& reason);
  /// What a session begins with: a robot since P2OS switches its motors on when it is told, and
  /// says what it is like. No answer does no harm.
  void begin(const protocol::RobotParameters& parameters);
  /// An information packet came. `origin`: its raw pose is (0, 0, 0) within what a moving robot
  /// makes of it.
  void reflect(const protocol::InformationPacket& packet, const protocol::Information& information,
               bool origin);
  /// A packet of another type came; those that nobody here reads are counted.
  void reflect(const protocol::ServerPacket& packet, std::uint8_t type);
  /// What is to be sent now, of no more than `room` bytes in all: the rest waits for the line.
  std::vector<protocol::Command> due(double now, std::size_t room = SIZE_MAX);
  bool pending(double now) const;

  /// The newest of each device and action, in the order of the devices.
  std::vector<Request> requests() const;
  /// What the packets besides the information packet said last, in this session.
  struct Reports {
    std::optional<protocol::ConfigPacket> configuration;
    std::optional<protocol::EncoderPacket> encoders;
    std::optional<protocol::IoPacket> io;
    std::optional<protocol::GripperPacket> gripper;
    std::map<std::uint8_t, std::uint32_t> unread;  ///< packets of types that nobody reads, by type
  };
  const Reports& reports() const { return reports_; }
  /// Whether requests() or reports() say something new since the last call.
  bool take_changed() { return std::exchange(changed_, false); }
  /// Requests that came to a bad end since the last call, in words.
  std::vector<std::string> take_troubles() { return std::exchange(troubles_, {}); }

 private:
  /// What shows that a request was heard.
  enum class Proof { once, thrice, output, servo, origin, motors, sonar, analog, packet };
  struct Item {
    Request request;
    std::vector<protocol::Command> commands;
    Proof proof = Proof::once;
    int value = 0;  ///< what is to be shown
    int mask = 0;
    bool quiet = false;  ///< asked for by nobody: no words where it comes to nothing
    double at = 0.0;
  };
  using Key = std::pair<std::size_t, int>;  ///< device, action

  void note(const Request& request);
  bool shown(const Item& item, const protocol::InformationPacket& packet,
             const protocol::Information& information, bool origin) const;

  void end(Item& item, RequestState state, const std::string& reason = {});
  static void plan(Item& item, const Wish& wish, const protocol::RobotParameters& parameters,
                   std::uint8_t digital_output);

  std::map<Key, Item> items_;
  std::uint8_t digital_output_ = 0;  ///< as the robot shows it
  Reports reports_;
  bool changed_ = false;
  std::vector<std::string> troubles_;
};

}  // namespace saphira::reflector
