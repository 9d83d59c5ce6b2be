#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/intentions/activity.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// An activity's parameters for a behavior. Points on the map, and moving things, follow their
/// present place in odom while the behavior lasts.
class BehaviorParameters {
 public:
  BehaviorParameters() = default;
  /// `behavior`: its schema's name; `known`: its signature from the behaviors service, nullptr
  /// while there is none. ActivityError for an impossible parameter.
  BehaviorParameters(const Bindings& given, const std::string& behavior,
                     const BehaviorSignature* known, const World& world);

  /// Writes them into `parameters`, or updates these. An unknown point keeps its last place; false
  /// where it never had one.
  bool place(Arguments& parameters, const World& world) const;

  SAPHIRA_ARCHIVE(given_, things_, on_map_)

 private:
  Arguments given_;
  std::vector<std::uint64_t> things_;  ///< of each parameter lps::SeenThing::id, or 0
  bool on_map_ = false;                ///< some of them are on the map
};

}  // namespace saphira::intentions
