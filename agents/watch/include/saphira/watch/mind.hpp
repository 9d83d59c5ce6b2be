#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "saphira/watch/processes.hpp"

namespace saphira::watch {

/// The recent samples of a cyclic topic, by cycle; those of the newest epoch only.
template <class T>
class Past {
 public:
  void take(bus::Reader<T>& reader) {
    reader.visit([&](const T& sample, const bus::SampleInfo& info) {
      if (!info.disposed)
        note(sample);
    });
  }
  void note(const T& sample) {
    if (sample.stamp.epoch < epoch_)
      return;
    if (sample.stamp.epoch > epoch_)
      samples_.clear();
    epoch_ = sample.stamp.epoch;
    // The first sample of a cycle stays: a second one is the cycle's result.
    samples_.emplace(sample.stamp.cycle, sample);
    while (samples_.size() > kMost)
      samples_.erase(samples_.begin());
  }
  const T* at(std::uint64_t cycle) const {
    const auto found = samples_.find(cycle);
    return found == samples_.end() ? nullptr : &found->second;
  }
  situation::Known known() const {
    return samples_.empty() ? situation::Known{}
                            : situation::Known{samples_.begin()->first, samples_.rbegin()->first};
  }
  /// The newest cycle for which it `holds` [0: none].
  template <class Holds>
  std::uint64_t newest(Holds holds) const {
    for (auto at = samples_.rbegin(); at != samples_.rend(); ++at)
      if (holds(at->second))
        return at->first;
    return 0;
  }
  /// The cycle since which it `holds` without a break, up to this one [0: it does not, or since
  /// before the oldest sample].
  template <class Holds>
  std::uint64_t since(std::uint64_t cycle, Holds holds) const {
    std::uint64_t first = 0;
    for (auto at = samples_.upper_bound(cycle); at != samples_.begin();) {
      --at;
      if (!holds(at->second))
        return first;
      first = at->first;
    }
    return 0;
  }
  const T* newest() const { return samples_.empty() ? nullptr : &samples_.rbegin()->second; }
  std::uint64_t epoch() const { return epoch_; }

 private:
  static constexpr std::size_t kMost = 1000;
  std::uint64_t epoch_ = 0;
  std::map<std::uint64_t, T> samples_;
};

/// How many cycles the robot has in a second of a clock.
class Pace {
 public:
  /// now: [s]
  void note(const v1::Stamp& stamp, double now) {
    if (stamp.epoch != first_.epoch || stamp.cycle < first_.cycle || now - began_ > kRenewed) {
      first_ = stamp;
      began_ = now;
    }
    if (now - began_ >= kShortest && stamp.cycle > first_.cycle)
      pace_ = static_cast<double>(stamp.cycle - first_.cycle) / (now - began_);
  }
  /// [1/s] [0: not known yet]
  double get() const { return pace_; }

 private:
  static constexpr double kShortest = 0.2;  // [s] for a measurement
  static constexpr double kRenewed = 10.0;  // [s] the rate of a simulation may change
  v1::Stamp first_;
  double began_ = 0.0;
  double pace_ = 0.0;
};

/// The robot's goals, intentions, behaviors and beliefs from the bus: of now and of past cycles.
class Mind {
 public:
  /// recalled: also the last minute. Without samples for a second, the last minute is requested
  /// anyway: a simulator in single step may stand still.
  Mind(bus::Node& node, bool recalled);

  void poll();
  /// The emergency stop is pressed, or a wheel is stalled: its beginning is of interest.
  bool held() const;
  /// Also takes the last minute from now on; false: it is taken already.
  bool recall();
  /// Waits and polls, for that time.
  void listen(std::chrono::milliseconds time, const bus::Stop& stop);

  const v1::RobotState* robot() const { return robots_.newest(); }
  /// It is known how many cycles the robot has in a second.
  bool knows_pace() const { return pace_.get() > 0.0; }
  /// [s] since that came.
  double silence() const { return seconds_since(robot_came_); }
  const v1::Intentions* intentions() const { return intentions_.newest(); }
  const v1::BehaviorSet* behaviors() const { return behaviors_.newest(); }
  /// The newest states of programs with their own behaviors, if recent.
  std::vector<const v1::ProgramMind*> programs() const;
  /// As it came, also without a robot.
  const v1::Grant* grant() const { return grant_ ? &*grant_ : nullptr; }
  const v1::BehaviorSchema* schema(const std::string& name) const;
  const v1::BehaviorSchemas* schemas() const { return schemas_.get(); }
  const v1::BeliefSet* beliefs() const { return beliefs_.get(); }
  const v1::Registration* registration() const { return registration_.get(); }
  /// The micro-tasks of programs that are heard.
  std::vector<v1::ProcessSet> services() const;
  bool heard() const { return intentions_.newest() || behaviors_.newest() || grants_.newest(); }
  const Processes& processes() const { return processes_; }
  /// Rises with each program and each sample of the cycle that is noticed, and again when it is
  /// heard.
  std::size_t news() const;

  /// All known data of a cycle. `past`: the cycle was requested, and is not the present one.
  situation::Situation situation(std::uint64_t cycle, bool past) const;
  /// That of the newest cycle.
  situation::Situation situation() const { return situation(newest_cycle(), false); }
  /// True where all samples of a cycle are there.
  bool whole(std::uint64_t cycle) const;
  /// The newest complete cycle; else the newest with any data; 0: none.
  std::uint64_t newest_cycle() const;
  /// True where the commands to the robot are known.
  bool some(std::uint64_t cycle) const {
    return robots_.at(cycle) != nullptr && grant_for(cycle) != nullptr;
  }
  /// The oldest and newest cycle with a robot state.
  std::pair<std::uint64_t, std::uint64_t> known() const;
  /// True where the schemas and goals, which are not cyclic, are complete.
  bool knows_goals() const;

 private:
  struct Recall {
    bus::Reader<v1::RobotState> robots;
    bus::Reader<v1::Grant> grants;
    bus::Reader<v1::BehaviorSet> behaviors;
    bus::Reader<v1::Intentions> intentions;
    bus::Reader<v1::GoalStatusSet> goals;
  };
  void take_past_goals();
  /// A simulator in single step may stand still.
  bool lockstep() const { return description_ && description_->lockstep; }
  std::vector<v1::GoalStatus> goals_at(std::uint64_t cycle) const;
  const v1::Grant* grant_for(std::uint64_t cycle) const;
  const v1::ProgramMind* program(const std::string& source, std::uint64_t cycle) const;

  bus::Node& node_;
  Processes processes_;
  bus::Reader<v1::RobotState> robot_reader_ = node_.reader(bus::topics::kRobotState);
  bus::Reader<v1::Grant> grant_reader_ = node_.reader(bus::topics::kGrant);
  bus::Reader<v1::BehaviorSet> behavior_reader_ = node_.reader(bus::topics::kBehaviors);
  bus::Reader<v1::Intentions> intention_reader_ = node_.reader(bus::topics::kIntentions);
  bus::Reader<v1::Goal> goal_reader_ = node_.reader(bus::topics::kGoals);
  bus::Reader<v1::GoalStatus> status_reader_ = node_.reader(bus::topics::kGoalStatus);
  bus::Reader<v1::ProcessSet> process_reader_ = node_.reader(bus::topics::kProcesses);
  bus::Reader<v1::ProgramMind> program_reader_ = node_.reader(bus::topics::kProgramMinds);
  std::unique_ptr<Recall> recall_;
  Clock::time_point began_ = Clock::now();
  Clock::time_point robot_came_ = Clock::now();
  Pace pace_;

  Newest<v1::RobotDescription> description_{node_, bus::topics::kRobotDescription};
  Past<v1::RobotState> robots_;
  Past<v1::Grant> grants_;
  std::optional<v1::Grant> grant_;  ///< the newest
  Past<v1::BehaviorSet> behaviors_;
  Past<v1::Intentions> intentions_;
  using Key = std::pair<std::uint64_t, std::uint64_t>;
  std::map<Key, v1::Goal> goals_;
  std::map<Key, v1::GoalStatus> statuses_;
  /// Past goal statuses, by the epoch and cycle of their publication.
  std::map<std::pair<std::uint64_t, std::uint64_t>, v1::GoalStatusSet> past_goals_;
  Newest<v1::BehaviorSchemas> schemas_{node_, bus::topics::kBehaviorSchemas};
  Newest<v1::BeliefSet> beliefs_{node_, bus::topics::kBeliefs};
  Newest<v1::Registration> registration_{node_, bus::topics::kRegistration};
  std::uint64_t doubtful_since_ = 0;  ///< cycle [0: it is not, or was so before we came]
  std::map<std::uint64_t, v1::ProcessSet> services_;         ///< by instance
  std::map<std::uint64_t, Past<v1::ProgramMind>> programs_;  ///< likewise
};

}  // namespace saphira::watch
