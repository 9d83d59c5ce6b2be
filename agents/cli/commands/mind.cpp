#include "mind.hpp"

#include <algorithm>

namespace saphira::cli {

namespace {

constexpr double kSilence = 1.0;  // [s]

template <class T>
std::optional<T> copy(const T* sample) {
  return sample == nullptr ? std::nullopt : std::optional<T>(*sample);
}

}  // namespace

Mind::Mind(bus::Node& node, bool recalled)
    : node_(node),
      processes_(node),
      description_reader_(node.reader(bus::topics::kRobotDescription)),
      robot_reader_(node.reader(bus::topics::kRobotState)),
      grant_reader_(node.reader(bus::topics::kGrant)),
      behavior_reader_(node.reader(bus::topics::kBehaviors)),
      intention_reader_(node.reader(bus::topics::kIntentions)),
      goal_reader_(node.reader(bus::topics::kGoals)),
      status_reader_(node.reader(bus::topics::kGoalStatus)),
      schema_reader_(node.reader(bus::topics::kBehaviorSchemas)),
      belief_reader_(node.reader(bus::topics::kBeliefs)),
      process_reader_(node.reader(bus::topics::kProcesses)) {
  if (recalled)
    recall();
}

void Mind::recall() {
  recall_ = std::make_unique<Recall>(Recall{
      node_.reader(bus::topics::kRecallRobot), node_.reader(bus::topics::kRecallGrant),
      node_.reader(bus::topics::kRecallBehaviors), node_.reader(bus::topics::kRecallIntentions)});
}

void Mind::poll() {
  processes_.poll();
  if (const auto description = description_reader_.take_newest())
    lockstep_ = description->lockstep();
  if (recall_) {
    robots_.take(recall_->robots);
    grants_.take(recall_->grants);
    behaviors_.take(recall_->behaviors);
    intentions_.take(recall_->intentions);
  }
  robots_.take(robot_reader_);
  grants_.take(grant_reader_);
  behaviors_.take(behavior_reader_);
  intentions_.take(intention_reader_);
  for (const auto& sample : goal_reader_.take())
    if (!sample.info.disposed)
      goals_[{sample.data.id().writer(), sample.data.id().number()}] = sample.data;
  for (const auto& sample : status_reader_.take()) {
    const Key key{sample.data.id().writer(), sample.data.id().number()};
    if (sample.info.disposed)
      statuses_.erase(key);
    else
      statuses_[key] = sample.data;
  }
  for (const auto& sample : process_reader_.take()) {
    if (sample.info.disposed)
      services_.erase(sample.data.instance());
    else
      services_[sample.data.instance()] = sample.data;
  }
  if (auto schemas = schema_reader_.take_newest())
    schemas_ = std::move(schemas);
  if (auto beliefs = belief_reader_.take_newest())
    beliefs_ = std::move(beliefs);
  if (!recall_ && !heard() && seconds_since(began_) > kSilence)
    recall();
}

void Mind::listen(std::chrono::milliseconds time, const bus::Stop& stop) {
  const auto end = Clock::now() + time;
  while (!stop.requested() && Clock::now() < end) {
    node_.wait(std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()), &stop);
    poll();
  }
}

const v1::BehaviorSchema* Mind::schema(const std::string& name) const {
  if (schemas_)
    for (const v1::BehaviorSchema& schema : schemas_->schemas())
      if (schema.name() == name)
        return &schema;
  return nullptr;
}

/// The grant that was told with the next packet is the one that the command of a cycle met; in
/// lockstep it is told when that command is in.
const v1::Grant* Mind::grant_for(std::uint64_t cycle) const {
  return grants_.at(lockstep_ ? cycle : cycle + 1);
}

bool Mind::whole(std::uint64_t cycle) const {
  const v1::Grant* const grant = grant_for(cycle);
  if (grant == nullptr || robots_.at(cycle) == nullptr || grants_.epoch() != robots_.epoch())
    return false;
  return behaviors_.at(cycle) != nullptr && behaviors_.epoch() == grants_.epoch() &&
         (cycle < 2 ||
          (intentions_.at(cycle - 1) != nullptr && intentions_.epoch() == grants_.epoch()));
}

std::uint64_t Mind::newest_cycle() const {
  const v1::Grant* const grant = grants_.newest();
  if (grant == nullptr)
    return behaviors_.newest() == nullptr ? 0 : behaviors_.newest()->stamp().cycle();
  const std::uint64_t newest = grant->stamp().cycle();
  for (std::uint64_t back = 0; back < 10 && back < newest; ++back)
    if (whole(newest - back))
      return newest - back;
  return lockstep_ || newest == 0 ? newest : newest - 1;
}

std::pair<std::uint64_t, std::uint64_t> Mind::known() const {
  if (behaviors_.newest() == nullptr)
    return {0, 0};
  return {behaviors_.oldest()->stamp().cycle(), behaviors_.newest()->stamp().cycle()};
}

bool Mind::knows_goals() const {
  if (!schemas_)
    return false;
  if (const v1::Intentions* const newest = intentions_.newest())
    for (const v1::IntentionNode& node : newest->nodes())
      if (const Key key{node.goal().writer(), node.goal().number()};
          node.parent() == 0 && !(statuses_.contains(key) && goals_.contains(key)))
        return false;
  return true;
}

/// Of the services that live.
std::string Mind::suspended() const {
  std::string text;
  for (const SeenProcess& program : processes_.all()) {
    const auto found = services_.find(program.status.instance());
    if (found == services_.end() || program.age > kLostAge)
      continue;
    for (const v1::Process& process : found->second.processes())
      if (process.state() == v1::PROCESS_SUSPENDED)
        text += (text.empty() ? "" : ", ") + process.name() + " of " + found->second.service();
  }
  return text;
}

Scene Mind::scene(std::uint64_t cycle) const {
  Scene scene;
  scene.cycle = cycle;
  scene.robot = copy(robots_.at(cycle));
  scene.grant = copy(grant_for(cycle));
  scene.behaviors = copy(behaviors_.at(cycle));
  if (cycle > 0)
    scene.intentions = copy(intentions_.at(cycle - 1));
  for (const auto& [key, goal] : goals_)
    scene.goals.push_back(goal);
  for (const auto& [key, status] : statuses_)
    scene.statuses.push_back(status);
  if (schemas_)
    scene.schemas = schemas_->schemas();
  if (!scene.grant || !scene.behaviors)
    scene.missing = missing_services(processes_.all());
  scene.suspended = suspended();
  return scene;
}

}  // namespace saphira::cli
