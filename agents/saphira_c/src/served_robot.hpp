#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "robot.hpp"

namespace saphira::c {

/// A robot with the thread that serves it, and what that thread shares with the program's. A
/// derived class starts the thread, and calls end() in its destructor.
class ServedRobot : public Robot {
 public:
  std::uint64_t session() const override {
    const std::lock_guard lock(mutex_);
    return session_;
  }
  protocol::RobotParameters parameters() const override {
    const std::lock_guard lock(mutex_);
    return parameters_;
  }
  protocol::RobotIdentity identity() const override {
    const std::lock_guard lock(mutex_);
    return identity_;
  }
  std::string trouble() const override {
    const std::lock_guard lock(mutex_);
    return trouble_;
  }
  std::optional<Reflected> next(int milliseconds) override {
    std::unique_lock lock(mutex_);
    came_.wait_for(lock, std::chrono::milliseconds(milliseconds),
                   [this] { return fresh_ || ended_; });
    if (!std::exchange(fresh_, false))
      return std::nullopt;
    Reflected now{session_, newest_};
    now.state.information.sonars = std::exchange(readings_, {});
    return now;
  }
  void send(protocol::Bytes packet) override {
    const std::lock_guard lock(mutex_);
    packets_.push_back(std::move(packet));
    wake();
  }
  protocol::VisionPacket vision(std::uint64_t& count) const override {
    const std::lock_guard lock(mutex_);
    count = seen_count_;
    return seen_;
  }
  void end() override {
    {
      std::unique_lock lock(mutex_);
      ending_ = true;
      wake();
      came_.wait_for(lock, std::chrono::seconds(1), [this] { return ended_; });
    }
    if (thread_.joinable())
      thread_.join();
  }

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
};

}  // namespace saphira::c
