#pragma once

#include <map>
#include <optional>
#include <string>

#include "saphira/bus/node.hpp"

namespace saphira::bridge {

/// Decides from the status of the services whether they receive the bridge's samples. Pure: the
/// time, in seconds, is an argument.
class Audience {
 public:
  /// [s] Services that do not hear the robot begin anew on the bus themselves after 10 s. A bridge
  /// that none of them hears after that is mute.
  static constexpr double kMute = 13.0;
  /// [s] between two new beginnings of a bridge.
  static constexpr double kAgain = 60.0;

  void update(const bus::WriterId& writer, const v1::ServiceStatus& status, double now);
  void lose(const bus::WriterId& writer) { programs_.erase(writer); }

  /// True where to begin anew now: some program waits for the robot, none hears it, and that for
  /// kMute. At most once in kAgain.
  bool begins_anew(double now);

 private:
  struct Program {
    v1::Stamp stamp;
    bool steps = false;           ///< its stamp moves on, and it does not wait for the robot
    std::optional<double> waits;  ///< for the robot, since when
  };

  std::map<bus::WriterId, Program> programs_;
  std::optional<double> anew_;
};

/// The status of other programs, as the bridge uses it. Other bridges with a robot of this name: a
/// program that follows the name would obey both. And the services: where none of them hears this
/// bridge, it begins anew on the bus.
class OtherPrograms {
 public:
  explicit OtherPrograms(bus::Node& node);

  /// Takes the programs' status. A new namesake is logged as an error.
  void take();

  bool has_namesake() const { return !others_.empty(); }
  /// One of the namesakes, in words; only where there is any.
  const std::string& namesake() const { return others_.begin()->second; }

 private:
  void note(const v1::ServiceStatus& other, const bus::SampleInfo& info);
  bool has_robot() const;

  bus::Node& node_;
  bus::Reader<v1::ServiceStatus> statuses_;
  std::map<bus::WriterId, std::string> others_;
  Audience audience_;
};

}  // namespace saphira::bridge
