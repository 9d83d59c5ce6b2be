#pragma once

#include <algorithm>
#include <map>

#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/watch/roll.hpp"
#include "watch.hpp"

namespace saphira::cli {

/// The bridges with this robot's name, or of every robot, and their newest grants. Usually there is
/// one; a stop has to reach all.
class Bridges {
 public:
  explicit Bridges(bus::Node& node)
      : node_(node),
        census_(node),
        grants_(node.reader(bus::topics::kGrant)),
        roll_(quiet(node)),
        robot_(node.options().robot),
        every_robot_(node.options().robot == kEveryRobot) {}

  void poll() {
    for (auto& sample : grants_.take()) {
      newest_ = sample.data;
      heard_[sample.info.writer] = {std::move(sample.data), Clock::now()};
    }
    for (const bus::WriterId& lost : grants_.take_lost())
      heard_.erase(lost);
    std::erase_if(heard_, [](const auto& one) { return seconds_since(one.second.came) > kSilent; });
    std::vector<bus::ProgramEntry> announced = bus::found_programs(node_);
    // With --robot NAME a program of every robot is met as well.
    std::erase_if(announced, [&](const bus::ProgramEntry& one) {
      return one.silent || one.refused || (!every_robot_ && one.robot != robot_);
    });
    roll_.update(announced, heard(), now());
  }
  std::size_t count() const { return roll_.count(); }
  /// All of them are known.
  bool complete() const { return roll_.complete(now()); }
  /// The robots of bridges that none of these writers is of, in words.
  std::string without(const std::set<bus::WriterId>& writers) const {
    return joined(roll_.without(writers));
  }
  /// For a request to all of them. `answered`: gets those that have answered.
  bus::RequestClient::Servers servers(std::set<bus::WriterId>* answered = nullptr) const {
    return {[this, answered](const std::set<bus::WriterId>& told) {
              if (answered != nullptr)
                *answered = told;
              return roll_.without(told).empty();
            },
            [this] { return complete(); }};
  }
  /// Of any bridge.
  const std::optional<v1::Grant>& newest() const { return newest_; }
  /// True where there is a bridge, and it holds for each.
  template <class Holds>
  bool all(Holds holds) const {
    return !heard_.empty() && roll_.without(heard()).empty() &&
           std::ranges::all_of(heard_, [&](const auto& one) { return holds(one.second.grant); });
  }
  /// The robots whose bridges do not say so, in words.
  template <class Holds>
  std::string not_so(Holds holds) const {
    std::set<bus::WriterId> so;
    for (const auto& [writer, one] : heard_)
      if (holds(one.grant))
        so.insert(writer);
    return without(so);
  }
  /// " of 2 robots of this name"; empty with one bridge.
  std::string several() const {
    if (count() < 2)
      return {};
    return " of " + std::to_string(count()) + " robots" + (every_robot_ ? "" : " of this name");
  }
  /// ": ant, bee", or the remedy for robots of one name; empty with one bridge.
  std::string names() const {
    if (count() < 2)
      return {};
    return every_robot_ ? ": " + joined(roll_.robots()) : "; give one of them another (--robot)";
  }
  /// The words for a stop that these robots' bridges have not confirmed.
  std::string unconfirmed(const std::string& missing, double seconds,
                          const Processes& processes) const {
    return format(
        "NOT CONFIRMED%s for %.0f s: %s. Stop the robot by its own switch. This goes on trying; "
        "Ctrl-C ends it.",
        count() < 2 ? "" : (" by each bridge" + several()).c_str(), seconds,
        count() < 2 ? who_is_there(processes).c_str() : ("not by that of " + missing).c_str());
  }

 private:
  static constexpr double kSilent = 1.0;  ///< [s] a bridge writes ten grants a second
  struct Heard {
    v1::Grant grant;
    Clock::time_point came;
  };
  /// [s] after which all bridges are found. A second bridge of this robot's name on this machine
  /// has announced itself twice by then; other robots and other machines have more time.
  static double quiet(const bus::Node& node) {
    const bus::NodeOptions& options = node.options();
    if (options.robot != kEveryRobot && options.profile == bus::Profile::host && !node.identity())
      return 0.5;
    return std::chrono::duration<double>(listening_time(node)).count();
  }
  static double now() {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  }
  std::set<bus::WriterId> heard() const {
    std::set<bus::WriterId> writers;
    for (const auto& [writer, one] : heard_)
      writers.insert(writer);
    return writers;
  }

  bus::Node& node_;
  bus::Census census_;
  bus::Reader<v1::Grant> grants_;
  watch::Roll roll_;
  const std::string robot_;
  const bool every_robot_;
  std::map<bus::WriterId, Heard> heard_;
  std::optional<v1::Grant> newest_;
};

}  // namespace saphira::cli
