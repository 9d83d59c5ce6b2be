#pragma once

#include <map>
#include <string>

#include "audience.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bridge {

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
