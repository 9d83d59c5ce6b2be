#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "saphira/security/door_keys.hpp"
#include "saphira/teleop/control.hpp"

namespace saphira::console {

/// The messages of a page: one JSON object, with "type" as its first word. The list is in
/// README.md.
struct Hello {
  std::string key;
  std::string name;  ///< of the operator, for people
  /// Of the connection whose operator's samples come here as well [empty: its own]. Connections for
  /// pictures with the same one share the pictures.
  std::string ticket;
};
struct Rename {
  std::string name;  ///< of the operator
};
struct Ack {
  std::uint64_t frame = 0;
};
struct Ping {
  double at = 0.0;  ///< returned to the page
};
struct TakeControl {
  bool force = false;
};
struct AskForControl {};
struct GiveControl {
  std::uint64_t to = 0;  ///< an operator who asked
};
struct ReleaseControl {};
struct HandBack {};
struct StopRobot {
  std::uint64_t reference = 0;
};
/// The page shows the list of robots, or no longer.
struct ShowRobots {
  bool shown = false;
};
/// A stop of the list of robots.
struct StopRobots {
  std::uint64_t reference = 0;
  std::string robot;  ///< [empty: all]
};
struct EmergencyStop {};
struct ResetEmergencyStop {};
struct AskGoal {
  std::uint64_t reference = 0;  ///< of the answer
  std::string words;            ///< in the form of `saphira goal`
};
struct Say {
  std::string text;  ///< to the robot, in a person's words
};
struct CancelGoal {
  std::uint64_t reference = 0;
  std::string id;  ///< as on the board
};
struct AskProcess {
  std::uint64_t reference = 0;
  std::string service;
  std::string process;
  std::string functor;  ///< interrupt, suspend, resume
};
/// A change of the map, or of the robot's place on it.
struct ChangeMap {
  std::uint64_t reference = 0;
  std::string words;  ///< put, remove or place in the form of `saphira map`
};
/// The present map as a file.
struct SaveMap {
  std::uint64_t reference = 0;
};
/// A piece of a map file, in the place of the present map. The pieces of a file come in turn.
struct LoadMap {
  std::uint64_t reference = 0;
  std::string name;  ///< of the file, for people and errors
  std::string text;
  bool more = false;  ///< another piece follows
};
/// A place to show to the programs on the bus.
struct PointOut {
  double x = 0.0;  ///< [m] [map], or [odom] without a map
  double y = 0.0;
  bool in_map = true;
};
/// An invalid message.
struct Wrong {
  std::string why;
};

using Message =
    std::variant<Wrong, Hello, Ack, Ping, TakeControl, AskForControl, GiveControl, ReleaseControl,
                 teleop::Control::Sample, HandBack, StopRobot, EmergencyStop, ResetEmergencyStop,
                 AskGoal, Say, CancelGoal, AskProcess, ChangeMap, PointOut, Rename, ShowRobots,
                 StopRobots, SaveMap, LoadMap>;

/// Any text gives a message: Wrong, with the expected form, for an invalid one.
Message parse_message(std::string_view text);

/// The right that a message needs. Everybody who watches may stop; a change for others is to
/// operate.
security::DoorRight right_for(const Message& message);

/// Puts the pieces of a page's file together.
class Upload {
 public:
  /// The text of the file, with its last piece. std::invalid_argument for more than 1 MB.
  std::optional<std::string> take(const LoadMap& piece);

 private:
  std::uint64_t reference_ = 0;
  std::string text_;
};

/// For the pages: holder, name, asked (id and name of each), note, let_go.
std::string to_json(const teleop::Control::State& state);

/// The words of AskGoal. Double quotes keep the spaces of a value, as in place="meeting room";
/// there, a backslash is before a quote or a backslash of the value. std::invalid_argument for a
/// quote that is not closed.
std::vector<std::string> words_of(std::string_view text);

}  // namespace saphira::console
