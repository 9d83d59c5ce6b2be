#include "registration/shell/shell.hpp"

#include <charconv>
#include <stdexcept>
#include <utility>
#include <vector>

#include "lps/shell/convert.hpp"
#include "maps/shell/convert.hpp"
#include "registration/shell/convert.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/places.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::registration {
namespace {

constexpr std::chrono::seconds kSaveEvery{1};
constexpr double kOutside = 5.0;  // [m] beyond the rectangle round the map one may stand

/// Throws where no robot can be registered on the map.
void check(const maps::Map& map) {
  if (const auto why = problem(LineMap(map)))
    throw std::invalid_argument(*why);
}

constexpr const char* kBuilding = "the map is being built: switch that off first (features off)";

}  // namespace

std::string find_map(const std::string& name) {
  if (name.empty() || name == "none")
    return "";
  return find_file(config_folder() + "/maps", name, ".map");
}

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

Shell::Shell(bus::Node& node, const ShellOptions& options)
    : node_(node),
      options_(options),
      cycle_(node),
      perception_(cycle_.input(bus::topics::kPerception)),
      robot_(node),
      requests_(node.reader(bus::topics::kRegistrationRequest)),
      registrations_(node.writer(bus::topics::kRegistration)),
      maps_(node.writer(bus::topics::kMap)),
      answers_(node.writer(bus::topics::kRegistrationAnswer)),
      processes_(node, table_) {
  if (!options_.map_file.empty()) {
    editor_.replace(maps::load_map(options_.map_file));
    if (const auto why = problem(LineMap(editor_.map())))
      throw std::invalid_argument(options_.map_file + ": " + *why);
    source_ = options_.map_file;
  }
  start_ = start_pose(options_.start, editor_.map());
  pose_in_map_ = start_.value_or(Pose{});
  if (!options_.memory_file.empty())
    recall();
  adds_features_ = options.add_features.value_or(editor_.map().features.empty());
  snaps_ = options.snap;
  publish_map();
}

/// Takes up what the memory file holds, where that is of use.
void Shell::recall() {
  const std::string trouble =
      read_or_set_aside(options_.memory_file, [this](const std::string& content) {
        Remembered found = parse_remembered(content, options_.memory_file);
        check(found.map);
        remembered_ = std::move(found);
      });
  if (!trouble.empty())
    node_.warn(trouble);
  // Somebody wants another map than when it was written: the memory is of another place.
  if (remembered_ && remembered_->option != options_.map_file)
    remembered_.reset();
  if (!remembered_)
    return;
  if (remembered_->source != source_)
    start_.reset();
  editor_.replace(remembered_->map);
  source_ = remembered_->source;
  changed_ = remembered_->changed;
}

void Shell::begin() {
  Settings settings;
  settings.sonars = lps::mounts_from_bus(robot_.description());
  std::optional<Memory> memory;
  const bool first = !registration_;
  if (registration_)
    memory = registration_->save();
  else if (remembered_)
    memory = remembered_->memory;
  std::set<std::uint32_t> closed;
  if (registration_)
    closed = registration_->closed_doors();
  else if (remembered_)
    closed = remembered_->closed_doors;
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
void Shell::set_builder() {
  if (building_)
    end_building();
  builder_.reset();
  if (!adds_features_ || !registration_)
    return;
  MapBuilderSettings settings;
  settings.sonars = lps::mounts_from_bus(robot_.description());
  settings.snap_to_right_angle_grid = snaps_;
  building_ = LineMap(editor_.map()).empty();
  builder_.emplace(settings, editor_.map(), pose_in_map_);
  builder_->take_ids(editor_);
}

/// From now on the pose is registered on the map that was built.
void Shell::end_building() {
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

bool Shell::step(const bus::Stop& stop) {
  const auto step = cycle_.next(stop, [this] {
    take_requests();
    processes_.idle();
  });
  if (!step)
    return false;
  processes_.step(cycle_.stamp());
  using Knowledge = bus::KnownRobot::Knowledge;
  const Knowledge known = robot_.of(cycle_.stamp().epoch(), stop);
  if (known == Knowledge::fresh)
    begin();
  odom_ = step->robot.odom();
  pose_in_odom_ = lps::from_bus(step->robot.pose_in_odom());
  take_requests();
  v1::Registration sample;
  sample.state(v1::REGISTRATION_UNPLACED);
  sample.reason("waits for the robot");
  if (known != Knowledge::none) {
    std::vector<lps::Percept> percepts;
    const v1::Perception* const seen = perception_.value();
    if (seen != nullptr && seen->odom() == odom_)
      for (const v1::Percept& percept : seen->percepts())
        percepts.push_back(lps::from_bus(percept));
    sample = building_ ? built(*step, percepts) : registered(*step, percepts);
    pose_in_map_ = lps::from_bus(sample.pose_in_map());
  }
  if (!environment_.works())
    sample.environment(0);
  sample.stamp(cycle_.stamp());
  sample.odom(odom_);
  sample.map_revision(editor_.revision());
  sample.adds_features(adds_features_);
  sample.snaps(snaps_);
  registrations_.write(sample);
  publish_map();
  if (!options_.memory_file.empty() && Clock::now() - saved_ >= kSaveEvery)
    remember();
  cycle_.done();
  return true;
}

/// The pose on a map that is known; what is new is put down from there.
v1::Registration Shell::registered(const bus::Step& step,
                                   const std::vector<lps::Percept>& percepts) {
  const std::vector<lps::SonarReading> readings = lps::sonars_from_bus(step.robot);
  registration_->switch_on(on_ && match_.works());
  const Output output = registration_->step(
      {cycle_.stamp().cycle(), odom_, pose_in_odom_, percepts, readings, adds_features_});
  if (output.state != told_)
    node_.info(std::string(word(output.state)) +
               (output.reason.empty() ? "" : ": " + std::string(output.reason)));
  told_ = output.state;
  v1::Registration sample = to_bus(output, editor_.map(), pose_in_odom_);
  if (on_ && !match_.works())
    sample.reason(match_.name() + " is suspended: the pose goes on by dead reckoning");
  const std::set<std::uint32_t>& closed = registration_->closed_doors();
  sample.closed_doors().assign(closed.begin(), closed.end());
  bool news = amend(output.presence, output.objects);
  if (output.state == State::tracking)
    news = grow(percepts, readings, output.pose_in_map) || news;
  if (news)
    registration_->set_map(editor_.map());
  return sample;
}

/// What is gone is taken from the map, what is new is put onto it; true where it has become
/// another.
bool Shell::amend(const Presence::News& news, const std::vector<maps::Feature>& objects) {
  const auto say = [this](std::uint32_t id, const char* what) {
    if (const maps::Feature* const feature = maps::find(editor_.map(), id))
      node_.info(describe(*feature) + what);
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

/// The pose and the map together.
v1::Registration Shell::built(const bus::Step& step, const std::vector<lps::Percept>& percepts) {
  grow(percepts, lps::sonars_from_bus(step.robot), std::nullopt);
  Output output;
  output.state = State::tracking;
  output.reason = "builds the map";
  output.pose_in_map = builder_->pose_in_map();
  output.covariance = builder_->covariance();
  output.confidence = 1.0;  // pose and map are one: there is no other place to be
  v1::Registration sample = to_bus(output, editor_.map(), pose_in_odom_);
  sample.closed_doors(builder_->closed());
  return sample;
}

/// True where the map has become another.
bool Shell::grow(const std::vector<lps::Percept>& percepts,
                 const std::vector<lps::SonarReading>& readings, std::optional<Pose> pose_in_map) {
  if (!builder_ || !builder_->step({cycle_.stamp().cycle(), odom_, pose_in_odom_, percepts,
                                    readings, pose_in_map}))
    return false;
  if (const auto why = problem(LineMap(builder_->map()))) {
    if (!std::exchange(too_large_, true))
      node_.warn("what is seen is not added to the map any more: " + *why);
    return false;
  }
  too_large_ = false;
  editor_.replace(builder_->map());
  changed_ = true;
  return true;
}

void Shell::take_requests() {
  for (const auto& sample : requests_.take()) {
    const v1::RegistrationRequest& request = sample.data;
    v1::RegistrationAnswer answer;
    answer.stamp(cycle_.stamp());
    answer.request(request.request());
    try {
      answer.artifact(act(request));
      answer.done(true);
    } catch (const std::exception& error) {
      answer.reason(error.what());
      node_.warn("a request of " + request.source() + ": " + error.what());
    }
    answers_.write(answer);
  }
  publish_map();
}

std::uint32_t Shell::act(const v1::RegistrationRequest& request) {
  const auto placed = [&]() -> Registration& {
    if (!registration_)
      throw std::runtime_error("there is no robot yet");
    return *registration_;
  };
  switch (request.action()) {
    case v1::REGISTRATION_PUT:
    case v1::REGISTRATION_REMOVE:
    case v1::REGISTRATION_PLACE:
    case v1::REGISTRATION_FIND:
    case v1::REGISTRATION_SWITCH:
      if (building_)
        throw std::runtime_error(kBuilding);
      break;
    default:
      break;
  }
  switch (request.action()) {
    case v1::REGISTRATION_LOAD: {
      maps::Editor editor = editor_;
      editor.replace(maps::parse_map(request.text(), request.name()));
      use(std::move(editor));
      begin_anew(request.name());
      return 0;
    }
    case v1::REGISTRATION_DELETE: {
      maps::Editor editor = editor_;
      editor.replace({});
      use(std::move(editor));
      begin_anew("");
      return 0;
    }
    case v1::REGISTRATION_PUT: {
      maps::Editor editor = editor_;
      const std::uint32_t id = editor.put(maps::from_bus(request.artifact()));
      use(std::move(editor));
      changed_ = true;
      return id;
    }
    case v1::REGISTRATION_REMOVE: {
      maps::Editor editor = editor_;
      if (!editor.remove(request.artifact().id()))
        throw std::invalid_argument("no artifact (" + std::to_string(request.artifact().id()) +
                                    ") in the map");
      use(std::move(editor));
      changed_ = true;
      return request.artifact().id();
    }
    case v1::REGISTRATION_PLACE: {
      const Pose pose_in_map = lps::from_bus(request.pose_in_map());
      if (const auto why = maps::problem(pose_in_map))
        throw std::invalid_argument(*why);
      if (const auto why = maps::outside(editor_.map(), pose_in_map.position(), kOutside))
        throw std::invalid_argument(*why);
      placed().set_pose(pose_in_map);
      return 0;
    }
    case v1::REGISTRATION_FIND:
      placed().forget_pose();
      return 0;
    case v1::REGISTRATION_SWITCH:
      placed();
      on_ = request.on();
      return 0;
    case v1::REGISTRATION_ADD_FEATURES:
      placed();
      adds_features_ = request.on();
      set_builder();
      return 0;
    case v1::REGISTRATION_SNAP:
      placed();
      snaps_ = request.on();
      set_builder();
      return 0;
    default:
      break;
  }
  throw std::invalid_argument("nobody knows what action " +
                              std::to_string(static_cast<int>(request.action())) + " is");
}

/// The map from now on, by somebody else than the builder, which begins anew with it. Where it
/// throws, nothing has changed.
void Shell::use(maps::Editor editor) {
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
void Shell::begin_anew(const std::string& source) {
  source_ = source;
  changed_ = false;
  start_.reset();
  if (registration_)
    registration_->recall_closed({});
}

void Shell::publish_map() {
  if (published_revision_ == editor_.revision() + 1)
    return;
  published_revision_ = editor_.revision() + 1;
  v1::Map sample = maps::to_bus(editor_.map());
  sample.stamp(cycle_.stamp());
  sample.revision(editor_.revision());
  sample.source(source_);
  sample.changed(changed_);
  maps_.write(sample);
}

void Shell::remember() {
  saved_ = Clock::now();
  if (!registration_)
    return;
  using namespace std::chrono_literals;
  if (saving_.valid() && saving_.wait_for(0s) != std::future_status::ready)
    return;
  if (saving_.valid())
    tell_saved(saving_.get());
  Remembered now{registration_->save(),        options_.map_file, source_, changed_, editor_.map(),
                 registration_->closed_doors()};
  if (building_) {
    const std::vector<std::uint32_t> closed = builder_->closed();
    now.closed_doors = {closed.begin(), closed.end()};
    now.memory.placed = true;
    now.memory.odom = odom_;
    now.memory.pose_in_map = pose_in_map_;
    now.memory.pose_in_odom = pose_in_odom_;
  }
  try {
    // A disk may take longer than a cycle.
    saving_ = std::async(std::launch::async, [file = options_.memory_file, text = to_text(now)] {
      return replace_file(file, text, true);
    });
  } catch (const std::exception& error) {
    tell_saved(false);
  }
}

void Shell::tell_saved(bool good) {
  if (saves_ && !good)
    node_.warn(options_.memory_file +
               " cannot be written: a restart will not know where the robot is");
  saves_ = good;
}

}  // namespace saphira::registration
