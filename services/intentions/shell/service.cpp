#include "intentions/shell/service.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "intentions/shell/convert.hpp"
#include "lps/shell/convert.hpp"
#include "maps/shell/convert.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/base/cycle.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/audit.hpp"
#include "saphira/bus/sender.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/navigation.hpp"

namespace saphira::intentions {
namespace {

constexpr std::size_t kMostNodes = 1024;    // the bound of Intentions.nodes
constexpr double kReply = 3600.0;           // [s] for agents: an activity has a limit of its own
constexpr std::size_t kMostGoals = 1024;    // of GoalStatusSet.goals
constexpr std::size_t kMostBeliefs = 1024;  // of Beliefs.beliefs
constexpr std::uint64_t kSaveAgain = 10;    // steps

std::vector<std::string> folders(const Options& options) {
  std::vector<std::string> paths{activities_folder()};
  if (!options.folder.empty())
    paths.push_back(options.folder);
  return paths;
}

Core::Settings settings(const runtime::Ports& ports, const MemoryFile& memory,
                        std::shared_ptr<const Functions> functions,
                        const std::vector<std::string>& approval) {
  return {built_in(),       memory.memory(), memory.keeps(),
          ports.lockstep(), approval,        std::move(functions)};
}

/// Nodes and beliefs as on the bus.
auto dated(const Executor& executor) {
  return [&executor](const auto& each) {
    auto sample = to_bus(each);
    sample.since = executor.cycle_of(each.since);
    return sample;
  };
}

}  // namespace

Service::Service(runtime::Ports& ports, const Options& options)
    : ports_(ports),
      behaviors_(ports.cycle(bus::topics::kBehaviors)),
      registration_(options.registration ? &ports.cycle(bus::topics::kRegistration) : nullptr),
      perception_(options.interpretation ? &ports.cycle(bus::topics::kPerception) : nullptr),
      vision_(options.vision ? &ports.cycle(bus::topics::kVision) : nullptr),
      maps_(ports.events(bus::topics::kMap)),
      behavior_schemas_(ports.newest(bus::topics::kBehaviorSchemas)),
      claims_(ports.events(bus::topics::kBeliefClaims)),
      goals_(ports.events(bus::topics::kGoals)),
      grants_(ports.events(bus::topics::kGrant)),
      intentions_(ports.each_cycle(bus::topics::kIntentions)),
      recall_(ports.recall(bus::topics::kRecallIntentions)),
      goal_recall_(ports.recall(bus::topics::kRecallGoals)),
      statuses_(ports.changes(bus::topics::kGoalStatus)),
      schemas_(ports.changes(bus::topics::kActivitySchemas)),
      beliefs_(ports.changes(bus::topics::kBeliefs)),
      messages_(ports.changes(bus::topics::kMessages)),
      drawings_(ports.changes(bus::topics::kDrawings)),
      audit_(ports.changes(bus::topics::kAudit)),
      map_requests_(ports.asker(bus::topics::kRegistrationRequest)),
      servo_(ports.asker(bus::topics::kServo)),
      stops_(ports.asker(bus::topics::kDriveStop)),
      agents_(ports.client(bus::topics::kSolve)),
      memory_(options.memory_file, kMostEndings, ports.files()),
      functions_(all_functions()),
      folders_(folders(options), functions_, built_in()),
      settings_(settings(ports, memory_, functions_, options.approval)),
      core_(settings_) {
  settings_.memory = {};
  Notes notes;
  for (const std::string& trouble : memory_.troubles())
    notes.warn(trouble);
  ports_.say(notes.lines());
  if (!options.vision && !ports.lockstep())
    unasked_vision_.emplace(ports.newest(bus::topics::kVision));
  ports.gate([this](const v1::RobotState&) { return missing(); });
  check_files();
}

void Service::restore(std::string_view state) {
  settings_.registry = core_->executor().registry();
  renew(core_, state, settings_);
}

/// In lockstep every run has, from the first cycle on, the same schemas of behaviors, the same map
/// as registration, and a registration that takes requests.
std::string Service::missing() {
  if (!knows_behaviors_)
    take_behavior_schemas();
  if (!knows_behaviors_)
    return bus::topics::kBehaviorSchemas.name;
  // A request to an undiscovered registration would be lost.
  if (registration_ != nullptr && !map_requests_.is_taken())
    return std::string("registration, for ") + bus::topics::kRegistrationRequest.name;
  // The robot of the first step says that it has a head; nothing asks for it before the second.
  if (robot_turns_head_ && !servo_.is_taken())
    return std::string("bridge, for ") + bus::topics::kServo.name;
  take_maps();
  const v1::Registration* const registration =
      registration_ == nullptr ? nullptr : registration_->value();
  if (registration == nullptr || (map_revision_ && *map_revision_ >= registration->map_revision))
    return {};
  return std::string(bus::topics::kMap.name) + " of revision " +
         std::to_string(registration->map_revision);
}

void Service::say(const Notes& notes, const std::vector<v1::AuditEntry>& audit) {
  ports_.say(notes.lines());
  for (const v1::AuditEntry& entry : audit)
    audit_.write(bus::timed(entry));
}

void Service::step(const runtime::Turn& turn) {
  const Core::Outputs outputs = core_->step(inputs_of(turn));
  remember(outputs.intended.updates);
  if (const auto& by = outputs.intended.stop)
    stops_.ask({"stop", {{"by", *by}}}, std::exchange(next_stop_, bus::next_request_number()));
  publish(outputs);
  publish(outputs.intended.updates);
  if (outputs.beliefs)
    publish(*outputs.beliefs);
  if (outputs.way)
    draw_way(*outputs.way);
  if (outputs.look)
    servo_.ask({"look", {{"angle", *outputs.look}}});
  say(outputs.notes, outputs.audit);
}

void Service::between(double silence) {
  Core::Received received;
  take_goals(received);
  step_between(received, silence);
}

void Service::step_between(const Core::Received& received, double silence) {
  const Core::BetweenOutputs told = core_->between(received, silence);
  remember(told.updates);
  publish(told.updates);
  say(told.notes, told.audit);
}

Core::Inputs Service::inputs_of(const runtime::Turn& turn) {
  Core::Inputs inputs;
  inputs.stamp = turn.stamp;
  if (turn.new_robot) {
    robot_ = lps::settings_from_bus(turn.description);
    inputs.new_robot = &robot_;
  }
  inputs.robot_radius = turn.description.radius;
  inputs.deceleration = turn.description.deceleration;
  inputs.head_reach = turn.description.head_reach;
  robot_turns_head_ = inputs.head_reach > 0.0;
  inputs.new_frame = turn.new_frame;
  inputs.robot = from_bus(turn.robot);
  inputs.readings = lps::sonars_from_bus(turn.robot);
  const std::uint64_t cycle = turn.stamp.cycle;
  if (const v1::BehaviorSet* const behaviors = behaviors_.value()) {
    inputs.behaviors = from_bus(*behaviors);
    inputs.troubles = behaviors->missing;
    inputs.behaviors_cycle = behaviors->stamp.cycle;
    inputs.intent_age = intent_age_from_bus(*behaviors);
  }
  if (const v1::Registration* const registration =
          registration_ == nullptr ? nullptr : registration_->value()) {
    inputs.robot.odom_in_map = odom_in_map_from_bus(*registration, cycle, inputs.robot.odom);
    inputs.registered = registered_from_bus(*registration, cycle);
    inputs.map_revision = registration->map_revision;
  }
  if (const v1::Perception* const perception =
          perception_ == nullptr ? nullptr : perception_->value())
    inputs.percepts = percepts_from_bus(*perception, cycle, inputs.robot.odom);
  inputs.vision = vision();
  take_maps();
  inputs.maps = std::exchange(new_maps_, {});
  take_goals(inputs.received);
  take_claims(inputs.received);
  take_grants(inputs.received);
  agents_.poll(seconds_of(++steps_));
  inputs.received.answers = std::exchange(answers_, {});
  inputs.own_stop = {ports_.instance(), next_stop_};
  return inputs;
}

std::optional<Core::Vision> Service::vision() {
  if (unasked_vision_)
    if (auto sample = unasked_vision_->take_newest())
      newest_vision_ = std::move(sample);
  const v1::Vision* const sample = vision_ != nullptr ? vision_->value()
                                   : newest_vision_   ? &*newest_vision_
                                                      : nullptr;
  if (sample == nullptr)
    return std::nullopt;
  Core::Vision vision{sample->stamp, sample->odom, sample->sees_people || sample->sees_colors, {}};
  vision.things = converted(sample->things, [](const auto& thing) { return lps::from_bus(thing); });
  return vision;
}

void Service::take_maps() {
  for (const v1::FloorMap& map : maps_.take()) {
    map_revision_ = map.revision;
    new_maps_.push_back({map.revision, std::make_shared<const maps::Map>(maps::from_bus(map))});
  }
}

void Service::take_behavior_schemas() {
  const auto sample = behavior_schemas_.take_newest();
  if (!sample)
    return;
  knows_behaviors_ = true;
  if (sample->schemas.empty())
    return;  // no evaluator of behaviors has none
  Core::Received received;
  received.behaviors = from_bus(*sample);
  folders_.know_behaviors(*received.behaviors);
  step_between(received);
}

void Service::take_goals(Core::Received& received) {
  received.lost_requesters = goals_.take_lost();
  received.running =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  for (const auto& sample : goals_.take()) {
    Core::Received::Goal goal;
    goal.event.goal = from_bus(sample.data);
    goal.event.why = sample.data.withdrawn;
    goal.event.kind = sample.info.disposed || !goal.event.why.empty() ? GoalEvent::Kind::kDisposed
                                                                      : GoalEvent::Kind::kWritten;
    goal.person = bus::asker_of(sample.info, sample.data.person);
    goal.writer = sample.info.writer;
    goal.age = sample.info.age;
    received.goals.push_back(std::move(goal));
  }
}

void Service::take_claims(Core::Received& received) {
  received.lost_claimants = claims_.take_lost();
  Notes notes;
  for (auto& sample : claims_.take()) {
    sample.data.source = named(sample.data.source, bus::asker_of(sample.info));
    try {
      received.claims.push_back(
          {from_bus(sample.data,
                    sample.info.disposed ? ClaimEvent::Kind::kWithdrawn : ClaimEvent::Kind::kSaid),
           sample.info.writer, sample.data.writer_lost == v1::WRITER_LOST_CANCEL, sample.info.age});
    } catch (const FileError& error) {
      notes.warn("a claim of " + saphira::quoted(sample.data.source) + ": " + error.what());
    }
  }
  ports_.say(notes.lines());
}

void Service::take_grants(Core::Received& received) {
  for (const auto& sample : grants_.take())
    if (!sample.info.disposed)
      received.grants.push_back(from_bus(sample.data));
}

void Service::check_files() {
  if (knows_behaviors_ || !ports_.lockstep())
    take_behavior_schemas();
  ActivityFolders::Reload reload = folders_.reload();
  if (!reload.changed)
    return;
  Core::Received received;
  received.activities = std::move(reload);
  step_between(received);
  schemas_.write({.schemas = converted(core_->executor().registry().all(),
                                       [](const Schema* schema) { return to_bus(*schema); }),
                  .trouble = folders_.trouble()});
}

/// A disk that is full is tried again with the next change, and once a second.
void Service::remember(const GoalUpdates& updates) {
  unsaved_endings_.insert(unsaved_endings_.end(), updates.endings.begin(), updates.endings.end());
  if (unsaved_endings_.size() > kMostEndings)
    unsaved_endings_.erase(unsaved_endings_.begin(), unsaved_endings_.end() - kMostEndings);
  if (updates.work)
    unsaved_work_ = updates.work;
  if (!updates.endings.empty() || updates.work || steps_ % kSaveAgain == 0)
    save();
  if (!memory_trouble_.empty())
    ports_.degrade(memory_trouble_);
}

void Service::save() {
  std::string trouble;
  if (!unsaved_endings_.empty()) {
    if (memory_.append(unsaved_endings_))
      unsaved_endings_.clear();
    else
      trouble = cannot_be("the memory file", "written") +
                "; a restart may do a finished goal again, or repeat finished work";
  }
  // It names the newest ending.
  if (unsaved_work_ && unsaved_endings_.empty()) {
    if (memory_.keep(*unsaved_work_))
      unsaved_work_.reset();
    else
      trouble = cannot_be("the memory file", "written") + "; a restart may repeat finished work";
  }
  if (!trouble.empty() && memory_trouble_.empty()) {
    Notes notes;
    notes.warn(trouble);
    ports_.say(notes.lines());
  }
  memory_trouble_ = trouble;
}

void Service::publish(const GoalUpdates& updates) {
  Notes notes;
  for (const GoalStatus& status : updates.changed) {
    v1::GoalStatus sample = status;
    sample.stamp = ports_.stamp();
    if (!statuses_.write(sample))
      notes.warn("the status of goal " + describe(status.id) + " did not get onto the bus");
    told_[status.id] = sample;
  }
  for (const GoalId& id : updates.withdrawn) {
    statuses_.dispose({.id = id, .stamp = ports_.stamp()});
    told_.erase(id);
  }
  if (!updates.changed.empty() || !updates.withdrawn.empty()) {
    goal_recall_.write({.goals = converted(
                            told_, [](const auto& told) { return told.second; }, kMostGoals)});
  }
  ports_.say(notes.lines());
}

void Service::publish(const Core::Outputs& said) {
  const intentions::Outputs& outputs = said.intended;
  const SpeedLimit& limit = said.limit;
  for (const Request& request : outputs.requests)
    map_requests_.ask(request);
  for (const Request& question : outputs.questions) {
    v1::Request asked = to_bus(question);
    asked.stamp = ports_.stamp();
    const auto hear = [this, number = question.number](const v1::Answer& answer) {
      if (bus::ended(answer.code))
        answers_.emplace_back(number, saphira::from_bus(answer));
    };
    agents_.send(std::move(asked), hear, kReply, kReply);
  }
  v1::Intentions sample{.behavior_control = outputs.behavior_control,
                        .speed_limit = std::max(0.0, limit.speed),
                        .limit_reason = limit.reason,
                        .heeds = core_->executor().heeds()};
  sample.behaviors =
      converted(outputs.behaviors, [](const IntendedBehavior& each) { return to_bus(each); });
  sample.nodes = converted(outputs.nodes, dated(core_->executor()), kMostNodes);
  sample.edges = converted(said.edges, [](const Edge& edge) {
    return v1::Edge{.x1 = edge.from.x(), .y1 = edge.from.y(), .x2 = edge.to.x(), .y2 = edge.to.y()};
  });
  intentions_.write(sample);
  recall_.write(sample);
  for (const SpokenText& one : outputs.said) {
    messages_.write({.source = ports_.name() + ": " + one.schema, .text = one.text});
  }
}

void Service::draw_way(const std::vector<Vec2>& way) {
  v1::Drawing drawing{.instance = ports_.instance()};
  if (way.empty()) {
    drawings_.dispose(drawing);
    return;
  }
  drawing.source = ports_.name();
  drawing.frame = v1::FRAME_MAP;
  drawing.shape = v1::DRAWING_LINE;
  drawing.points =
      converted(way, [](const Vec2& at) { return v1::DrawnPoint{.x = at.x(), .y = at.y()}; });
  drawing.red = 70;
  drawing.green = 130;
  drawing.blue = 180;
  drawings_.write(std::move(drawing));
}

void Service::publish(const std::vector<Belief>& beliefs) {
  beliefs_.write({.beliefs = converted(beliefs, dated(core_->executor()), kMostBeliefs)});
}

namespace {

std::string in_a_folder(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  return std::filesystem::is_directory(folder)
             ? ""
             : path + ": expected a file in a folder that exists, and there is no " +
                   folder.string();
}

}  // namespace

runtime::Component component() {
  const auto options = std::make_shared<Options>();
  return {
      "intentions", "Takes goals from anybody on the bus and intends what they need",
      [options](CommandLine& app) {
        app.add_option("--memory", options->memory_file,
                       "file that remembers ended goals over a restart, so that none is done twice")
            .check(in_a_folder);
        app.add_flag("!--no-registration", options->registration,
                     "there is no registration service: do not wait for it in lockstep");
        app.add_flag("!--no-interpretation", options->interpretation, "the same of interpretation");
        app.add_flag("--vision", options->vision,
                     "there is a vision service: wait for it in lockstep");
        app.add_option("--activities", options->folder,
                       "folder of activity files; they cover shipped ones of the same name");
        app.add_option(
               "--approval", options->approval,
               "role, or beginning of an asker's name such as \"language model\": its goals "
               "wait until a person approves them (saphira goal approve)")
            .one_value_each();
      },
      [options](runtime::Ports& ports) { return std::make_unique<Service>(ports, *options); }};
}

}  // namespace saphira::intentions
