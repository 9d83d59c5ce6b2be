#include "saphira/registration/core.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "saphira/base/enumerators.hpp"
#include "saphira/base/format.hpp"
#include "saphira/maps/artifact_traits.hpp"
#include "saphira/maps/topology.hpp"
#include "saphira/registration/line_map.hpp"

namespace saphira::registration {
namespace {

constexpr double kOutside = 5.0;         // [m] allowed beyond the rectangle round the map
constexpr const char* kStart = "start";  // the POS at which a robot begins
constexpr const char* kBuilding = "the map is being built: switch that off first (features off)";

/// Throws where no robot can be registered on the map.
void check(const maps::Map& map) {
  if (const auto why = problem(LineMap(map)))
    throw std::invalid_argument(*why);
}

/// True for functors that need a map, which does not exist while it is being built.
bool needs_a_map(const std::string& functor) {
  return functor == "remove" || functor == "find" || functor == "switch";
}

/// The artifacts that may be put on a map, by their word there.
std::vector<std::string> artifact_words() {
  std::vector<std::string> words;
  for (const maps::ArtifactTraits& traits : maps::kArtifactTraits)
    if (!traits.word.empty())
      words.emplace_back(traits.word);
  return words;
}

std::vector<std::string> rule_words() {
  std::vector<std::string> words;
  for (const maps::ZoneRule rule : kEnumerators<maps::ZoneRule>)
    words.emplace_back(maps::word(rule));
  return words;
}

maps::Feature artifact_of(const Arguments& arguments) {
  maps::Feature artifact;
  for (const maps::ArtifactTraits& traits : maps::kArtifactTraits)
    if (traits.word == text_of(arguments, "type"))
      artifact.type = traits.type;
  artifact.id = static_cast<std::uint32_t>(number_of(arguments, "id"));
  artifact.pose_in_map = point_of(arguments, "position");
  artifact.length = number_of(arguments, "length");
  artifact.width = number_of(arguments, "width");
  artifact.name = text_of(arguments, "name");
  artifact.learned = truth_of(arguments, "learned");
  if (artifact.type == lps::PointType::zone) {
    const auto rule = maps::zone_rule(text_of(arguments, "rule"));
    if (!rule)
      throw std::invalid_argument("a zone needs a rule: keep-out, slow, one-way or preferred");
    artifact.rule = *rule;
    if (artifact.rule == maps::ZoneRule::slow)
      artifact.speed = number_of(arguments, "speed");
  }
  return artifact;
}

/// The map has corridors or rooms, and a place is far from all of them: no way leads there.
std::optional<std::string> in_no_region(const maps::Map& map, const Vec2& position) {
  constexpr double kNear = 1.0;  // [m] beside a room that is drawn too small
  double nearest = std::numeric_limits<double>::infinity();
  for (const maps::Feature& feature : map.features)
    if (maps::traits(feature.type).region)
      nearest = std::min(nearest, maps::Rectangle(feature).distance(position));
  if (nearest <= kNear || std::isinf(nearest))
    return std::nullopt;
  return format(
      "expected a place in a corridor, junction or room of the map, found one %.1f m from "
      "the nearest",
      nearest);
}

/// An artifact that may be put on a map. A zone without any part near it would matter nowhere, and
/// nobody goes to a place without a way.
maps::Feature on_the_map(maps::Feature artifact, const maps::Map& map) {
  const double reach = std::hypot(artifact.length, artifact.width) / 2;
  if (artifact.type == lps::PointType::zone)
    if (const auto why = maps::outside(map, artifact.pose_in_map.position(), kOutside + reach))
      throw std::invalid_argument("the zone is nowhere near the map: " + *why);
  if (artifact.type == lps::PointType::position)
    if (const auto why = in_no_region(map, artifact.pose_in_map.position()))
      throw std::invalid_argument(*why);
  return artifact;
}

registration::Settings settings_for(const std::vector<lps::SonarMount>& sonars) {
  registration::Settings settings;
  settings.sonars = sonars;
  return settings;
}

v1::Match matched(const Match& match, const maps::Map& map) {
  const double th = match.feature ? map.features[*match.feature].pose_in_map.th : 0.0;
  return {.percept = match.percept,
          .artifact = match.artifact,
          .accepted = match.accepted,
          .along = std::cos(th) * match.offset.x() + std::sin(th) * match.offset.y(),
          .across = -std::sin(th) * match.offset.x() + std::cos(th) * match.offset.y(),
          .heading = match.turned,
          .reason = match.accepted ? "" : match.reason};
}

}  // namespace

std::optional<Pose> start_pose(const std::string& start, const maps::Map& map) {
  if (start == "unknown")
    return std::nullopt;
  const auto places = maps::named(map, lps::PointType::position, start);
  if (!places.empty())
    return places.front()->pose_in_map;
  if (start == kStart)
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
    if (i == 2 && at == end && !maps::problem(Pose{values[0], values[1], values[2]})) {
      if (std::abs(values[2]) > 2.0 * kPi)
        throw std::invalid_argument("start \"" + start +
                                    "\": expected th between -2 pi and 2 pi; it is in radians; 90 "
                                    "degrees are 1.5708");
      if (const auto why = maps::outside(map, {values[0], values[1]}, kOutside))
        throw std::invalid_argument("start \"" + start + "\": " + *why + "; x and y are in metres");
      return Pose{values[0], values[1], norm2_angle(values[2])};
    }
  }
  throw std::invalid_argument("start \"" + start +
                              "\": expected x,y,th in metres and radians, the name of a POS of the "
                              "map, or unknown");
}

Core::Core(Settings settings, std::optional<Remembered> remembered) {
  check(settings.map);
  now_.option = settings.source;
  now_.source = std::move(settings.source);
  now_.start = settings.start;
  now_.snaps = settings.snap;
  now_.pose_in_map = settings.start.value_or(Pose{});
  now_.editor.replace(std::move(settings.map));
  // The start option has changed: the memory is of another place.
  if (remembered && remembered->option == now_.option)
    take_up(std::move(*remembered));
  now_.adds_features = settings.add_features.value_or(map().features.empty());
}

void Core::take_up(Remembered remembered) {
  check(remembered.map);
  if (const auto& filter = remembered.memory.filter)
    if (const auto why = maps::problem(filter->pose()))
      throw std::invalid_argument(*why);
  if (remembered.source != now_.source)
    now_.start.reset();
  now_.editor.replace(remembered.map);
  now_.source = remembered.source;
  now_.changed = remembered.changed;
  now_.remembered = std::move(remembered);
}

void Core::begin(const std::vector<lps::SonarMount>& sonars) {
  now_.sonars = sonars;
  const registration::Settings settings = settings_for(now_.sonars);
  std::optional<Memory> memory;
  std::set<std::uint32_t> closed;
  const bool first = !registration_;
  if (registration_) {
    memory = registration_->save();
    closed = registration_->closed_doors();
  } else if (now_.remembered) {
    memory = now_.remembered->memory;
    closed = now_.remembered->closed_doors;
  }
  now_.remembered.reset();
  // Later the robot may be anywhere.
  registration_.emplace(settings, now_.editor.map(), first ? now_.start : std::nullopt);
  if (memory && memory->filter)
    registration_->restore(*memory, first ? now_.start : std::nullopt);
  registration_->recall_closed(std::move(closed));
  if (!now_.builder)
    set_builder();
}

/// A Registration to be restored, or none.
void Core::make(bool begun) {
  registration_.reset();
  if (begun)
    registration_.emplace(settings_for(now_.sonars), maps::Map{});
}

/// Starts or ends additions to the map, according to adds_features.
void Core::set_builder() {
  if (now_.building)
    end_building();
  now_.builder.reset();
  if (!now_.adds_features || !registration_)
    return;
  MapBuilderSettings settings;
  settings.sonars = now_.sonars;
  settings.snap_to_right_angle_grid = now_.snaps;
  now_.building = LineMap(now_.editor.map()).empty();
  now_.built_from = now_.pose_in_map;
  now_.builder.emplace(settings, now_.editor.map(), now_.pose_in_map);
  now_.builder->take_ids(now_.editor);
}

/// From now on registration uses the map that was built. It gets the place where building began: a
/// robot that is started there again knows where it is.
void Core::end_building() {
  now_.building = false;
  if (!map().features.empty() && maps::named(map(), lps::PointType::position, kStart).empty()) {
    now_.editor.put({.type = lps::PointType::position,
                     .pose_in_map = now_.built_from,
                     .name = kStart,
                     .learned = true});
  }
  registration_->set_map(now_.editor.map());
  registration_->set_pose(now_.builder->pose_in_map());
  const std::vector<std::uint32_t> closed = now_.builder->closed();
  registration_->recall_closed({closed.begin(), closed.end()});
  // Registration was not stepped meanwhile: the robot has driven, but not since this pose.
  Memory here = registration_->save();
  here.odom = now_.odom;
  here.pose_in_odom = now_.pose_in_odom;
  here.confidence = 1.0;
  registration_->restore(here);
}

Core::Outputs Core::step(const Inputs& inputs) {
  std::vector<Answer> answers = between(inputs.requests);
  if (inputs.new_robot != nullptr)
    begin(*inputs.new_robot);
  now_.odom = inputs.odom;
  now_.pose_in_odom = inputs.pose_in_odom;
  Outputs outputs = now_.building ? built(inputs) : registered(inputs);
  now_.pose_in_map = outputs.pose_in_map;
  if (!environment_.works())
    outputs.environment = 0;
  outputs.answers = std::move(answers);
  if (now_.lease > 0 && --now_.lease == 0) {
    now_.adds_features = false;
    set_builder();
    outputs.notes.info("adds nothing to the map any more: nobody asks for it now");
  }
  return outputs;
}

/// The pose on a known map; new artifacts are placed from it.
Core::Outputs Core::registered(const Inputs& inputs) {
  registration_->switch_on(now_.on && match_.works());
  const Output output = registration_->step({inputs.cycle, inputs.odom, inputs.pose_in_odom,
                                             inputs.percepts, inputs.readings, now_.adds_features});
  Outputs outputs;
  outputs.state = output.state;
  outputs.reason = output.reason;
  if (output.state != now_.told)
    outputs.notes.info(std::string(word(output.state)) +
                       (outputs.reason.empty() ? "" : ": " + outputs.reason));
  now_.told = output.state;
  if (now_.on && !match_.works())
    outputs.reason = match_.name() + " is suspended: the pose goes on by dead reckoning";
  outputs.pose_in_map = output.pose_in_map;
  outputs.covariance = output.covariance;
  outputs.confidence = output.confidence;
  if (output.environment)
    outputs.environment = now_.editor.map().features[*output.environment].id;
  for (const Match& match : output.matches)
    outputs.matches.push_back(matched(match, now_.editor.map()));
  const std::set<std::uint32_t>& closed = registration_->closed_doors();
  outputs.closed_doors.assign(closed.begin(), closed.end());
  bool news = amend(output.presence, output.objects, outputs.notes);
  if (output.state == v1::REGISTRATION_TRACKING)
    news = grow(inputs, output.pose_in_map, outputs.notes) || news;
  if (news)
    registration_->set_map(now_.editor.map());
  return outputs;
}

/// The pose and the map together.
Core::Outputs Core::built(const Inputs& inputs) {
  Outputs outputs;
  grow(inputs, std::nullopt, outputs.notes);
  outputs.state = v1::REGISTRATION_TRACKING;
  outputs.reason = "builds the map";
  outputs.pose_in_map = now_.builder->pose_in_map();
  outputs.covariance = now_.builder->covariance();
  outputs.confidence = 1.0;  // pose and map are one: no other place is possible
  outputs.closed_doors = now_.builder->closed();
  return outputs;
}

/// Removes missing artifacts from the map and adds new ones; true where the map has changed.
bool Core::amend(const Presence::Changes& news, const std::vector<maps::Feature>& objects,
                 Notes& notes) {
  const auto say = [&](std::uint32_t id, const char* what) {
    if (const maps::Feature* const feature = maps::find(now_.editor.map(), id))
      notes.info(describe(*feature) + what);
  };
  for (const std::uint32_t id : news.closed)
    say(id, " is closed: something is heard where it opens");
  for (const std::uint32_t id : news.opened)
    say(id, " is open again");
  for (const std::uint32_t id : news.gone) {
    say(id, " is taken from the map: the sonars hear through it");
    if (now_.builder)
      now_.builder->remove(id);
    now_.editor.remove(id);
  }
  for (maps::Feature object : objects) {
    const bool is_new = object.id == 0;
    if (now_.builder)
      object.id = now_.builder->put(object);
    say(now_.editor.put(object),
        is_new ? " is put on the map: echoes from several places come from where it has nothing"
               : " is seen more clearly");
  }
  if (news.gone.empty() && objects.empty())
    return false;
  if (now_.builder)
    now_.editor.replace(now_.builder->map());
  now_.changed = true;
  return true;
}

/// True where the map has changed.
bool Core::grow(const Inputs& inputs, std::optional<Pose> pose_in_map, Notes& notes) {
  if (!now_.builder || !now_.builder->step({inputs.cycle, inputs.odom, inputs.pose_in_odom,
                                            inputs.percepts, inputs.readings, pose_in_map}))
    return false;
  if (const auto why = problem(LineMap(now_.builder->map()))) {
    if (!std::exchange(now_.too_large, true))
      notes.warn("no more features are added to the map: " + *why);
    return false;
  }
  now_.too_large = false;
  now_.editor.replace(now_.builder->map());
  now_.changed = true;
  return true;
}

const std::vector<Functor>& Core::functors() {
  constexpr double most_ids = 4294967295.0;
  constexpr double far = 1e5;  // [m]; the map has limits of its own
  static const std::vector<Functor> functors{
      {"load",
       "the map is this one",
       {text_parameter("text", "content of a map file (manual 6.9.1)"),
        text_parameter("name", "of the file, for people and errors")}},
      {"delete", "the map is empty"},
      {"put",
       "adds an artifact to the map, or changes the one of that id",
       {optional(whole_parameter("id", "0: it gets one", 0.0, most_ids)),
        text_parameter("type", "as a map file has it", artifact_words()),
        point_parameter("position", "its middle", Frame::map),
        optional(number_parameter("length", "along its heading [m]", 0.0, far)),
        optional(number_parameter("width", "across its heading [m]", 0.0, far)),
        optional(text_parameter("name", "of a room and of its doors")),
        optional(truth_parameter("learned", "the robot added it: removed when no longer seen")),
        optional(text_parameter("rule", "of a zone", rule_words())),
        optional(number_parameter("speed", "of a slow zone [m/s]", 0.0, 10.0))}},
      {"remove", "removes an artifact", {whole_parameter("id", "of the artifact", 1.0, most_ids)}},
      {"place", "the robot is there", {point_parameter("position", "of the robot", Frame::map)}},
      {"find", "the robot may be anywhere: finds it"},
      {"switch", "registration on or off (manual 6.9.2)", {truth_parameter("on", "on or off")}},
      {"add_features",
       "adds new features to the map, or not (add_new_features)",
       {truth_parameter("on", "on or off"),
        optional(number_parameter("lease",
                                  "ends it after that time [s], unless asked for again; 0: never",
                                  0.0, 3600.0))}},
      {"snap",
       "aligns new features with right angles, or not (snap_to_right_angle_grid)",
       {truth_parameter("on", "on or off")}}};
  return functors;
}

std::vector<Answer> Core::between(std::span<const Request> requests) {
  std::vector<Answer> answers;
  for (const Request& request : requests) {
    try {
      answers.push_back({AnswerCode::done, "", obey(request)});
    } catch (const std::exception& error) {
      answers.push_back({AnswerCode::refused, error.what(), {}});
    }
  }
  return answers;
}

Registration& Core::placed() {
  if (!registration_)
    throw std::runtime_error("there is no robot yet");
  return *registration_;
}

/// Carries out the request, or throws the message for the asker. Agents give goals and advice; the
/// map is an operator's, here as at the doors (docs/security.md).
Arguments Core::obey(const Request& request) {
  if (request.person && request.person->role == "agent")
    throw std::runtime_error("the map and the robot's place on it are for operators, not for " +
                             request.person->text());
  const std::string& what = request.functor;
  const Arguments& with = request.arguments;
  if (now_.building && needs_a_map(what))
    throw std::runtime_error(kBuilding);
  maps::Editor editor = now_.editor;
  if (what == "load" || what == "delete") {
    const std::string& name = text_of(with, "name");
    editor.replace(what == "load" ? maps::parse_map(text_of(with, "text"), name) : maps::Map{});
    use(std::move(editor));
    begin_anew(name);
  } else if (what == "put" && now_.building) {
    const std::uint32_t id = now_.builder->put(artifact_of(with));
    now_.editor.replace(now_.builder->map());
    now_.changed = true;
    return {number("id", id)};
  } else if (what == "put" || what == "remove") {
    auto id = static_cast<std::uint32_t>(number_of(with, "id"));
    if (what == "put")
      id = editor.put(on_the_map(artifact_of(with), map()));
    else if (!editor.remove(id))
      throw std::invalid_argument("no artifact (" + std::to_string(id) + ") in the map");
    use(std::move(editor));
    now_.changed = true;
    return {number("id", id)};
  } else if (what == "place") {
    const Pose pose = point_of(with, "position");
    if (const auto why = maps::problem(pose))
      throw std::invalid_argument(*why);
    if (const auto why = maps::outside(map(), pose.position(), kOutside))
      throw std::invalid_argument(*why);
    placed();
    if (now_.building) {  // what was built so far is kept, and building goes on from there
      now_.pose_in_map = pose;
      set_builder();
    }
    registration_->set_pose(pose);
  } else if (what == "find") {
    placed().forget_pose();
  } else if (what == "switch") {
    placed();
    now_.on = truth_of(with, "on");
  } else if (what == "snap" && now_.building) {  // what was built so far is kept
    now_.snaps = truth_of(with, "on");
    now_.builder->snap(now_.snaps);
  } else if (what == "snap") {
    placed();
    now_.snaps = truth_of(with, "on");
    set_builder();
  } else {
    placed();
    const bool on = truth_of(with, "on");
    const auto lease = static_cast<std::uint64_t>(std::lround(10.0 * number_of(with, "lease")));
    const bool prolongs = on && lease > 0 && now_.lease > 0;
    now_.lease = on ? lease : 0;
    if (prolongs)
      return {};  // what was built so far goes on
    now_.adds_features = on;
    set_builder();
  }
  return {};
}

/// A new map from another source than the builder, which begins anew with it. If it throws, nothing
/// has changed.
void Core::use(maps::Editor editor) {
  check(editor.map());
  if (registration_)
    registration_->set_map(editor.map());
  now_.editor = std::move(editor);
  now_.too_large = false;
  if (!registration_)
    return;
  now_.building = false;
  set_builder();
}

/// Discards the state that belongs to the old map.
void Core::begin_anew(const std::string& source) {
  now_.source = source;
  now_.changed = false;
  now_.start.reset();
  if (registration_) {
    registration_->recall_closed({});
    registration_->doubt_the_map();
  }
}

std::optional<Remembered> Core::remembered() const {
  if (!registration_)
    return std::nullopt;
  Remembered now{registration_->save(), now_.option,       now_.source,
                 now_.changed,          now_.editor.map(), registration_->closed_doors()};
  if (now_.building) {
    const std::vector<std::uint32_t> closed = now_.builder->closed();
    now.closed_doors = {closed.begin(), closed.end()};
    now.memory.filter.emplace(now_.pose_in_map, Eigen::Matrix3d::Zero(), 0.0, 0.0,
                              ReckoningErrors{});
    now.memory.odom = now_.odom;
    now.memory.pose_in_odom = now_.pose_in_odom;
  }
  return now;
}

}  // namespace saphira::registration
