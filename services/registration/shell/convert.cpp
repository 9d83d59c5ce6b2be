#include "registration/shell/convert.hpp"

#include "lps/shell/convert.hpp"
#include "saphira/base/enum_pairs.hpp"

namespace saphira::registration {
namespace {

constexpr std::size_t kMostMatches = 256;  // the bound of Registration.matches

constexpr EnumPairs<State, v1::RegistrationState, 4> kStates{{{
    {State::tracking, v1::REGISTRATION_TRACKING},
    {State::off, v1::REGISTRATION_OFF},
    {State::unplaced, v1::REGISTRATION_UNPLACED},
    {State::lost, v1::REGISTRATION_LOST},
}}};

v1::Match to_bus(const Core::Matched& match) {
  v1::Match result;
  result.percept = match.percept;
  result.artifact = match.artifact;
  result.accepted = match.accepted;
  result.along = match.off.x();
  result.across = match.off.y();
  result.heading = match.turned;
  result.reason = match.reason;
  return result;
}

}  // namespace

v1::Registration to_bus(const Core::Outputs& outputs, const Pose& pose_in_odom) {
  v1::Registration sample;
  sample.state = kStates.theirs(outputs.state);
  sample.reason = outputs.reason;
  sample.pose_in_map = lps::to_bus(outputs.pose_in_map);
  sample.odom_in_map = lps::to_bus(compose(outputs.pose_in_map, relative(pose_in_odom, Pose{})));
  sample.covariance.xx = outputs.covariance(0, 0);
  sample.covariance.xy = outputs.covariance(0, 1);
  sample.covariance.yy = outputs.covariance(1, 1);
  sample.covariance.xth = outputs.covariance(0, 2);
  sample.covariance.yth = outputs.covariance(1, 2);
  sample.covariance.thth = outputs.covariance(2, 2);
  sample.confidence = outputs.confidence;
  sample.environment = outputs.environment;
  sample.closed_doors = outputs.closed_doors;
  sample.matches = converted(
      outputs.matches, [](const auto& match) { return to_bus(match); }, kMostMatches);
  return sample;
}

}  // namespace saphira::registration
