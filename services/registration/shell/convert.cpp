#include "registration/shell/convert.hpp"

#include <cmath>

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

v1::Match to_bus(const Match& match, const maps::Map& map) {
  v1::Match result;
  result.percept(match.percept);
  result.artifact(match.artifact);
  result.accepted(match.accepted);
  const double th = match.feature ? map.features[*match.feature].pose_in_map.th : 0.0;
  result.along(std::cos(th) * match.offset.x() + std::sin(th) * match.offset.y());
  result.across(-std::sin(th) * match.offset.x() + std::cos(th) * match.offset.y());
  result.heading(match.turned);
  result.reason(match.accepted ? "" : std::string(match.reason));
  return result;
}

}  // namespace

v1::Registration to_bus(const Output& output, const maps::Map& map, const Pose& pose_in_odom) {
  v1::Registration sample;
  sample.state(to_bus(output.state));
  sample.reason(std::string(output.reason));
  sample.pose_in_map(lps::to_bus(output.pose_in_map));
  sample.odom_in_map(lps::to_bus(compose(output.pose_in_map, relative(pose_in_odom, Pose{}))));
  sample.covariance().xx(output.covariance(0, 0));
  sample.covariance().xy(output.covariance(0, 1));
  sample.covariance().yy(output.covariance(1, 1));
  sample.covariance().xth(output.covariance(0, 2));
  sample.covariance().yth(output.covariance(1, 2));
  sample.covariance().thth(output.covariance(2, 2));
  sample.confidence(output.confidence);
  sample.environment(output.environment ? map.features[*output.environment].id : 0);
  for (const Match& match : output.matches) {
    if (sample.matches().size() == kMostMatches)
      break;
    sample.matches().push_back(to_bus(match, map));
  }
  return sample;
}

}  // namespace saphira::registration
