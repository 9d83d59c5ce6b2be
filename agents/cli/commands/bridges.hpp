#pragma once

#include <algorithm>
#include <map>

#include "watch.hpp"

namespace saphira::cli {

/// The newest grant of every bridge with this robot's name, or of every robot. Usually there is
/// one; a stop has to reach all.
class Bridges {
 public:
  explicit Bridges(bus::Node& node)
      : grants_(node.reader(bus::topics::kGrant)),
        every_robot_(node.options().robot == kEveryRobot) {}

  void poll() {
    for (auto& sample : grants_.take()) {
      newest_ = sample.data;
      heard_[sample.info.writer] = {std::move(sample.data), Clock::now()};
    }
    for (const bus::WriterId& lost : grants_.take_lost())
      heard_.erase(lost);
    std::erase_if(heard_, [](const auto& one) { return seconds_since(one.second.came) > kSilent; });
  }
  std::size_t count() const { return heard_.size(); }
  /// Of any bridge.
  const std::optional<v1::Grant>& newest() const { return newest_; }
  /// True where there is a bridge, and it holds for each.
  template <class Holds>
  bool all(Holds holds) const {
    return !heard_.empty() &&
           std::ranges::all_of(heard_, [&](const auto& one) { return holds(one.second.grant); });
  }
  /// " of 2 robots of this name: give one of them another (--robot)"; empty with one bridge.
  std::string several() const {
    if (heard_.size() < 2)
      return {};
    return " of " + std::to_string(heard_.size()) + " robots" +
           (every_robot_ ? "" : " of this name: give one of them another (--robot)");
  }

 private:
  static constexpr double kSilent = 1.0;  ///< [s] a bridge writes ten grants a second
  struct Heard {
    v1::Grant grant;
    Clock::time_point came;
  };
  bus::Reader<v1::Grant> grants_;
  const bool every_robot_;
  std::map<bus::WriterId, Heard> heard_;
  std::optional<v1::Grant> newest_;
};

/// [s] Every bridge on the bus is heard within this time.
inline constexpr double kAllHeard = 0.6;

}  // namespace saphira::cli
