#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace saphira::relay {

/// A robot that may dial in.
struct Robot {
  std::string name;
  int port = 0;       ///< the port for people
  std::string token;  ///< identifies its gateway
};

/// The robots of a file: a line for each, `NAME PORT TOKEN`; # begins a comment.
/// std::invalid_argument that names the line.
std::vector<Robot> parse_robots(const std::string& file, std::string_view text);

/// The address that a gateway dials: wss://HOST[:PORT]/ROBOT.
struct Address {
  bool encrypted = true;  ///< wss, and not ws
  std::string host;
  int port = 443;
  std::string robot;
};
/// std::invalid_argument gives the expected form. ws:// is for this machine alone.
Address parse_address(std::string_view text);

/// The path of a gateway's connection: /dial/ROBOT or /carry/ROBOT/TICKET.
struct Path {
  std::string robot;
  std::string ticket;  ///< empty: it dials in
};
/// Nothing for any other path.
std::optional<Path> parse_path(std::string_view text);

/// Joins visitors of a robot's port with the connections that its gateway opens for them. Pure.
/// Times [s] of any origin.
class Rendezvous {
 public:
  using Visitor = std::uint64_t;

  explicit Rendezvous(std::vector<Robot> robots) : robots_(std::move(robots)) {}
  const std::vector<Robot>& robots() const { return robots_; }

  /// True for the token of that robot. A wrong one takes as long.
  bool knows(std::string_view robot, std::string_view token) const;

  /// A visitor has come from a network address to the port of a robot, to be fetched by this
  /// ticket. The visitor that gives place to it, where the address or the robot has too many: of
  /// those from that address, or from the one with the most, the one that was silent for longest.
  std::optional<Visitor> arrive(const std::string& robot, const std::string& from, Visitor visitor,
                                const std::string& ticket, double now);
  /// Bytes have come from the visitor.
  void heard(Visitor visitor, double now);
  /// The gateway of that robot fetches the visitor of a ticket. Nothing: no such visitor waits.
  std::optional<Visitor> fetch(const std::string& robot, const std::string& ticket);
  /// The visitor has left, waiting or fetched.
  void leave(Visitor visitor);
  /// Visitors that have waited too long: they are removed.
  std::vector<Visitor> expire(double now);

  static constexpr std::size_t kMost = 64;         ///< visitors of a robot
  static constexpr std::size_t kMostFromOne = 24;  ///< of these from one network address
  static constexpr double kPatience = 10.0;        ///< [s] longest wait of a visitor

 private:
  struct Guest {
    std::string robot;
    std::string from;
    std::string ticket;
    double since = 0.0;
    double heard = 0.0;  ///< when its newest bytes came
    bool waits = true;
  };
  std::vector<Robot> robots_;
  std::map<Visitor, Guest> guests_;
};

}  // namespace saphira::relay
