#pragma once

#include <map>
#include <string>

#include "audience.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bridge {

/// The meaning of the other programs' status for the bridge. Other bridges that have a robot of
/// this name: whoever follows that name would obey them and this one. And the services: where none
/// of them hears this bridge, it begins anew on the bus.
class OtherPrograms {
 public:
  explicit OtherPrograms(bus::Node& node);

  /// Takes in what the programs say of themselves. A new namesake is told to people as an error.
  void take();

  bool has_namesake() const { return !others_.empty(); }
  /// One of them, in words; only where there is any.
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
