#include "saphira/watch/mind.hpp"

#include <algorithm>

#include "saphira/base/identity.hpp"

namespace saphira::watch {

namespace {

constexpr double kSilence = 1.0;           // [s]
constexpr double kSoon = 0.5;              // [s] by then all latched samples have come
constexpr std::uint64_t kSaidLately = 20;  // cycles

template <class T>
std::optional<T> copy(const T* sample) {
  return sample == nullptr ? std::nullopt : std::optional<T>(*sample);
}

bool stalled(const v1::RobotState& robot) {
  return robot.left_stalled || robot.right_stalled;
}

}  // namespace

Mind::Mind(bus::Node& node, bool recalled) : node_(node), processes_(node) {
  if (recalled)
    recall();
}

bool Mind::recall() {
  if (recall_)
    return false;
  recall_ = std::make_unique<Recall>(Recall{
      node_.reader(bus::topics::kRecallRobot), node_.reader(bus::topics::kRecallGrant),
      node_.reader(bus::topics::kRecallBehaviors), node_.reader(bus::topics::kRecallIntentions),
      node_.reader(bus::topics::kRecallGoals)});
  return true;
}

void Mind::poll() {
  processes_.poll();
  description_.poll();
  if (recall_) {
    robots_.take(recall_->robots);
    grants_.take(recall_->grants);
    behaviors_.take(recall_->behaviors);
    intentions_.take(recall_->intentions);
    take_past_goals();
  }
  const std::uint64_t newest_before = robots_.known().newest;
  robots_.take(robot_reader_);
  if (robots_.known().newest != newest_before) {
    robot_came_ = Clock::now();
    pace_.note(robots_.newest()->stamp, seconds_since(began_));
  }
  grant_reader_.visit([&](const v1::Grant& grant, const bus::SampleInfo& info) {
    if (info.disposed)
      return;
    grants_.note(grant);
    grant_ = grant;
  });
  behaviors_.take(behavior_reader_);
  intentions_.take(intention_reader_);
  for (const auto& sample : goal_reader_.take())
    if (!sample.info.disposed && sample.data.withdrawn.empty())
      goals_[{sample.data.id.writer, sample.data.id.number}] = sample.data;
  keep_newest(status_reader_, statuses_, [](const v1::GoalStatus& status) {
    return Key{status.id.writer, status.id.number};
  });
  keep_newest(process_reader_, services_,
              [](const v1::ProcessSet& service) { return service.instance; });
  for (const auto& sample : program_reader_.take()) {
    if (sample.info.disposed)
      programs_.erase(sample.data.instance);
    else
      programs_[sample.data.instance].note(sample.data);
  }
  schemas_.poll();
  beliefs_.poll();
  const bool sure = registration_ && !situation::is_doubtful(*registration_);
  if (registration_.poll()) {
    if (!situation::is_doubtful(*registration_))
      doubtful_since_ = 0;
    else if (sure)
      doubtful_since_ = registration_->stamp.cycle;
  }
  if (!heard() && seconds_since(began_) > kSilence)
    recall();
}

std::size_t Mind::news() const {
  const auto heard = [](const auto& past) { return past.newest() != nullptr ? 1U : 0U; };
  return processes_.news() + robot_reader_.matched() + behavior_reader_.matched() +
         intention_reader_.matched() + heard(robots_) + heard(behaviors_) + heard(intentions_);
}

std::vector<const v1::ProgramMind*> Mind::programs() const {
  std::vector<const v1::ProgramMind*> result;
  for (const auto& [instance, past] : programs_)
    if (past.newest() != nullptr && past.epoch() == robots_.epoch() &&
        past.newest()->stamp.cycle + kSaidLately >= robots_.known().newest)
      result.push_back(past.newest());
  return result;
}

/// The mind of a program whose behaviors drove in that cycle; else nullptr.
const v1::ProgramMind* Mind::program(const std::string& source, std::uint64_t cycle) const {
  for (const auto& [instance, past] : programs_)
    if (past.epoch() == robots_.epoch() && past.newest() != nullptr &&
        is_named(source, past.newest()->source))
      if (const v1::ProgramMind* const then = past.at(cycle);
          then != nullptr && then->behaviors.control &&
          std::ranges::any_of(then->behaviors.behaviors,
                              [](const v1::BehaviorState& each) { return each.running; }))
        return then;
  return nullptr;
}

bool Mind::held() const {
  return (grant_ && grant_->estopped) ||
         (robots_.newest() != nullptr && stalled(*robots_.newest()));
}

void Mind::listen(std::chrono::milliseconds time, const bus::Stop& stop) {
  poll_for(node_, time, stop, [this] { poll(); });
}

const v1::BehaviorSchema* Mind::schema(const std::string& name) const {
  if (schemas_)
    for (const v1::BehaviorSchema& schema : schemas_->schemas)
      if (schema.name == name)
        return &schema;
  return nullptr;
}

void Mind::take_past_goals() {
  for (const auto& sample : recall_->goals.take())
    if (!sample.info.disposed)
      past_goals_[{sample.data.stamp.epoch, sample.data.stamp.cycle}] = sample.data;
}

/// From the newest report of intentions in that cycle.
std::vector<v1::GoalStatus> Mind::goals_at(std::uint64_t cycle) const {
  auto after = past_goals_.upper_bound({robots_.epoch(), cycle});
  if (after == past_goals_.begin() || std::prev(after)->first.first != robots_.epoch())
    return {};
  return std::prev(after)->second.goals;
}

/// A command's effect shows in the grant of the next packet; in lockstep in the grant after the
/// command.
const v1::Grant* Mind::grant_for(std::uint64_t cycle) const {
  return grants_.at(lockstep() ? cycle : cycle + 1);
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
    return behaviors_.newest() == nullptr ? 0 : behaviors_.newest()->stamp.cycle;
  const std::uint64_t newest = grant->stamp.cycle;
  for (std::uint64_t back = 0; back < 10 && back < newest; ++back)
    if (whole(newest - back))
      return newest - back;
  return lockstep() || newest == 0 ? newest : newest - 1;
}

std::pair<std::uint64_t, std::uint64_t> Mind::known() const {
  return {robots_.known().oldest, robots_.known().newest};
}

bool Mind::knows_goals() const {
  if (!schemas_)
    return false;
  if (const v1::Intentions* const newest = intentions_.newest())
    for (const v1::IntentionNode& node : newest->nodes)
      if (const Key key{node.goal.writer, node.goal.number};
          node.parent == 0 && !(statuses_.contains(key) && goals_.contains(key)))
        return false;
  // A missing status may only be late.
  return !statuses_.empty() || seconds_since(began_) > kSoon;
}

situation::Situation Mind::situation(std::uint64_t cycle, bool past) const {
  situation::Situation now;
  now.cycle = cycle;
  now.past = past;
  now.now = robots_.known().newest;
  now.silence = lockstep() ? 0.0 : silence();
  now.listened = seconds_since(began_);
  now.pace = pace_.get();
  now.robot = copy(robots_.at(cycle));
  now.grant = copy(grant_for(cycle));
  // Without a robot, or between two steps, the bridge tells of a change without a new cycle.
  if (!past && grant_ &&
      (!now.grant || grant_->stamp.epoch != robots_.epoch() ||
       (grant_->stamp == now.grant->stamp && grant_->estopped != now.grant->estopped)))
    now.grant = grant_;
  if (now.grant)
    now.estopped_since = grants_.since(now.grant->stamp.cycle,
                                       [](const v1::Grant& grant) { return grant.estopped; });
  now.stalled_since = robots_.since(cycle, stalled);
  now.behaviors_drove =
      grants_.newest([](const v1::Grant& grant) { return grant.role == v1::ROLE_BEHAVIORS; });
  // After a late command of this cycle, an earlier one holds: the reasons are from its cycle.
  std::uint64_t answered = cycle;
  const auto drives = [&](v1::Role role) { return now.grant && now.grant->role == role; };
  if ((drives(v1::ROLE_BEHAVIORS) || drives(v1::ROLE_DIRECT)) && now.grant->answers.cycle != 0)
    answered = now.grant->answers.cycle;
  if (behaviors_.epoch() == robots_.epoch())
    now.behaviors = copy(behaviors_.at(answered));
  if (answered > 0 && intentions_.epoch() == robots_.epoch())
    now.intentions = copy(intentions_.at(answered - 1));
  now.behaviors_known =
      behaviors_.epoch() == robots_.epoch() ? behaviors_.known() : situation::Known{};
  now.intentions_known =
      intentions_.epoch() == robots_.epoch() ? intentions_.known() : situation::Known{};
  if (const v1::ProgramMind* const own =
          drives(v1::ROLE_DIRECT) ? program(now.grant->source, answered) : nullptr) {
    now.behaviors = own->behaviors;
    now.intentions = own->intended;
    now.own_mind = true;
  }
  for (const auto& [key, goal] : goals_)
    now.goals.push_back(goal);
  now.statuses_known = now.intentions_known.newest != 0;
  if (past) {
    now.statuses = goals_at(cycle);
    // They are reported on change: a program that was there in that cycle without a report had
    // none.
    now.statuses_known = !now.statuses.empty() || now.intentions.has_value();
  } else {
    for (const auto& [key, status] : statuses_)
      now.statuses.push_back(status);
  }
  if (schemas_)
    now.schemas = schemas_->schemas;
  if (beliefs_ && !past)
    now.beliefs = beliefs_->beliefs;
  if (registration_ && !past && registration_->stamp.epoch == robots_.epoch() &&
      registration_->stamp.cycle + kSaidLately >= robots_.known().newest) {
    now.registration = *registration_;
    now.doubtful_since = doubtful_since_;
  }
  now.programs = processes_.all();
  now.found = processes_.found();
  now.processes = services();
  return now;
}

std::vector<v1::ProcessSet> Mind::services() const {
  std::vector<v1::ProcessSet> heard;
  for (const situation::Program& program : processes_.all())
    if (const auto found = services_.find(program.status.instance);
        found != services_.end() && program.age <= situation::kLostAge)
      heard.push_back(found->second);
  return heard;
}

}  // namespace saphira::watch
