#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/intentions/activity.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// The parameters that an activity has given to a behavior: points that are on the map, and things
/// that move, are where they are in odom now, for as long as the behavior lasts.
class BehaviorParameters {
 public:
  BehaviorParameters() = default;
  /// `behavior`: its schema's name; `known`: what the behaviors service says of it, nullptr while
  /// it has said nothing. ActivityError where a parameter cannot be what is given.
  BehaviorParameters(const Bindings& given, const std::string& behavior,
                     const BehaviorSignature* known, const World& world);

  /// Puts them into `parameters`, or brings these up to date. What is not known now stays where it
  /// was; false where that has never been known.
  bool place(Arguments& parameters, const World& world) const;

 private:
  Arguments given_;
  std::vector<std::uint64_t> things_;  ///< of each parameter lps::SeenThing::id, or 0
  bool on_map_ = false;                ///< some of them are
};

}  // namespace saphira::intentions
