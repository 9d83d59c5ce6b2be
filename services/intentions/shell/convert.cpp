#include "intentions/shell/convert.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lps/shell/convert.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/bus/sender.hpp"

namespace saphira {

template <>
constexpr EnumPairs<ArgumentKind, v1::ParameterKind, 3> kPairs<ArgumentKind, v1::ParameterKind>{
    {{
        {ArgumentKind::number, v1::PARAMETER_NUMBER},
        {ArgumentKind::text, v1::PARAMETER_TEXT},
        {ArgumentKind::point, v1::PARAMETER_POINT},
    }},
    {ArgumentKind::truth, ArgumentKind::unbound},
    {v1::PARAMETER_ANY}};
// The bus does not separate the first step after a suspension from the following ones; a removed
// intention does not appear there.
using State = intentions::IntentionState;
template <>
constexpr EnumPairs<State, v1::IntentionState, 8> kPairs<State, v1::IntentionState>{
    {{
        {State::kInit, v1::INTENTION_INIT},
        {State::kRunning, v1::INTENTION_RUNNING},
        {State::kResumed, v1::INTENTION_RUNNING},
        {State::kSuspended, v1::INTENTION_SUSPENDED},
        {State::kInterrupted, v1::INTENTION_INTERRUPTED},
        {State::kSuccess, v1::INTENTION_SUCCESS},
        {State::kFailure, v1::INTENTION_FAILURE},
        {State::kTimeout, v1::INTENTION_TIMEOUT},
    }},
    {State::kRemoved}};

namespace intentions {
namespace {

constexpr std::size_t kMostNodes = 1024;    // the bound of Intentions.nodes
constexpr std::size_t kMostBeliefs = 1024;  // of Beliefs.beliefs

v1::IntendedBehavior to_bus(const IntendedBehavior& behavior) {
  auto result = translated<v1::IntendedBehavior>(behavior);
  result.parameters = saphira::to_bus(behavior.parameters);
  return result;
}

v1::IntentionNode to_bus(const IntentionNode& node, const Executor& executor) {
  auto result = translated<v1::IntentionNode>(node);
  result.since = executor.cycle_of(node.since);
  return result;
}

}  // namespace

Goal from_bus(const v1::Goal& goal) {
  auto result = translated<Goal>(goal);
  result.arguments = saphira::from_bus(goal.arguments);
  return result;
}

Core::Received::Goal from_bus(const bus::Sample<v1::Goal>& sample) {
  Core::Received::Goal goal;
  goal.event.goal = from_bus(sample.data);
  // A withdrawal without a sample has the data that came last, whose writer may be another one.
  if (!sample.info.disposed)
    goal.event.why = sample.data.withdrawn;
  goal.event.kind = sample.info.disposed || !goal.event.why.empty() ? GoalEvent::Kind::kDisposed
                                                                    : GoalEvent::Kind::kWritten;
  goal.person = bus::asker_of(sample.info, sample.data.person);
  goal.writer = sample.info.writer;
  goal.age = sample.info.age;
  return goal;
}

v1::Intentions to_bus(const Core::Outputs& outputs, const Executor& executor) {
  const intentions::Outputs& intended = outputs.intended;
  v1::Intentions sample{.behavior_control = intended.behavior_control,
                        .speed_limit = std::max(0.0, outputs.limit.speed),
                        .limit_reason = outputs.limit.reason,
                        .heeds = executor.heeds()};
  sample.behaviors =
      converted(intended.behaviors, [](const IntendedBehavior& each) { return to_bus(each); });
  sample.nodes = converted(
      intended.nodes, [&](const IntentionNode& node) { return to_bus(node, executor); },
      kMostNodes);
  sample.edges = converted(outputs.edges, [](const Edge& edge) {
    return v1::Edge{.x1 = edge.from.x(), .y1 = edge.from.y(), .x2 = edge.to.x(), .y2 = edge.to.y()};
  });
  return sample;
}

v1::BeliefSet to_bus(const std::vector<Belief>& beliefs, const Executor& executor) {
  const auto one = [&](const Belief& belief) {
    return v1::Belief{.name = belief.name,
                      .value = to_text(belief.value),
                      .said_by = belief.said_by,
                      .since = executor.cycle_of(belief.since)};
  };
  return {.beliefs = converted(beliefs, one, kMostBeliefs)};
}

v1::Drawing drawing_of(const std::vector<Vec2>& way) {
  v1::Drawing drawing{.frame = v1::FRAME_MAP, .shape = v1::DRAWING_LINE};
  drawing.points =
      converted(way, [](const Vec2& at) { return v1::DrawnPoint{.x = at.x(), .y = at.y()}; });
  drawing.red = 70;
  drawing.green = 130;
  drawing.blue = 180;
  return drawing;
}

Core::Vision from_bus(const v1::Vision& vision) {
  return {vision.stamp, vision.odom, vision.sees_people || vision.sees_colors, vision.sees_colors,
          converted(vision.things, [](const auto& thing) { return lps::from_bus(thing); })};
}

Robot from_bus(const v1::RobotState& robot) {
  auto result = translated<Robot>(robot);
  result.connected = robot.status != v1::MOTORS_NOT_CONNECTED;
  result.has_power = robot.status != v1::MOTORS_NO_POWER;
  return result;
}

Core::Received::Grant from_bus(const v1::Grant& grant) {
  Core::Received::Grant result{grant.estopped, grant.estop_source};
  if (grant.role != v1::ROLE_BEHAVIORS)
    for (const v1::Refusal& refusal : grant.refused)
      if (refusal.role == v1::ROLE_BEHAVIORS && result.refusal.empty())
        result.refusal = refusal.reason;
  result.stop = grant.stop;
  result.stop_source = grant.stop_source;
  if (grant.role == v1::ROLE_TELEOP || grant.role == v1::ROLE_DIRECT)
    result.driver = grant.source;
  if (grant.role == v1::ROLE_TELEOP)
    result.person = grant.source.empty() ? "a person" : grant.source;
  result.waits_for_hand_back = grant.waits_for_hand_back;
  return result;
}

std::vector<BehaviorLevel> from_bus(const v1::BehaviorSet& behaviors) {
  return converted(behaviors.behaviors, [](const v1::BehaviorState& behavior) {
    return BehaviorLevel{behavior.name, behavior.goal, behavior.progress};
  });
}

std::uint64_t intent_age_from_bus(const v1::BehaviorSet& behaviors) {
  // A behaviors service without an age uses the intent of the cycle before.
  const double cycles = std::clamp(behaviors.input_age / kTick, 1.0, 1e6);
  return static_cast<std::uint64_t>(std::llround(std::isfinite(cycles) ? cycles : 1.0));
}

std::vector<BehaviorSignature> from_bus(const v1::BehaviorSchemas& schemas) {
  const auto parameter = [](const v1::BehaviorParameter& given) {
    auto result = translated<Parameter>(given);
    result.kind = saphira::from_bus(given.kind);
    result.usual.reset();
    return result;
  };
  return converted(schemas.schemas, [&](const v1::BehaviorSchema& schema) {
    return BehaviorSignature{schema.name, converted(schema.parameters, parameter)};
  });
}

v1::ActivitySchema to_bus(const Schema& schema) {
  v1::ActivitySchema result{
      .name = schema.name, .summary = schema.summary, .source = schema.source};
  for (const Parameter& parameter : schema.parameters) {
    auto out = translated<v1::ActivityParameter>(parameter);
    if (parameter.any)
      out.kind = v1::PARAMETER_ANY;
    if (parameter.usual)
      out.usual = plain(*parameter.usual);
    else if (parameter.usual_text)
      out.usual = *parameter.usual_text;
    result.parameters.push_back(std::move(out));
  }
  return result;
}

ClaimEvent from_bus(const v1::BeliefClaim& claim, ClaimEvent::Kind kind) {
  if (kind == ClaimEvent::Kind::kSaid && claim.name.empty())
    throw FileError("belief", 1, 1, "expected a name");
  ClaimEvent result;
  result.kind = kind;
  result.id = claim.id;
  result.source = claim.source;
  result.name = claim.name;
  if (kind == ClaimEvent::Kind::kSaid)
    result.value = parse_value(claim.value, "belief " + saphira::quoted(claim.name));
  return result;
}

Registered registered_from_bus(const v1::Registration& registration, std::uint64_t cycle) {
  if (registration.stamp.cycle + kRegistrationLease < cycle)
    return {};
  auto result = translated<Registered>(registration);
  result.closed_doors.insert(registration.closed_doors.begin(), registration.closed_doors.end());
  return result;
}

std::optional<Pose> odom_in_map_from_bus(const v1::Registration& registration, std::uint64_t cycle,
                                         std::uint64_t odom) {
  const bool known =
      registration.state == v1::REGISTRATION_TRACKING || registration.state == v1::REGISTRATION_OFF;
  if (!known || registration.odom != odom || registration.stamp.cycle + kRegistrationLease < cycle)
    return std::nullopt;
  return lps::from_bus(registration.odom_in_map);
}

std::optional<std::vector<lps::Percept>> percepts_from_bus(const v1::Perception& perception,
                                                           std::uint64_t cycle,
                                                           std::uint64_t odom) {
  if (perception.stamp.cycle + kRegistrationLease < cycle)
    return std::nullopt;
  if (perception.odom != odom)
    return std::vector<lps::Percept>();
  return converted(perception.percepts, [](const auto& each) { return lps::from_bus(each); });
}

}  // namespace intentions
}  // namespace saphira
