#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "saphira/bus/node.hpp"
#include "saphira/bus/stop_notice.hpp"
#include "watch.hpp"

namespace saphira::cli {

inline constexpr std::chrono::milliseconds kDrivePeriod{50};  ///< the bridge's lease is 300 ms

/// Plays a role on drive/...: writes commands with the required members, and reports their results.
/// The owner calls drive() and poll() every kDrivePeriod.
class DirectDriver {
 public:
  DirectDriver(bus::Node& node, const bus::Topic<v1::MotorCommand>& topic,
               const std::string& program);

  /// Writes the command, stamped with the robot's newest state.
  void drive(v1::MotorCommand command);
  /// Lets the role go, which stops the robot.
  void release();
  void poll();

  const std::string& source() const { return source_; }
  /// Null until it was heard.
  const v1::RobotState* robot() const { return robot_.get(); }
  const std::optional<v1::Grant>& grant() const { return grant_; }
  /// True where a command of this driver goes to the wheels.
  bool drives() const;
  /// By whom it was stopped since it began; empty: nobody has.
  const std::string& stopped_by() const { return stopped_by_; }
  /// A new trouble in words, each kind once: another driver, a refusal, the guard, no bridge.
  std::optional<std::string> news();
  /// The present trouble in words; empty: none.
  std::string trouble() const;

 private:
  bus::Node& node_;
  Processes processes_;
  bus::Writer<v1::MotorCommand> commands_;
  bus::Reader<v1::Grant> grants_ = node_.reader(bus::topics::kGrant);
  std::string source_;
  std::uint64_t number_ = 0;
  Newest<v1::RobotState> robot_{node_, bus::topics::kRobotState};
  std::optional<v1::Grant> grant_;
  std::string refusal_;
  bus::StopNotice stops_;
  std::string stopped_by_;
  Clock::time_point began_ = Clock::now();
  Clock::time_point drove_ = began_;  ///< last, or the time of the first command
  std::string told_;
};

/// The names of all topics.
std::vector<std::string> topic_names();
/// Throws std::invalid_argument, with a guess, where there is no such topic.
void expect_topic(const std::string& topic);
/// The name of its QoS.
std::string qos_of(const std::string& topic);

}  // namespace saphira::cli
