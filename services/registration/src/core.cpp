#include "saphira/registration/core.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "saphira/maps/topology.hpp"
#include "saphira/registration/line_map.hpp"

namespace saphira::registration {
namespace {

constexpr double kOutside = 5.0;  // [m] beyond the rectangle round the map one may stand
constexpr const char* kBuilding = "the map is being built: switch that off first (features off)";

/// Throws where no robot can be registered on the map.
void check(const maps::Map& map) {
  if (const auto why = problem(LineMap(map)))
    throw std::invalid_argument(*why);
}

/// While the map is being built there is nothing yet to be registered on.
bool needs_a_map(Core::Request::Action action) {
  using Action = Core::Request::Action;
  return action == Action::kPut || action == Action::kRemove || action == Action::kPlace ||
         action == Action::kFind || action == Action::kSwitch;
}

Core::Matched matched(const Match& match, const maps::Map& map) {
  Core::Matched told{match.percept, match.artifact, match.accepted, "", {0.0, 0.0}, match.turned};
  if (!match.accepted)
    told.reason = match.reason;
  const double th = match.feature ? map.features[*match.feature].pose_in_map.th : 0.0;
  told.off = {std::cos(th) * match.offset.x() + std::sin(th) * match.offset.y(),
              -std::sin(th) * match.offset.x() + std::cos(th) * match.offset.y()};
  return told;
}

}  // namespace

std::optional<Pose> start_pose(const std::string& start, const maps::Map& map) {
  if (start == "unknown")
    return std::nullopt;
  const auto places = maps::named(map, lps::PointType::position, start);
  if (!places.empty())
    return places.front()->pose_in_map;
  if (start == "start")
    return std::nullopt;
  double values[3] = {0.0, 0.0, 0.0};
  const char* at = start.data();
  const char* const end = at + start.size();
  for (int i = 0; i < 3; ++i) {
    if (i > 0 && (at == end || *at++ != ','))
      break;
    const auto [next, error] = std::from_chars(at, end, values[i]);
    if (error != std::errc{})
      break;
    at = next;
    if (i == 2 && at == end && !maps::problem(Pose{values[0], values[1], values[2]}))
      return Pose{values[0], values[1], norm2_angle(values[2])};
  }
  throw std::invalid_argument("start \"" + start +
                              "\": expected x,y,th in metres and radians, the name of a POS of the "
                              "map, or unknown");
}

Core::Core(Settings settings, std::optional<Remembered> remembered)
    : option_(settings.source),
      source_(std::move(settings.source)),
      start_(settings.start),
      snaps_(settings.snap),
      pose_in_map_(settings.start.value_or(Pose{})) {
  check(settings.map);
  editor_.replace(std::move(settings.map));
  // Somebody wants another map than when it was written: the memory is of another place.
  if (remembered && remembered->option == option_)
    take_up(std::move(*remembered));
  adds_features_ = settings.add_features.value_or(editor_.map().features.empty());
}

void Core::take_up(Remembered remembered) {
  check(remembered.map);
  if (remembered.source != source_)
    start_.reset();
  editor_.replace(remembered.map);
  source_ = remembered.source;
  changed_ = remembered.changed;
  remembered_ = std::move(remembered);
}

void Core::begin(const std::vector<lps::SonarMount>& sonars) {
  sonars_ = sonars;
  registration::Settings settings;
  settings.sonars = sonars_;
  std::optional<Memory> memory;
  std::set<std::uint32_t> closed;
  const bool first = !registration_;
  if (registration_) {
    memory = registration_->save();
    closed = registration_->closed_doors();
  } else if (remembered_) {
    memory = remembered_->memory;
    closed = remembered_->closed_doors;
  }
  remembered_.reset();
  // Later it may be anywhere.
  registration_.emplace(settings, editor_.map(), first ? start_ : std::nullopt);
  if (memory && memory->placed)
    registration_->restore(*memory);
  registration_->recall_closed(std::move(closed));
  if (!builder_)
    set_builder();
}

/// Begins to add to the map as it is now, or ends that, as adds_features_ says.
void Core::set_builder() {
  if (building_)
    end_building();
  builder_.reset();
  if (!adds_features_ || !registration_)
    return;
  MapBuilderSettings settings;
  settings.sonars = sonars_;
  settings.snap_to_right_angle_grid = snaps_;
  building_ = LineMap(editor_.map()).empty();
  builder_.emplace(settings, editor_.map(), pose_in_map_);
  builder_->take_ids(editor_);
}

/// From now on the pose is registered on the map that was built.
void Core::end_building() {
  building_ = false;
  registration_->set_map(editor_.map());
  registration_->set_pose(builder_->pose_in_map());
  const std::vector<std::uint32_t> closed = builder_->closed();
  registration_->recall_closed({closed.begin(), closed.end()});
  // It has not been stepped meanwhile: the robot has driven, but not since this pose.
  Memory here = registration_->save();
  here.odom = odom_;
  here.pose_in_odom = pose_in_odom_;
  registration_->restore(here);
}

Core::Outputs Core::step(const Inputs& inputs) {
  if (inputs.new_robot != nullptr)
    begin(*inputs.new_robot);
  odom_ = inputs.odom;
  pose_in_odom_ = inputs.pose_in_odom;
  Outputs outputs = building_ ? built(inputs) : registered(inputs);
  pose_in_map_ = outputs.pose_in_map;
  if (!environment_.works())
    outputs.environment = 0;
  return outputs;
}

/// The pose on a map that is known; what is new is put down from there.
Core::Outputs Core::registered(const Inputs& inputs) {
  registration_->switch_on(on_ && match_.works());
  const Output output = registration_->step({inputs.cycle, inputs.odom, inputs.pose_in_odom,
                                             inputs.percepts, inputs.readings, adds_features_});
  Outputs outputs;
  outputs.state = output.state;
  outputs.reason = output.reason;
  if (output.state != told_)
    outputs.notes.info(std::string(word(output.state)) +
                       (outputs.reason.empty() ? "" : ": " + outputs.reason));
  told_ = output.state;
  if (on_ && !match_.works())
    outputs.reason = match_.name() + " is suspended: the pose goes on by dead reckoning";
  outputs.pose_in_map = output.pose_in_map;
  outputs.covariance = output.covariance;
  outputs.confidence = output.confidence;
  if (output.environment)
    outputs.environment = editor_.map().features[*output.environment].id;
  for (const Match& match : output.matches)
    outputs.matches.push_back(matched(match, editor_.map()));
  const std::set<std::uint32_t>& closed = registration_->closed_doors();
  outputs.closed_doors.assign(closed.begin(), closed.end());
  bool news = amend(output.presence, output.objects, outputs.notes);
  if (output.state == State::tracking)
    news = grow(inputs, output.pose_in_map, outputs.notes) || news;
  if (news)
    registration_->set_map(editor_.map());
  return outputs;
}

/// The pose and the map together.
Core::Outputs Core::built(const Inputs& inputs) {
  Outputs outputs;
  grow(inputs, std::nullopt, outputs.notes);
  outputs.state = State::tracking;
  outputs.reason = "builds the map";
  outputs.pose_in_map = builder_->pose_in_map();
  outputs.covariance = builder_->covariance();
  outputs.confidence = 1.0;  // pose and map are one: there is no other place to be
  outputs.closed_doors = builder_->closed();
  return outputs;
}

/// What is gone is taken from the map, what is new is put onto it; true where it has become
/// another.
bool Core::amend(const Presence::News& news, const std::vector<maps::Feature>& objects,
                 Notes& notes) {
  const auto say = [&](std::uint32_t id, const char* what) {
    if (const maps::Feature* const feature = maps::find(editor_.map(), id))
      notes.info(describe(*feature) + what);
  };
  for (const std::uint32_t id : news.closed)
    say(id, " is closed: something is heard where it opens");
  for (const std::uint32_t id : news.opened)
    say(id, " is open again");
  for (const std::uint32_t id : news.gone) {
    say(id, " is taken from the map: what is behind it is heard through it");
    if (builder_)
      builder_->remove(id);
    editor_.remove(id);
  }
  for (maps::Feature object : objects) {
    const bool is_new = object.id == 0;
    if (builder_)
      object.id = builder_->put(object);
    say(editor_.put(object),
        is_new ? " is put on the map: echoes from several places come from where it has nothing"
               : " is seen more clearly");
  }
  if (news.gone.empty() && objects.empty())
    return false;
  if (builder_)
    editor_.replace(builder_->map());
  changed_ = true;
  return true;
}

/// True where the map has become another.
bool Core::grow(const Inputs& inputs, std::optional<Pose> pose_in_map, Notes& notes) {
  if (!builder_ || !builder_->step({inputs.cycle, inputs.odom, inputs.pose_in_odom, inputs.percepts,
                                    inputs.readings, pose_in_map}))
    return false;
  if (const auto why = problem(LineMap(builder_->map()))) {
    if (!std::exchange(too_large_, true))
      notes.warn("what is seen is not added to the map any more: " + *why);
    return false;
  }
  too_large_ = false;
  editor_.replace(builder_->map());
  changed_ = true;
  return true;
}

Core::Answer Core::act(const Request& request) {
  try {
    return {"", obey(request)};
  } catch (const std::exception& error) {
    return {error.what(), 0};
  }
}

Registration& Core::placed() {
  if (!registration_)
    throw std::runtime_error("there is no robot yet");
  return *registration_;
}

/// Does it, or throws what is told to the one who asked.
std::uint32_t Core::obey(const Request& request) {
  using Action = Request::Action;
  if (building_ && needs_a_map(request.action))
    throw std::runtime_error(kBuilding);
  maps::Editor editor = editor_;
  switch (request.action) {
    case Action::kLoad:
      editor.replace(maps::parse_map(request.text, request.name));
      use(std::move(editor));
      begin_anew(request.name);
      return 0;
    case Action::kDelete:
      editor.replace({});
      use(std::move(editor));
      begin_anew("");
      return 0;
    case Action::kPut: {
      const std::uint32_t id = editor.put(request.artifact);
      use(std::move(editor));
      changed_ = true;
      return id;
    }
    case Action::kRemove:
      if (!editor.remove(request.artifact.id))
        throw std::invalid_argument("no artifact (" + std::to_string(request.artifact.id) +
                                    ") in the map");
      use(std::move(editor));
      changed_ = true;
      return request.artifact.id;
    case Action::kPlace:
      if (const auto why = maps::problem(request.pose_in_map))
        throw std::invalid_argument(*why);
      if (const auto why = maps::outside(map(), request.pose_in_map.position(), kOutside))
        throw std::invalid_argument(*why);
      placed().set_pose(request.pose_in_map);
      return 0;
    case Action::kFind:
      placed().forget_pose();
      return 0;
    case Action::kSwitch:
      placed();
      on_ = request.on;
      return 0;
    case Action::kAddFeatures:
      placed();
      adds_features_ = request.on;
      set_builder();
      return 0;
    case Action::kSnap:
      placed();
      snaps_ = request.on;
      set_builder();
      return 0;
  }
  throw std::invalid_argument("nobody knows what action " +
                              std::to_string(static_cast<int>(request.action)) + " is");
}

/// The map from now on, by somebody else than the builder, which begins anew with it. Where it
/// throws, nothing has changed.
void Core::use(maps::Editor editor) {
  check(editor.map());
  if (registration_)
    registration_->set_map(editor.map());
  editor_ = std::move(editor);
  too_large_ = false;
  if (!registration_)
    return;
  building_ = false;
  set_builder();
}

/// Nothing that was known of the map before holds on this one.
void Core::begin_anew(const std::string& source) {
  source_ = source;
  changed_ = false;
  start_.reset();
  if (registration_)
    registration_->recall_closed({});
}

std::optional<Remembered> Core::remembered() const {
  if (!registration_)
    return std::nullopt;
  Remembered now{registration_->save(),        option_, source_, changed_, editor_.map(),
                 registration_->closed_doors()};
  if (building_) {
    const std::vector<std::uint32_t> closed = builder_->closed();
    now.closed_doors = {closed.begin(), closed.end()};
    now.memory.placed = true;
    now.memory.odom = odom_;
    now.memory.pose_in_map = pose_in_map_;
    now.memory.pose_in_odom = pose_in_odom_;
  }
  return now;
}

}  // namespace saphira::registration
