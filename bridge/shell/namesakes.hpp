#pragma once

#include <map>
#include <string>

#include "saphira/bus/node.hpp"

namespace saphira::bridge {

/// The other bridges that have a robot of this name. Whoever follows that name would obey them and
/// this one.
class Namesakes {
 public:
  explicit Namesakes(bus::Node& node);

  /// Takes in what the programs say of themselves. A new namesake is told to people as an error.
  void take();

  bool any() const { return !others_.empty(); }
  /// One of them, in words; only where there is any.
  const std::string& who() const { return others_.begin()->second; }

 private:
  bus::Node& node_;
  bus::Reader<v1::ServiceStatus> statuses_;
  std::map<bus::WriterId, std::string> others_;
};

}  // namespace saphira::bridge
