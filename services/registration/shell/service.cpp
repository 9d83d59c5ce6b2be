#include "registration/shell/service.hpp"

#include <stdexcept>
#include <utility>

#include "lps/shell/convert.hpp"
#include "maps/shell/convert.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/places.hpp"
#include "saphira/command_line/command_line.hpp"

namespace saphira::registration {
namespace {

constexpr std::size_t kMostMatches = 256;  // the bound of Registration.matches

/// The sample of a step at `pose_in_odom`; stamp, odom, revision and switches are the caller's.
v1::Registration to_bus(const Core::Outputs& outputs, const Pose& pose_in_odom) {
  return {
      .state = outputs.state,
      .reason = outputs.reason,
      .pose_in_map = lps::to_bus(outputs.pose_in_map),
      .odom_in_map = lps::to_bus(compose(outputs.pose_in_map, relative(pose_in_odom, Pose{}))),
      .covariance = {outputs.covariance(0, 0), outputs.covariance(0, 1), outputs.covariance(1, 1),
                     outputs.covariance(0, 2), outputs.covariance(1, 2), outputs.covariance(2, 2)},
      .confidence = outputs.confidence,
      .environment = outputs.environment,
      .matches = converted(
          outputs.matches, [](const v1::Match& match) { return match; }, kMostMatches),
      .closed_doors = outputs.closed_doors};
}

/// The path of the map `name`: a map file, or a shipped one; empty for "none" and for an empty
/// name. std::invalid_argument that lists the existing maps where it is neither.
std::string find_map(const std::string& name) {
  if (name.empty() || name == "none")
    return "";
  return find_file(config_folder() + "/maps", name, ".map");
}

Core::Settings settings_of(const Options& options) {
  Core::Settings settings;
  settings.source = find_map(options.map_file);
  if (!settings.source.empty())
    settings.map = maps::load_map(settings.source);
  settings.start = start_pose(options.start, settings.map);
  settings.add_features = options.add_features;
  settings.snap = options.snap;
  return settings;
}

}  // namespace

Service::Service(runtime::Ports& ports, const Options& options)
    : Service(ports, settings_of(options), options.memory_file) {}

Service::Service(runtime::Ports& ports, const Core::Settings& settings, std::string memory_file)
    : ports_(ports),
      memory_file_(std::move(memory_file)),
      perception_(ports.cycle(bus::topics::kPerception)),
      registrations_(ports.each_cycle(bus::topics::kRegistration)),
      maps_(ports.changes(bus::topics::kMap)),
      requests_(ports.requests(bus::topics::kRegistrationRequest, Core::functors())),
      settings_(settings),
      saver_(ports.files() == Files::kStay ? "" : memory_file_) {
  try {
    core_.emplace(settings);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(settings.source + ": " + error.what());
  }
  std::optional<Remembered> remembered;
  if (!memory_file_.empty()) {
    const std::string trouble = read_or_set_aside(
        memory_file_,
        [&](const std::string& content) {
          auto found = restored<Remembered>(unsealed(content, memory_file_));
          Core(settings, found);  // throws where it is unusable
          remembered = std::move(found);
        },
        ports.files());
    if (!trouble.empty())
      ports_.say({{Note::Level::warning, trouble}});
  }
  if (remembered)
    core_.emplace(settings, std::move(remembered));
  publish_map();
}

void Service::step(const runtime::Turn& turn) {
  Core::Inputs inputs;
  inputs.cycle = turn.stamp.cycle;
  std::vector<lps::SonarMount> sonars;
  if (turn.new_robot) {
    sonars = lps::mounts_from_bus(turn.description);
    inputs.new_robot = &sonars;
  }
  inputs.odom = turn.robot.odom;
  inputs.pose_in_odom = lps::from_bus(turn.robot.pose_in_odom);
  inputs.readings = lps::sonars_from_bus(turn.robot);
  const v1::Perception* const seen = perception_.value();
  if (seen != nullptr && seen->odom == inputs.odom)
    for (const v1::Percept& percept : seen->percepts)
      inputs.percepts.push_back(lps::from_bus(percept));
  const std::vector<Request> requests = requests_.take(turn.stamp);
  inputs.requests = requests;

  const Core::Outputs outputs = core_->step(inputs);
  requests_.answer(requests, outputs.answers);
  v1::Registration sample = to_bus(outputs, inputs.pose_in_odom);
  sample.odom = inputs.odom;
  sample.map_revision = core_->map_revision();
  sample.adds_features = core_->adds_features();
  sample.snaps = core_->snaps();
  registrations_.write(std::move(sample));
  publish_map();
  ports_.say(outputs.notes.lines());
  remember();
}

void Service::between(double /*silence*/) {
  const std::vector<Request> requests = requests_.take(ports_.stamp());
  requests_.answer(requests, core_->between(requests));
  publish_map();
}

void Service::publish_map() {
  if (published_ == core_->map_revision())
    return;
  published_ = core_->map_revision();
  v1::FloorMap sample = maps::to_bus(core_->map());
  sample.revision = core_->map_revision();
  sample.source = core_->map_source();
  sample.changed = core_->map_changed();
  maps_.write(std::move(sample));
}

void Service::remember() {
  const std::string trouble = saver_.offer([this] { return sealed(saved(*core_->remembered())); });
  constexpr const char* kMeans = ": a restart will not know where the robot is";
  if (!trouble.empty())
    ports_.say({{Note::Level::warning, trouble + kMeans}});
  if (!saver_.trouble().empty())
    ports_.degrade(saver_.trouble() + kMeans);
}

runtime::Component component() {
  const auto options = std::make_shared<Options>();
  return {"registration", "Keeps the robot's place on the map true",
          [options](CommandLine& app) {
            app.add_option("--map", options->map_file,
                           "map file, or the name of one that is shipped; none: an empty map");
            app.add_option("--start", options->start,
                           "where the robot is at first: x,y,th [m, rad], the name of a POS of the "
                           "map, or unknown");
            app.add_option("--map-memory", options->memory_file,
                           "file that keeps pose and map over a restart");
            app.add_option("--add-features", options->add_features,
                           "whether what is seen and not on the map is added to it; where it is "
                           "not said: only to an empty map");
            app.add_flag("!--no-snap", options->snap,
                         "do not align new features with right angles");
          },
          [options](runtime::Ports& ports) { return std::make_unique<Service>(ports, *options); }};
}

}  // namespace saphira::registration
