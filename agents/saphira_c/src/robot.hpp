#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "saphira/base/process.hpp"
#include "saphira/behaviors/executive.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/protocol/command.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/reflector/reflector.hpp"

namespace saphira::c {

/// The inputs of one cycle.
struct Reflected {
  std::uint64_t session = 0;  ///< another number for each connection
  reflector::State state;
};

/// The results of the services of a robot on the bus.
struct Found {
  std::optional<lps::Percept> left_wall;   ///< sfLeftWallHyp
  std::optional<lps::Percept> right_wall;  ///< sfRightWallHyp
  std::optional<Pose> odom_in_map;         ///< while registration has the robot's pose
  std::shared_ptr<const maps::Map> map;    ///< a new object after a change
  std::uint32_t environment = 0;           ///< the artifact around the robot; 0: none known
};

/// A micro-task for other programs.
struct SharedTask {
  std::string name;
  std::string effect;  ///< description, for people
  int state = 0;       ///< manual Table 6-3
};
/// An intention of the program (manual 8).
struct SharedIntention {
  std::uint32_t id = 0;
  std::uint32_t parent = 0;  ///< 0: none
  std::string name;
  std::string behavior;  ///< the behavior it stands for; empty: a function
  int state = 0;         ///< as above, or an end of Table 8-1
};
/// The program's behaviors and intentions in a cycle.
struct SharedMind {
  std::uint64_t cycle = 0;  ///< of the robot
  behaviors::Output behaviors;
  std::vector<SharedIntention> intentions;
};
/// The request of another program to a micro-task.
struct TaskRequest {
  std::string name;
  ProcessAction action = ProcessAction::suspend;
};

/// The style of the next drawing.
struct Pen {
  int width = 1;  ///< [pixels]
  int dashed = 0;
  int line = 14;  ///< a colour of Table 6-4
  int patch = 14;
};
/// A rectangle from the program, or the line across it: its lower left corner in the LPS, its
/// extent [mm].
struct Drawn {
  Pen pen;
  bool line = false;
  float x = 0.0F;
  float y = 0.0F;
  float dx = 0.0F;
  float dy = 0.0F;
};

/// The robot of a C program, on any connection. A thread of its own serves it, so that the robot
/// stops when the program hangs. A derived class starts the thread, and calls end() in its
/// destructor.
class Robot {
 public:
  virtual ~Robot() = default;

  /// Of the connection; changed between two sessions only.
  std::uint64_t session() const { return shared(session_); }  ///< 0: not connected
  protocol::RobotParameters parameters() const { return shared(parameters_); }
  protocol::RobotIdentity identity() const { return shared(identity_); }
  /// The reason why it is not connected, in words.
  std::string trouble() const { return shared(trouble_); }

  /// Waits until a new cycle begins; nothing where none does in time, or the connection is lost.
  /// The newest counts: cycles in which the caller was busy are skipped, with their sonar readings
  /// kept.
  std::optional<Reflected> next(int milliseconds) {
    std::unique_lock lock(mutex_);
    came_.wait_for(lock, std::chrono::milliseconds(milliseconds),
                   [this] { return fresh_ || ended_; });
    if (!std::exchange(fresh_, false))
      return std::nullopt;
    Reflected now{session_, newest_};
    now.state.information.sonars = std::exchange(readings_, {});
    return now;
  }
  /// The program's motion command, in answer to the cycle. It is valid for 0.3 s.
  virtual void drive(const reflector::Motion& motion, std::uint64_t cycle) = 0;
  /// A packet to the robot, as it is.
  void send(protocol::Bytes packet) {
    const std::lock_guard lock(mutex_);
    packets_.push_back(std::move(packet));
    wake();
  }
  /// The newest packet of the camera; count: the number of packets so far.
  protocol::VisionPacket vision(std::uint64_t& count) const {
    const std::lock_guard lock(mutex_);
    count = seen_count_;
    return seen_;
  }
  /// Stops the robot and releases it. Waits a second at most.
  virtual void end() {
    {
      std::unique_lock lock(mutex_);
      ending_ = true;
      wake();
      came_.wait_for(lock, std::chrono::seconds(1), [this] { return ended_; });
    }
    if (thread_.joinable())
      thread_.join();
  }

  // ---- Only for a robot on the bus.
  // The results of its services; nothing: it has none, and the program computes them itself.
  virtual std::optional<Found> found() { return std::nullopt; }
  /// Shows the program's micro-tasks to others, with its behaviors and intentions, if any. Returns
  /// the others' requests since the last call.
  virtual std::vector<TaskRequest> share(std::vector<SharedTask>, std::optional<SharedMind>) {
    return {};
  }
  /// True where somebody has stopped the robot since the last call. Until it, motion commands are
  /// dropped.
  virtual bool take_stop() { return false; }
  /// The driver in role teleop that preempted this program since the last call; empty: none.
  virtual std::string take_driver() { return {}; }
  /// Asks the bridge to end whatever moves the robot.
  virtual void stop() {}
  /// For observers: the drawings of this cycle, and a line of text.
  virtual void draw(std::vector<Drawn>) {}
  virtual void tell(const std::string&) {}
  /// The places that observers have pointed out since the last call [m] [odom].
  virtual std::vector<Vec2> pointed_out() { return {}; }
  /// Sends a request to registration; reports it and its result.
  virtual void load_map(const std::string& /*text*/, const std::string& /*name*/) {}
  virtual void place(const Pose& /*robot_in_map*/) {}

 protected:
  /// Ends the thread's wait. Call these under the mutex.
  virtual void wake() = 0;
  void cycle_began(const reflector::State& state) {
    constexpr std::size_t kMostKept = 1000;  // sonar readings of skipped cycles
    newest_ = state;
    const auto& readings = state.information.sonars;
    readings_.insert(readings_.end(), readings.begin(), readings.end());
    if (readings_.size() > kMostKept)
      readings_.erase(readings_.begin(), readings_.end() - static_cast<std::ptrdiff_t>(kMostKept));
    fresh_ = true;
    came_.notify_all();
  }
  void session_lost(const std::string& why) {
    session_ = 0;
    fresh_ = false;
    trouble_ = why;
    came_.notify_all();
  }
  void thread_ended() {
    session_ = 0;
    ended_ = true;
    came_.notify_all();
  }

  mutable std::mutex mutex_;  ///< of the following members
  std::condition_variable came_;
  bool ending_ = false;
  bool ended_ = false;
  bool fresh_ = false;
  std::uint64_t session_ = 0;
  protocol::RobotParameters parameters_;
  protocol::RobotIdentity identity_;
  std::string trouble_;
  reflector::State newest_;
  std::vector<protocol::Sonar> readings_;
  std::vector<protocol::Bytes> packets_;
  protocol::VisionPacket seen_;
  std::uint64_t seen_count_ = 0;
  std::thread thread_;

 private:
  template <class T>
  T shared(const T& member) const {
    const std::lock_guard lock(mutex_);
    return member;
  }
};

/// Takes lines for people; called in any thread.
using Say = std::function<void(const std::string&, bool error)>;

/// A robot server at this address, behind the bridge's core: its session, guard and lease.
/// std::invalid_argument for an invalid address.
std::unique_ptr<Robot> direct_robot(const std::string& address, Say say);

/// The robot of that name on the bus, by the library's module for the bus, which is loaded for it;
/// the other bus options come from the environment (SAPHIRA_DOMAIN and so on).
/// std::invalid_argument where that is no robot's name, std::runtime_error without that module.
std::unique_ptr<Robot> bus_robot(const std::string& name, Say say);
/// The function that this module exports under the name kBusRobot.
using MakeBusRobot = Robot* (*)(const std::string& name, Say say);
inline constexpr const char* kBusRobot = "saphira_c_bus_robot";
/// The beginning of an address, before the robot's name on the bus.
inline constexpr const char* kOnBus = "bus:";
/// The robot of an address.
std::unique_ptr<Robot> robot_at(const std::string& address, Say say);
/// The robot that the environment names (SAPHIRA_ROBOT), as an address; empty: none.
std::string robot_of_environment();

/// The path of a program of ours, for any place of this library; always a path.
std::string beside_library(const std::string& path);
/// The folder of robots and behaviors; std::runtime_error without one.
std::string configuration();

}  // namespace saphira::c
