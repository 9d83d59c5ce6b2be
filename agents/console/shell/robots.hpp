#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "saphira/bus/introspect.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/console/robots.hpp"
#include "saphira/teleop/pilot.hpp"
#include "saphira/watch/mind.hpp"

namespace saphira::console {

/// The other robots of the bus. While a page shows the list, this program joins the partition of
/// each robot, reads its state and can stop it. Otherwise it only lists their names. Times are
/// seconds of any steady clock.
class Robots {
 public:
  explicit Robots(bus::Node& own) : own_(own) {}

  /// Looks for robots: each two seconds, and twice a second while the list is shown and 5 s longer,
  /// so that a stop of that time is repeated until the bridge has taken it.
  void find(bool shown, double now);
  /// Reads the new samples, and repeats stops that the bridge has not taken yet.
  void poll(double now);
  /// The robots but for the own one. While nobody looks, their names alone.
  std::vector<RobotSeen> seen() const;
  void stop(const std::string& robot, bool latched, const std::string& person);

 private:
  struct Member {
    Member(bus::NodeOptions options, const std::string& robot);
    bus::Node node;
    watch::Mind mind{node, false};
    bus::Reader<v1::ConsolePage> pages = node.reader(bus::topics::kPage);
    bus::Writer<v1::MotorCommand> estop = node.writer(bus::topics::kDriveEstop);
    bus::RequestClient stops{node, bus::topics::kDriveStop, "console"};
    teleop::Pilot pilot{"console"};
    std::map<bus::WriterId, v1::ConsolePage> page;
    std::string why;
    double explained = -1e9;  ///< [s]
  };
  struct Robot {
    std::unique_ptr<Member> member;  ///< none: nobody looks, or it cannot be joined
    std::string trouble;             ///< why it cannot
  };

  bus::Node& own_;
  std::map<std::string, Robot> robots_;
  double looked_ = -1e9;  ///< [s]
  double shown_ = -1e9;   ///< [s]
};

}  // namespace saphira::console
