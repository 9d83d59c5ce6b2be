#include "registration/shell/convert.hpp"

#include "lps/shell/convert.hpp"

namespace saphira::registration {
namespace {

constexpr std::size_t kMostMatches = 256;  // the bound of Registration.matches

v1::RegistrationState to_bus(State state) {
  switch (state) {
    case State::off:
      return v1::REGISTRATION_OFF;
    case State::unplaced:
      return v1::REGISTRATION_UNPLACED;
    case State::lost:
      return v1::REGISTRATION_LOST;
    case State::tracking:
      break;
  }
  return v1::REGISTRATION_TRACKING;
}

v1::Match to_bus(const Core::Matched& match) {
  v1::Match result;
  result.percept(match.percept);
  result.artifact(match.artifact);
  result.accepted(match.accepted);
  result.along(match.off.x());
  result.across(match.off.y());
  result.heading(match.turned);
  result.reason(match.reason);
  return result;
}

}  // namespace

v1::Registration to_bus(const Core::Outputs& outputs, const Pose& pose_in_odom) {
  v1::Registration sample;
  sample.state(to_bus(outputs.state));
  sample.reason(outputs.reason);
  sample.pose_in_map(lps::to_bus(outputs.pose_in_map));
  sample.odom_in_map(lps::to_bus(compose(outputs.pose_in_map, relative(pose_in_odom, Pose{}))));
  sample.covariance().xx(outputs.covariance(0, 0));
  sample.covariance().xy(outputs.covariance(0, 1));
  sample.covariance().yy(outputs.covariance(1, 1));
  sample.covariance().xth(outputs.covariance(0, 2));
  sample.covariance().yth(outputs.covariance(1, 2));
  sample.covariance().thth(outputs.covariance(2, 2));
  sample.confidence(outputs.confidence);
  sample.environment(outputs.environment);
  sample.closed_doors(outputs.closed_doors);
  for (const Core::Matched& match : outputs.matches) {
    if (sample.matches().size() == kMostMatches)
      break;
    sample.matches().push_back(to_bus(match));
  }
  return sample;
}

}  // namespace saphira::registration
