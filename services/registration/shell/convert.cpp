#include "registration/shell/convert.hpp"

#include "lps/shell/convert.hpp"

namespace saphira::registration {
namespace {

constexpr std::size_t kMostMatches = 256;  // the bound of Registration.matches

}  // namespace

v1::Registration to_bus(const Core::Outputs& outputs, const Pose& pose_in_odom) {
  return {
      .state = outputs.state,
      .reason = outputs.reason,
      .pose_in_map = lps::to_bus(outputs.pose_in_map),
      .odom_in_map = lps::to_bus(compose(outputs.pose_in_map, relative(pose_in_odom, Pose{}))),
      .covariance = {outputs.covariance(0, 0), outputs.covariance(0, 1), outputs.covariance(1, 1),
                     outputs.covariance(0, 2), outputs.covariance(1, 2), outputs.covariance(2, 2)},
      .confidence = outputs.confidence,
      .environment = outputs.environment,
      .matches = converted(
          outputs.matches, [](const v1::Match& match) { return match; }, kMostMatches),
      .closed_doors = outputs.closed_doors};
}

}  // namespace saphira::registration
