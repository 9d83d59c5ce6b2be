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
  int port = 0;       ///< where people reach it
  std::string token;  ///< by which its gateway is known
};

/// The robots of a file: a line for each, `NAME PORT TOKEN`; # begins a comment.
/// std::invalid_argument that names the line.
std::vector<Robot> parse_robots(const std::string& file, std::string_view text);

/// Where a gateway dials: wss://HOST[:PORT]/ROBOT.
struct Address {
  bool encrypted = true;  ///< wss, and not ws
  std::string host;
  int port = 443;
  std::string robot;
};
/// std::invalid_argument that says what is expected. ws:// is for this machine alone.
Address parse_address(std::string_view text);

/// The path by which a gateway comes: /dial/ROBOT or /carry/ROBOT/TICKET.
struct Path {
  std::string robot;
  std::string ticket;  ///< empty: it dials in
};
/// Nothing where it is neither.
std::optional<Path> parse_path(std::string_view text);

/// Brings those who come to a robot's port together with the connections that its gateway opens for
/// them. Pure. Times [s] may begin anywhere.
class Rendezvous {
 public:
  using Visitor = std::uint64_t;

  explicit Rendezvous(std::vector<Robot> robots) : robots_(std::move(robots)) {}
  const std::vector<Robot>& robots() const { return robots_; }

  /// True where this is the token of that robot. Takes as long for a wrong one.
  bool knows(std::string_view robot, std::string_view token) const;

  /// Somebody has come from an address of the network to the port of a robot, and is fetched by
  /// this ticket. False: too many are there.
  bool arrive(const std::string& robot, const std::string& from, Visitor visitor,
              const std::string& ticket, double now);
  /// The gateway of that robot fetches the visitor of a ticket. Nothing: nobody of that ticket
  /// waits.
  std::optional<Visitor> fetch(const std::string& robot, const std::string& ticket);
  /// The visitor has left, waiting or fetched.
  void leave(Visitor visitor);
  /// Those who have waited too long: they have left now.
  std::vector<Visitor> expire(double now);

  static constexpr std::size_t kMost = 64;         ///< visitors of a robot
  static constexpr std::size_t kMostFromOne = 24;  ///< of these from one address
  static constexpr double kPatience = 10.0;        ///< [s] that a visitor waits to be fetched

 private:
  struct Guest {
    std::string robot;
    std::string from;
    std::string ticket;
    double since = 0.0;
    bool waits = true;
  };
  std::vector<Robot> robots_;
  std::map<Visitor, Guest> guests_;
};

}  // namespace saphira::relay
