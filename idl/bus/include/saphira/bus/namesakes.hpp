#pragma once

#include <chrono>
#include <memory>

#include "saphira/bus/node.hpp"

namespace saphira::bus {

/// The other programs of this node's name for its robot. Two that act at a time would contradict
/// each other (two deployments, or a restart before the last one's death is noticed): one serves,
/// the others wait.
class Namesakes {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Namesakes(Node& node);
  ~Namesakes();

  /// Takes the others' statuses. True where this program must not act: another one serves, as the
  /// node's status then says, or may serve. Announcements come before the samples of any topic, so
  /// a program that begins knows of another one before it hears goals or the robot.
  bool poll();
  /// The result of the newest poll().
  bool waits() const;
  /// This program acts: from now on only a status makes it wait.
  void act();
  /// True when another program has served and is gone: files and the state on the bus are that
  /// one's by now, so this program's own state is made anew.
  bool superseded() const;
  /// True where another program of this robot has been stepping without a break since that time,
  /// which shows that the robot is heard.
  bool stepping_since(Clock::time_point since) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saphira::bus
