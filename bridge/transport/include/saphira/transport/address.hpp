#pragma once

#include <string>
#include <vector>

namespace saphira::transport {

/// The address of a robot server (manual Table 5-6), as people write it:
///   /dev/ttyS0, /dev/ttyUSB0@19200   a serial line, or a pseudo-terminal [9600 baud, 8N1]
///   serial:/path@38400,8E1,rtscts    the same with all its settings
///   unix:/path                       a local socket (the simulator's)
///   /path, ./path, /path@19200       either, by its type when opened; with a rate, a line
///   tcp:host:port                    a network
///   ros2:NAMESPACE,domain=7,...      a robot that only speaks ROS 2 [no namespace, ROS_DOMAIN_ID];
///                                    words are options of the program that translates
struct Address {
  enum class Kind { serial, local, tcp, ros2 };
  Kind kind = Kind::local;
  std::string name;  ///< device, path, host, or the whole of ros2:...
  int baud = 9600;
  char parity = 'N';          ///< N, E, O
  int stop_bits = 1;          ///< 1, 2
  bool flow_control = false;  ///< by RTS and CTS
  int port = 0;
  std::vector<std::string> arguments;  ///< of the program that translates for ROS 2
  bool plain_path = false;             ///< no prefix: `settle` finds the kind

  /// Finds the kind of a plain path by its present file: a character device is a serial line, any
  /// other a local socket.
  void settle();
  std::string text() const;
};

/// std::invalid_argument gives the expected form.
Address parse_address(const std::string& text);

/// The reason why its serial line cannot be opened now; empty: it can, or it has none.
std::string line_trouble(const Address& address);

/// The program that translates for ROS 2, beside this one, and the end of its socket that it is
/// started with. Until there is a robot it tells why there is none, a line each, and then an empty
/// line. After that the socket carries packets. It ends with its client, after stopping the robot.
inline constexpr const char* kRos2Program = "saphira-ros2-base";
inline constexpr int kRos2Socket = 3;

/// The socket of a simulator on this machine: $ROBOT_SOCKET, else /tmp/saphira-robot-<uid>.
std::string default_address();

}  // namespace saphira::transport
