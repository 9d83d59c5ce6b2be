#include "intentions/shell/shell.hpp"

#include <algorithm>

#include "intentions/shell/convert.hpp"
#include "lps/shell/convert.hpp"
#include "maps/shell/convert.hpp"
#include "saphira/base/text.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/language.hpp"
#include "saphira/intentions/navigation.hpp"

namespace saphira::intentions {
namespace {

/// Without a cycle for this long there is no robot, live.
constexpr std::chrono::seconds kSilence{1};
/// [cycles] between looks at the activity files: a second.
constexpr std::uint64_t kLook = 10;
constexpr std::uint64_t kLookInLockstep = 100;  // there they are milliseconds
constexpr std::uint64_t kVisionLease = 10;      // [cycles] what was seen before is no news
constexpr std::chrono::milliseconds kMapWait{100};
constexpr std::size_t kMostNodes = 1024;    // the bound of Intentions.nodes
constexpr std::size_t kMostBeliefs = 1024;  // of Beliefs.beliefs

std::vector<std::string> folders(const ShellOptions& options) {
  std::vector<std::string> paths{activities_folder()};
  if (!options.folder.empty())
    paths.push_back(options.folder);
  return paths;
}

}  // namespace

Shell::Shell(bus::Node& node, const ShellOptions& options)
    : node_(node),
      cycle_(node),
      behaviors_(cycle_.input(bus::topics::kBehaviors)),
      registration_(options.registration ? &cycle_.input(bus::topics::kRegistration) : nullptr),
      perception_(options.interpretation ? &cycle_.input(bus::topics::kPerception) : nullptr),
      vision_(options.vision ? &cycle_.input(bus::topics::kVision) : nullptr),
      robot_(node),
      maps_(node.reader(bus::topics::kMap)),
      behavior_schemas_(node.reader(bus::topics::kBehaviorSchemas)),
      claims_(node.reader(bus::topics::kBeliefClaims)),
      goals_(node.reader(bus::topics::kGoals)),
      grants_(node.reader(bus::topics::kGrant)),
      intentions_(node.writer(bus::topics::kIntentions)),
      recall_(node.writer(bus::topics::kRecallIntentions)),
      statuses_(node.writer(bus::topics::kGoalStatus)),
      schemas_(node.writer(bus::topics::kActivitySchemas)),
      beliefs_(node.writer(bus::topics::kBeliefs)),
      messages_(node.writer(bus::topics::kMessages)),
      map_requests_(node.writer(bus::topics::kRegistrationRequest)),
      next_request_(node.instance()),
      memory_(options.memory_file),
      functions_(all_functions()),
      folders_(folders(options), functions_, built_in()),
      executor_(built_in(), memory_.memory(),
                {.remembers_work = memory_.keeps(), .functions = functions_}),
      processes_(node, table_,
                 [this](const std::string& name, ProcessAction action, std::uint32_t cycles) {
                   return ask_intention(name, action, cycles);
                 }) {
  for (const std::string& trouble : memory_.troubles())
    node_.warn(trouble);
  if (!options.vision && !node.options().lockstep)
    unasked_vision_.emplace(node.reader(bus::topics::kVision));
  look();
}

bool Shell::step(const bus::Stop& stop) {
  const auto step = cycle_.next(stop, [this] { idle(); });
  if (!step)
    return false;
  if (node_.options().lockstep)
    wait_for_schemas(stop);
  stamp_ = cycle_.stamp();
  stepped_ = Clock::now();
  robot_here_ = true;

  Inputs inputs;
  inputs.epoch = stamp_.epoch();
  inputs.cycle = stamp_.cycle();
  inputs.robot = from_bus(step->robot);
  if (const v1::Behaviors* const behaviors = behaviors_.value()) {
    inputs.behaviors = from_bus(*behaviors);
    inputs.troubles = troubles_from_bus(*behaviors);
    inputs.behaviors_cycle = behaviors->stamp().cycle();
    inputs.intent_age = intent_age_from_bus(*behaviors);
  }
  if (const v1::Registration* const registration =
          registration_ == nullptr ? nullptr : registration_->value()) {
    inputs.robot.odom_in_map =
        odom_in_map_from_bus(*registration, stamp_.cycle(), inputs.robot.odom);
    inputs.around.registration = registered_from_bus(*registration, stamp_.cycle());
  }
  look_around(step->robot, stop, inputs.around);
  inputs.events = take_events();
  inputs.claims = take_claims();
  take_estop();
  inputs.estop = estop_;
  processes_.step(stamp_);
  if (!execution_.works())
    inputs.hold = execution_.name() + " is suspended";
  const Outputs outputs = executor_.step(inputs);
  nodes_ = outputs.nodes;
  remember(outputs.news);

  v1::Intentions sample;
  sample.stamp(stamp_);
  sample.behavior_control(outputs.behavior_control);
  for (const IntendedBehavior& behavior : outputs.behaviors)
    sample.behaviors().push_back(to_bus(behavior));
  for (const IntentionNode& node : outputs.nodes)
    if (sample.nodes().size() < kMostNodes)
      sample.nodes().push_back(to_bus(node));
  intentions_.write(sample);
  recall_.write(sample);
  publish(outputs.news);
  publish(outputs.said);
  publish(outputs.map_requests);
  publish_beliefs();
  if (++steps_ % (node_.options().lockstep ? kLookInLockstep : kLook) == 0)
    look();
  cycle_.done();
  return true;
}

void Shell::idle() {
  processes_.idle();
  const News news = executor_.hear(take_events());
  remember(news);
  publish(news);
  // A simulator that is being single-stepped may stand still for as long as it likes.
  if (robot_here_ && !node_.options().lockstep && Clock::now() - stepped_ > kSilence) {
    robot_here_ = false;
    const News gone = executor_.robot_gone();
    remember(gone);
    publish(gone);
  }
}

std::optional<std::string> Shell::ask_intention(const std::string& name, ProcessAction action,
                                                std::uint32_t cycles) {
  const auto node = std::find_if(nodes_.begin(), nodes_.end(), [&](const IntentionNode& one) {
    return one.name == name || std::to_string(one.id) == name ||
           "I" + std::to_string(one.id) == name;
  });
  if (node == nodes_.end())
    return std::nullopt;
  if (cycles > 0)
    return "an intention is interrupted until it is resumed, not for some cycles";
  if (action == ProcessAction::resume)
    return executor_.resume(node->id) ? "" : name + " was not interrupted";
  return executor_.interrupt(node->id) ? "" : name + " is not an intention any more";
}

/// What is known beside the robot, from what came for the cycle before.
void Shell::look_around(const v1::RobotState& robot, const bus::Stop& stop, Surroundings& around) {
  using Knowledge = bus::KnownRobot::Knowledge;
  const Knowledge known = robot_.of(stamp_.epoch(), stop);
  if (known == Knowledge::fresh)
    lps_.emplace(lps::settings_from_bus(robot_.description()));
  if (odom_ && *odom_ != robot.odom() && lps_)
    lps_->reset();
  odom_ = robot.odom();
  if (known != Knowledge::none && lps_) {
    readings_ = lps::sonars_from_bus(robot);
    lps_->update(lps::from_bus(robot.pose_in_odom()), readings_, stamp_.cycle());
    around.readings = &readings_;
    around.lps = &*lps_;
  }
  const v1::Perception* const perception = perception_ == nullptr ? nullptr : perception_->value();
  percepts_ = perception == nullptr ? std::nullopt
                                    : percepts_from_bus(*perception, stamp_.cycle(), robot.odom());
  if (percepts_)
    around.percepts = &*percepts_;
  look_through_cameras(robot, around);
  const v1::Registration* const registration =
      registration_ == nullptr ? nullptr : registration_->value();
  take_map(registration == nullptr ? std::nullopt : std::optional(registration->map_revision()),
           stop);
  around.topology = topology_;
  around.map = map_;
  around.map_revision = places_revision_;
}

void Shell::look_through_cameras(const v1::RobotState& robot, Surroundings& around) {
  around.cycle = stamp_.cycle();
  if (unasked_vision_)
    if (auto sample = unasked_vision_->take_newest())
      newest_vision_ = std::move(sample);
  const v1::Vision* const vision = vision_ != nullptr ? vision_->value()
                                   : newest_vision_   ? &*newest_vision_
                                                      : nullptr;
  if (vision == nullptr || vision->stamp().epoch() != stamp_.epoch() ||
      vision->stamp().cycle() + kVisionLease < stamp_.cycle() ||
      !(vision->sees_people() || vision->sees_colors()))
    return;
  things_.clear();
  if (vision->odom() == robot.odom())
    for (const v1::SeenThing& thing : vision->things())
      things_.push_back(lps::from_bus(thing));
  around.things = &things_;
}

/// The map goes another way than what is cyclic. In lockstep it is the one that registration had in
/// the cycle before: one that has not come is waited for, one that is newer waits.
void Shell::take_map(std::optional<std::uint64_t> revision, const bus::Stop& stop) {
  const bool exact = node_.options().lockstep && revision;
  while (true) {
    for (auto& sample : maps_.take())
      if (!sample.info.disposed)
        newer_maps_.push_back(std::move(sample.data));
    while (!newer_maps_.empty() &&
           (!exact || newer_maps_.front().revision() <= *revision || topology_ == nullptr)) {
      const v1::Map& map = newer_maps_.front();
      auto fresh = std::make_shared<const maps::Map>(maps::from_bus(map));
      // A thing that was put there or carried off leaves what is planned as it is.
      if (topology_ == nullptr || !maps::same_places(*map_, *fresh)) {
        topology_ = std::make_shared<const maps::Topology>(*fresh);
        places_revision_ = map.revision();
      }
      map_ = std::move(fresh);
      map_revision_ = map.revision();
      newer_maps_.pop_front();
    }
    const bool here = topology_ != nullptr && (!exact || map_revision_ >= *revision);
    if (!exact || here || !newer_maps_.empty() || stop.requested())
      return;
    node_.wait(kMapWait, &stop);
  }
}

void Shell::take_schemas() {
  const auto schemas = behavior_schemas_.take_newest();
  if (!schemas)
    return;
  schemas_known_ = true;
  if (schemas->schemas().empty())
    return;  // nobody who evaluates behaviors has none
  folders_.know_behaviors(from_bus(*schemas));
  executor_.know_behaviors(from_bus(*schemas));
  for (const Diagnostic& trouble : check_references(executor_.registry()))
    node_.warn(trouble.text());
}

/// In lockstep it is known from the first cycle on in every run what can be intended.
void Shell::wait_for_schemas(const bus::Stop& stop) {
  while (!schemas_known_ && !stop.requested()) {
    take_schemas();
    if (!schemas_known_)
      node_.wait(kMapWait, &stop);
  }
}

void Shell::look() {
  if (schemas_known_ || !node_.options().lockstep)
    take_schemas();
  const ActivityFolders::News news = folders_.look();
  for (const std::string& error : news.errors)
    node_.error(error + (steps_ > 0 ? "\nWhat this file gave before stays in use." : ""));
  // At the start the behaviors are not known yet, and the shipped files are as everybody has them.
  if (steps_ > 0)
    for (const std::string& warning : news.warnings)
      node_.warn(warning);
  for (const std::string& name : news.removed)
    executor_.remove(name);
  for (const Schema& schema : news.taken) {
    executor_.add(schema);
    if (steps_ > 0)
      node_.info("took " + schema.name + " of " + schema.source);
  }
  if (!news.changed)
    return;
  v1::ActivitySchemas sample;
  sample.stamp(stamp_);
  for (const Schema* const schema : executor_.registry().all())
    sample.schemas().push_back(to_bus(*schema));
  sample.trouble(folders_.trouble());
  schemas_.write(sample);
}

std::vector<ClaimEvent> Shell::take_claims() {
  // First who is gone, then what has come: what they have written before is among it.
  const std::vector<bus::WriterId> gone = claims_.take_lost();
  std::vector<ClaimEvent> events;
  for (const auto& sample : claims_.take()) {
    const auto kind = sample.info.disposed ? ClaimEvent::Kind::kWithdrawn : ClaimEvent::Kind::kSaid;
    try {
      events.push_back(from_bus(sample.data, kind));
    } catch (const FileError& error) {
      node_.warn("a claim of " + quoted(sample.data.source()) + ": " + error.what());
      continue;
    }
    const GoalId id = events.back().id;
    if (kind == ClaimEvent::Kind::kSaid && sample.data.writer_lost() == v1::WRITER_LOST_CANCEL)
      claimants_[id] = sample.info.writer;
    else
      claimants_.erase(id);
  }
  for (const bus::WriterId& lost : gone) {
    for (auto claim = claimants_.begin(); claim != claimants_.end();) {
      if (claim->second != lost) {
        ++claim;
        continue;
      }
      ClaimEvent event;
      event.kind = ClaimEvent::Kind::kWithdrawn;
      event.id = claim->first;
      events.push_back(std::move(event));
      claim = claimants_.erase(claim);
    }
  }
  return events;
}

void Shell::publish(const std::vector<Said>& said) {
  for (const Said& one : said) {
    v1::Message message;
    message.stamp(stamp_);
    message.source(node_.options().name + ": " + one.schema);
    message.text(one.text);
    messages_.write(message);
    node_.info("says: " + one.text);
  }
}

void Shell::publish(const std::vector<MapRequest>& requests) {
  for (const MapRequest one : requests) {
    v1::RegistrationRequest request;
    request.source(node_.options().name);
    request.request(next_request_++);
    request.action(one == MapRequest::kForget ? v1::REGISTRATION_DELETE
                                              : v1::REGISTRATION_ADD_FEATURES);
    request.on(one == MapRequest::kAddFeatures);
    map_requests_.write(request);
  }
}

void Shell::publish_beliefs() {
  const std::uint64_t revision = executor_.beliefs().revision();
  if (revision == beliefs_revision_)
    return;
  beliefs_revision_ = revision;
  v1::Beliefs sample;
  sample.stamp(stamp_);
  for (const Belief& belief : executor_.beliefs().all())
    if (sample.beliefs().size() < kMostBeliefs)
      sample.beliefs().push_back(to_bus(belief));
  beliefs_.write(sample);
}

/// Of any grant since the last step: one that was pressed and reset meanwhile counts as well. The
/// grant says nothing else here, so it matters to nobody when it comes.
void Shell::take_estop() {
  bool pressed = false;
  for (const auto& sample : grants_.take()) {
    if (sample.info.disposed)
      continue;
    const v1::Grant& grant = sample.data;
    if (grant.estopped())
      estop_ = grant.estop_source().empty() ? "a program without a name" : grant.estop_source();
    else if (!pressed)
      estop_.clear();
    pressed = pressed || grant.estopped();
  }
}

std::vector<GoalEvent> Shell::take_events() {
  const std::vector<bus::WriterId> gone = goals_.take_lost();
  std::vector<GoalEvent> events;
  for (const auto& sample : goals_.take()) {
    GoalEvent event;
    event.goal = from_bus(sample.data);
    event.kind = sample.info.disposed ? GoalEvent::Kind::kDisposed : GoalEvent::Kind::kWritten;
    if (!sample.info.disposed)
      writers_[event.goal.id] = sample.info.writer;
    events.push_back(std::move(event));
  }
  for (const bus::WriterId& lost : gone) {
    for (const auto& [id, writer] : writers_) {
      if (writer != lost)
        continue;
      GoalEvent event;
      event.kind = GoalEvent::Kind::kWriterLost;
      event.goal.id = id;
      events.push_back(std::move(event));
    }
  }
  return events;
}

void Shell::remember(const News& news) {
  std::string lines;
  for (const Placement& placement : news.placed)
    lines += write_line(placement);
  for (const Ending& ending : news.endings)
    lines += write_line(ending);
  if (!lines.empty() && !memory_.append(lines))
    node_.warn("the memory file cannot be written: a restart may do a finished goal again");
  if (news.work && !memory_.keep(*news.work))
    node_.warn("the memory file cannot be written: a restart may do again what has been done");
}

void Shell::publish(const News& news) {
  for (const GoalStatus& status : news.changed) {
    if (!statuses_.write(to_bus(status, stamp_)))
      node_.warn("the status of goal " + describe(status.id) + " did not get onto the bus");
    const auto logged = logged_.find(status.id);
    if (logged != logged_.end() && logged->second == status.state)
      continue;
    logged_[status.id] = status.state;
    node_.info("goal " + describe(status.id) + ", " + quoted(status.functor) + " of " +
               quoted(status.requester) + ": " + name_of(status.state) +
               (status.reason.empty() ? "" : ": " + status.reason));
  }
  for (const GoalId& id : news.withdrawn) {
    GoalStatus status;
    status.id = id;
    statuses_.dispose(to_bus(status, stamp_));
    writers_.erase(id);
    logged_.erase(id);
  }
}

}  // namespace saphira::intentions
