#include "saphira/registration/registration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saphira/base/archive.hpp"
#include "saphira/maps/artifact_traits.hpp"
#include "saphira/maps/topology.hpp"
#include "saphira/registration/state.hpp"

namespace saphira::registration {
namespace {

using lps::Percept;
using lps::PointType;

constexpr double kNear = 1.0;                // [m] another place within this and...
constexpr double kNearTurn = radians(20.0);  // ...this is a correction; farther off it was lost
constexpr std::size_t kTurns = 600;          // cycles
constexpr std::size_t kKeptReadings = 4000;  // used ones that are stored
constexpr double kUnconfirmed = 0.5;         // the highest confidence of a given pose
constexpr double kBesideTheMap = 1.0;        // [m] a pose farther outside is not on it
constexpr std::uint64_t kNoFrame = 0;        // no frame of a robot has this number

Eigen::Matrix3d covariance_of(const Sigmas& sigmas) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.diagonal() << sigmas.position * sigmas.position, sigmas.position * sigmas.position,
      sigmas.heading * sigmas.heading;
  return covariance;
}

}  // namespace

std::string_view word(v1::RegistrationState state) {
  switch (state) {
    case v1::REGISTRATION_OFF:
      return "off";
    case v1::REGISTRATION_UNPLACED:
      return "unplaced";
    case v1::REGISTRATION_TRACKING:
      return "tracking";
    case v1::REGISTRATION_LOST:
      return "lost";
  }
  return "";
}

class Registration::Self {
 public:
  Self(Settings settings, maps::Map map)
      : settings_(std::move(settings)),
        map_(std::move(map)),
        lines_(map_),
        field_(map_, lines_),
        model_(field_, settings_.range),
        now_(settings_),
        search_(map_, lines_, model_, settings_.search, settings_.match, settings_.reckoning,
                settings_.drift_error, now_.search) {
    for (std::size_t i = 0; i < map_.features.size(); ++i)
      if (maps::traits(map_.features[i].type).region)
        regions_.emplace_back(i, map_.features[i]);
  }
  Self(const Self&) = delete;
  Self& operator=(const Self&) = delete;

  const Output& step(const Inputs& inputs);
  const Output& output() const { return now_.output; }
  const maps::Map& map() const { return map_; }
  const Settings& settings() const { return settings_; }

  void place(const Pose& pose, const Eigen::Matrix3d& covariance, double drift,
             double drift_variance, double confidence);
  void doubt();
  void suspect_it_was_carried();
  bool holds_again() const;
  void doubt_the_map();
  void forget();
  void switch_on(bool on);
  const RegistrationState& state() const { return now_; }
  void set_state(RegistrationState state) { now_ = std::move(state); }
  void follow_edit(const maps::Map& old);
  Memory save() const;
  void restore(const Memory& memory, const std::optional<Pose>& start);
  const std::set<std::uint32_t>& closed_doors() const { return now_.presence.closed(); }
  void recall_closed(std::set<std::uint32_t> doors) {
    now_.sure_closed = std::move(doors);
    forget_looks();
  }

 private:
  void move(const Inputs& inputs);
  std::vector<PlacedReading> place(const std::vector<lps::SonarReading>& readings) const;
  std::vector<const Percept*> fresh(const Inputs& inputs);
  void correct(const std::vector<const Percept*>& percepts);
  void correct(const std::vector<PlacedReading>& readings);
  void look_around(const std::vector<PlacedReading>& readings);
  std::vector<PlacedReading> fresh_ones(const std::vector<PlacedReading>& readings);
  bool dense(const ParticleCloud::Estimate& cloud) const;
  void follow(const ParticleCloud::Estimate& cloud, double score);
  void look_elsewhere(const std::vector<PlacedReading>& readings,
                      const std::vector<const Percept*>& percepts);
  bool is_near(const Pose& pose) const;
  void forget_looks();
  void note_openings(int before);
  void look_for_news(const Inputs& inputs, const std::vector<PlacedReading>& readings);
  bool uses_old_readings(const Percept& percept) const;
  double turned_since(const Percept& percept) const;
  void find_environment();
  bool in_a_corridor() const;
  double explained_by_furniture() const;
  void report();

  Settings settings_;

  // Derived from the map and the settings.
  maps::Map map_;
  LineMap lines_;
  Field field_;
  RangeModel model_;
  std::vector<std::pair<std::size_t, maps::Rectangle>> regions_;  ///< by the artifact's index

  RegistrationState now_;
  Search search_;  // works on now_.search
};

/// Discards evidence that was gathered at a wrong pose, or with a wrong map: doors are closed or
/// open as they were when the pose was last sure.
void Registration::Self::forget_looks() {
  now_.presence.recall(now_.sure_closed);
  now_.objects = ObjectFinder(settings_.objects);
}

void Registration::Self::place(const Pose& pose, const Eigen::Matrix3d& covariance, double drift,
                               double drift_variance, double confidence) {
  if (is_near(pose))  // what was heard counts
    now_.sure_closed = now_.presence.closed();
  now_.filter.emplace(pose, covariance, drift, drift_variance, settings_.reckoning);
  search_.clear();
  search_.set_own_score(settings_.lost + confidence * (settings_.sure - settings_.lost));
  now_.state = v1::REGISTRATION_TRACKING;
  now_.confirmed = confidence > kUnconfirmed;
  now_.doubted = now_.carried = now_.other_map = false;
  now_.done.clear();
  now_.cloud.clear();
  now_.leads = false;
  now_.standing.forget();
  forget_looks();
}

bool Registration::Self::is_near(const Pose& pose) const {
  return now_.filter && (pose.position() - now_.filter->pose().position()).norm() < kNear &&
         std::abs(norm2_angle(pose.th - now_.filter->pose().th)) < kNearTurn;
}

/// The robot may have been carried: discard all earlier readings.
void Registration::Self::suspect_it_was_carried() {
  if (!now_.filter)
    return;
  search_.clear();
  now_.done.clear();
  now_.cloud.clear();
  now_.filter->widen(0.3, radians(10.0));
  now_.confirmed = false;
  now_.doubted = true;
  now_.carried = true;
  now_.state = v1::REGISTRATION_LOST;
}

/// No reading of this odometry frame has tested the pose yet.
void Registration::Self::doubt() {
  if (!now_.filter)
    return;
  now_.filter->widen(0.3, radians(10.0));
  now_.confirmed = false;
  const bool at_start = now_.start && is_near(*now_.start);
  if (at_start && now_.state == v1::REGISTRATION_TRACKING)
    return;
  now_.state = v1::REGISTRATION_LOST;
  now_.doubted = true;
  if (now_.start && !at_start)
    search_.suspect(PoseFilter(*now_.start, covariance_of({}), 0.0,
                               settings_.drift_error * settings_.drift_error, settings_.reckoning));
}

/// A pose that has fitted the old map may be wrong by any amount on this one.
void Registration::Self::doubt_the_map() {
  now_.start.reset();
  if (now_.filter &&
      maps::outside(map_, now_.filter->pose().position(), kBesideTheMap).has_value()) {
    forget();
  } else if (now_.filter && now_.state == v1::REGISTRATION_TRACKING) {
    const Pose pose = now_.filter->pose();
    place(pose, covariance_of({}), now_.filter->drift(), now_.filter->covariance()(3, 3),
          kUnconfirmed);
  }
  now_.other_map =
      now_.state == v1::REGISTRATION_TRACKING || now_.state == v1::REGISTRATION_UNPLACED;
  report();
}

void Registration::Self::forget() {
  now_.cloud.clear();
  now_.doubted = now_.carried = now_.other_map = false;
  now_.filter.reset();
  search_.clear();
  now_.state = v1::REGISTRATION_UNPLACED;
  now_.done.clear();
  forget_looks();
}

void Registration::Self::switch_on(bool on) {
  now_.on = on;
  if (!on)
    now_.cloud.clear();
}

/// Drops references to artifacts of the old version of the map from the state.
void Registration::Self::follow_edit(const maps::Map& old) {
  now_.output.matches.clear();
  now_.output.presence = {};
  now_.output.objects.clear();
  if (now_.output.environment) {
    const maps::Feature& before = old.features[*now_.output.environment];
    const auto same = std::find(map_.features.begin(), map_.features.end(), before);
    now_.output.environment.reset();
    if (same != map_.features.end())
      now_.output.environment = static_cast<std::size_t>(same - map_.features.begin());
  }
  find_environment();
  // Hypotheses from a map of another place are of no use here.
  const bool elsewhere =
      std::none_of(map_.features.begin(), map_.features.end(), [&](const maps::Feature& feature) {
        return std::find(old.features.begin(), old.features.end(), feature) != old.features.end();
      });
  if (elsewhere)
    now_.search.hypotheses.clear();
}

Memory Registration::Self::save() const {
  Memory memory;
  memory.odom = now_.doubted ? kNoFrame : now_.odom.value_or(kNoFrame);
  memory.pose_in_odom = now_.pose_in_odom;
  if (now_.state != v1::REGISTRATION_LOST || now_.doubted)
    memory.filter = now_.filter;
  memory.confidence = now_.output.confidence;
  memory.carried = now_.carried;
  return memory;
}

void Registration::Self::restore(const Memory& memory, const std::optional<Pose>& start) {
  now_.start = start;
  if (!memory.filter)
    return;
  place(memory.filter->pose(), memory.filter->pose_covariance(), 0.0, 0.0, memory.confidence);
  now_.filter = memory.filter;
  now_.carried = memory.carried;
  now_.odom = memory.odom;
  now_.pose_in_odom = memory.pose_in_odom;
  report();
}

void Registration::Self::move(const Inputs& inputs) {
  now_.moved = Pose{};
  if (now_.odom && *now_.odom == inputs.odom) {
    now_.moved = relative(now_.pose_in_odom, inputs.pose_in_odom);
  } else if (now_.odom) {
    // Dead reckoning begins anew: the robot has been switched off, and may have been moved.
    now_.done.clear();
    now_.used.clear();
    search_.clear();
    doubt();
    now_.cloud.clear();
  }
  now_.odom = inputs.odom;
  now_.pose_in_odom = inputs.pose_in_odom;
  now_.cycle = inputs.cycle;
  now_.turned += std::abs(now_.moved.th);
  now_.turns.emplace_back(now_.cycle, now_.turned);
  if (now_.turns.size() > kTurns)
    now_.turns.pop_front();
  if (now_.filter)
    now_.filter->move(now_.moved);
  now_.cloud.move(now_.moved);
}

std::vector<PlacedReading> Registration::Self::place(
    const std::vector<lps::SonarReading>& readings) const {
  std::vector<PlacedReading> placed;
  const Pose before = compose(now_.pose_in_odom, relative(now_.moved, Pose{}));
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto mount =
        std::find_if(settings_.sonars.begin(), settings_.sonars.end(),
                     [&](const lps::SonarMount& m) { return m.sonar == readings[i].sonar; });
    if (mount == settings_.sonars.end())
      continue;
    // They came one after the other while the robot moved.
    const double part = static_cast<double>(i + 1) / static_cast<double>(readings.size());
    const Pose at =
        compose(before, {now_.moved.x * part, now_.moved.y * part, now_.moved.th * part});
    placed.push_back(
        {compose(at, mount->in_robot), readings[i].range, readings[i].echo, readings[i].sonar});
  }
  return placed;
}

bool Registration::Self::uses_old_readings(const Percept& percept) const {
  if (percept.readings.empty())
    return false;
  const auto old = std::count_if(percept.readings.begin(), percept.readings.end(),
                                 [&](const lps::ReadingId& id) {
                                   return now_.used.count({id.cycle, id.sonar}) != 0;
                                 });
  return 2 * static_cast<std::size_t>(old) > percept.readings.size();
}

double Registration::Self::turned_since(const Percept& percept) const {
  // Half of its readings are newer.
  const std::uint64_t cycle =
      percept.readings.empty() ? percept.seen : percept.readings[percept.readings.size() / 2].cycle;
  const auto at = std::lower_bound(
      now_.turns.begin(), now_.turns.end(), cycle,
      [](const std::pair<std::uint64_t, double>& turn, std::uint64_t c) { return turn.first < c; });
  return at == now_.turns.end() ? 0.0 : now_.turned - at->second;
}

std::vector<const Percept*> Registration::Self::fresh(const Inputs& inputs) {
  std::vector<const Percept*> result;
  for (const Percept& percept : inputs.percepts) {
    if (percept.confidence < settings_.least_confidence ||
        percept.seen + settings_.fresh < inputs.cycle ||
        turned_since(percept) > settings_.most_turned)
      continue;
    const auto last = std::find_if(
        now_.done.begin(), now_.done.end(),
        [&](const RegistrationState::Done& done) { return done.percept == percept.id; });
    if (last != now_.done.end()) {
      const Pose since = relative(last->pose_in_odom, inputs.pose_in_odom);
      const bool point = percept.type == PointType::door || percept.type == PointType::junction ||
                         percept.type == PointType::breach;
      // An opening does not improve on the way; a wall is seen anew.
      if (point ? std::abs(last->width - percept.width) < 0.05
                : std::hypot(since.x, since.y) < settings_.again &&
                      std::abs(since.th) < settings_.again_turned)
        continue;
      now_.done.erase(last);
    }
    result.push_back(&percept);
  }
  std::stable_sort(result.begin(), result.end(), [](const Percept* a, const Percept* b) {
    return maps::traits(a->type).match_order < maps::traits(b->type).match_order;
  });
  return result;
}

void Registration::Self::correct(const std::vector<const Percept*>& percepts) {
  for (const Percept* percept : percepts) {
    now_.done.push_back(
        {percept->id, now_.cycle, now_.pose_in_odom, percept->width, percept->length});
    if (!now_.filter)
      continue;
    if (percept->type != PointType::door && percept->type != PointType::junction &&
        uses_old_readings(*percept)) {
      Match result;
      result.percept = percept->id;
      result.reason = "its readings have been used";
      now_.output.matches.push_back(result);
      continue;
    }
    const Pose before = now_.filter->pose();
    const Eigen::Matrix3d covariance_before = now_.filter->pose_covariance();
    const Match result =
        match(*percept, now_.pose_in_odom, map_, lines_, settings_.match, *now_.filter);
    // Walls combine readings by dead reckoning; the cloud has those readings already.
    if (result.accepted && !now_.cloud.empty() && !maps::traits(percept->type).straight)
      now_.cloud.learn(before, covariance_before, now_.filter->pose(),
                       now_.filter->pose_covariance());
    if (result.accepted)
      for (const lps::ReadingId& id : percept->readings)
        now_.used.insert({id.cycle, id.sonar});
    now_.output.matches.push_back(result);
  }
  while (now_.used.size() > kKeptReadings)
    now_.used.erase(now_.used.begin());
  if (now_.done.size() > 200)
    now_.done.erase(now_.done.begin(), now_.done.begin() + 100);
}

void Registration::Self::correct(const std::vector<PlacedReading>& readings) {
  now_.since_readings += std::hypot(now_.moved.x, now_.moved.y) + 0.3 * std::abs(now_.moved.th);
  if (now_.since_readings < settings_.search.spacing || !now_.filter || now_.leads)
    return;
  now_.since_readings = 0.0;
  for (const PlacedReading& reading : readings) {
    if (!reading.echo || reading.range > settings_.wall_range)
      continue;
    const Pose robot = now_.filter->pose();
    const Pose sensor = compose(robot, relative(now_.pose_in_odom, reading.sensor_in_odom));
    const Field::Nearest nearest = field_.nearest(sensor.position());
    if (nearest.towards.dot(sensor.direction()) < std::cos(settings_.range.facing))
      continue;
    const Vec2 arm = sensor.position() - robot.position();
    Eigen::Matrix<double, 1, 4> jacobian = Eigen::Matrix<double, 1, 4>::Zero();
    jacobian.leftCols<2>() = -nearest.towards.transpose();
    jacobian(0, 2) = -nearest.towards.dot(Vec2(-arm.y(), arm.x()));
    const double spread =
        std::sqrt((jacobian * now_.filter->covariance() * jacobian.transpose()).value());
    const Eigen::Matrix<double, 1, 1> innovation(reading.range - nearest.distance);
    if (std::abs(innovation.value()) > std::clamp(1.5 * spread, 0.15, 0.3))
      continue;
    now_.filter->correct<1>(
        innovation, jacobian,
        Eigen::Matrix<double, 1, 1>(settings_.wall_sigma * settings_.wall_sigma));
  }
}

void Registration::Self::look_around(const std::vector<PlacedReading>& readings) {
  if (!now_.filter)
    return;
  if (now_.cloud.empty()) {
    now_.cloud.begin(now_.filter->pose(), now_.filter->pose_covariance(), now_.filter->drift(),
                     std::max(settings_.cloud.drift, std::sqrt(now_.filter->covariance()(3, 3))));
    now_.lead = 0.0;
    now_.cloud_score = now_.search.own_score;
    return;
  }
  const double way = std::hypot(now_.moved.x, now_.moved.y);
  // Turning on the spot shows the same surroundings again: an object that is not on the map, such
  // as a closed door, would gain weight with each turn.
  now_.way += way;
  const double fading = std::exp(-way / settings_.lead_memory);
  now_.lead *= fading;
  now_.cloud_score *= fading;
  const std::vector<PlacedReading> fresh = fresh_ones(readings);
  if (!fresh.empty()) {
    const Pose middle = now_.cloud.middle();
    for (const PlacedReading& reading : fresh) {
      const Pose in_robot = relative(now_.pose_in_odom, reading.sensor_in_odom);
      const auto worth = [&](const Vec2& sensor_in_map, const Vec2& ahead) {
        return search_.worth(sensor_in_map, ahead, reading.range, reading.echo);
      };
      now_.cloud.weigh(in_robot, worth);
      const auto worth_at = [&](const Pose& robot) {
        const Pose sensor = compose(robot, in_robot);
        return worth(sensor.position(), sensor.direction());
      };
      const double here = worth_at(middle);
      const double own = worth_at(now_.filter->pose());
      now_.cloud_score += here;
      now_.lead += here - own;
      // Silence where no surface faces the sonar says nothing.
      if (reading.echo || own < 0.0)
        search_.test_own(in_robot.th, own);
    }
    now_.cloud.select();
  }
  if (!now_.leads && std::abs(now_.lead) <= settings_.lead)
    return;  // neither is better
  const ParticleCloud::Estimate there = now_.cloud.estimate();
  if (now_.leads) {
    now_.filter.emplace(there.pose, there.covariance, there.drift, there.drift_variance,
                        settings_.reckoning);
    now_.lead = 0.0;
    now_.led += way;
    if (now_.led > now_.trial)
      now_.leads = false;
    return;
  }
  const double apart = (there.pose.position() - now_.filter->pose().position()).norm();
  const double turned = std::abs(norm2_angle(there.pose.th - now_.filter->pose().th));
  if (apart < settings_.lead_apart && turned < settings_.lead_turned)
    return;
  if (now_.lead < -settings_.lead)
    now_.cloud.clear();  // and begins anew from the filter
  // If the filter has fitted better in total, the map lacks an object here.
  else if (now_.lead > settings_.lead && now_.cloud_score > now_.search.own_score && dense(there))
    follow(there, now_.cloud_score);
}

bool Registration::Self::dense(const ParticleCloud::Estimate& cloud) const {
  return cloud.covariance(0, 0) + cloud.covariance(1, 1) < settings_.dense * settings_.dense &&
         cloud.covariance(2, 2) < settings_.dense_turned * settings_.dense_turned;
}

/// Dead reckoning is worse than the filter may assume: for some way the cloud leads.
void Registration::Self::follow(const ParticleCloud::Estimate& cloud, double score) {
  if (!is_near(cloud.pose)) {
    now_.state =
        v1::REGISTRATION_LOST;  // reported, so that users of the pose learn that it did not hold
    forget_looks();
  }
  now_.filter.emplace(cloud.pose, cloud.covariance, cloud.drift, cloud.drift_variance,
                      settings_.reckoning);
  search_.set_own_score(score);
  // The evidence of openings stays: walls are alike in other corridors.
  now_.search.against = now_.search.strange = 0.0;
  now_.done.clear();
  now_.leads = true;
  now_.led = 0.0;
  now_.trial *= 2.0;
  now_.lead = 0.0;
}

/// The readings that do not repeat a recent one of their sonar.
std::vector<PlacedReading> Registration::Self::fresh_ones(
    const std::vector<PlacedReading>& readings) {
  std::vector<PlacedReading> result;
  for (const PlacedReading& reading : readings) {
    const auto last = now_.weighed.find(reading.sonar);
    if (last != now_.weighed.end() && now_.way < last->second + settings_.search.spacing)
      continue;
    now_.weighed[reading.sonar] = now_.way;
    result.push_back(reading);
  }
  return result;
}

void Registration::Self::look_elsewhere(const std::vector<PlacedReading>& readings,
                                        const std::vector<const Percept*>& percepts) {
  search_.step(now_.pose_in_odom, readings, percepts, now_.filter ? &*now_.filter : nullptr);
  if (now_.doubted)
    if (const Search::Hypothesis* const told = search_.told_leads()) {
      const PoseFilter found = told->filter;
      place(found.pose(), found.pose_covariance(), found.drift(), found.covariance()(3, 3), 1.0);
      return;
    }
  const auto best = search_.best(now_.state == v1::REGISTRATION_TRACKING);
  if (!best)
    return;
  const Pose there = best->hypothesis->filter.pose();
  if (now_.state == v1::REGISTRATION_TRACKING && !is_near(there)) {
    // Reported before the correction, so that users of the pose learn that it did not hold.
    if (best->likely)
      now_.state = v1::REGISTRATION_LOST;
    return;
  }
  if (!best->sure || (search_.is_own(there) && search_.contradiction() >= settings_.doubts))
    return;
  const PoseFilter found = best->hypothesis->filter;
  const double drift_variance = found.covariance()(3, 3);
  place(found.pose(), found.pose_covariance(), found.drift(), drift_variance, 1.0);
  // As the best of many, its own matches have made it too certain.
  now_.filter->widen(0.1, radians(3.0));
}

/// Missing artifacts of the map, and objects where the map has none.
void Registration::Self::look_for_news(const Inputs& inputs,
                                       const std::vector<PlacedReading>& readings) {
  if (now_.state != v1::REGISTRATION_TRACKING || now_.search.own_score < settings_.sure ||
      now_.filter->sigma_position() > settings_.sure_position)
    return;
  std::vector<Look> looks;
  for (const PlacedReading& reading : readings)
    looks.push_back(
        {compose(now_.filter->pose(), relative(now_.pose_in_odom, reading.sensor_in_odom)),
         reading.range, reading.echo});
  std::vector<std::uint32_t> open;
  for (const Match& match : now_.output.matches)
    if (match.accepted &&
        std::any_of(inputs.percepts.begin(), inputs.percepts.end(), [&](const Percept& percept) {
          return percept.id == match.percept && percept.type == PointType::door &&
                 !percept.is_closed();
        }))
      open.push_back(match.artifact);
  now_.output.presence =
      now_.presence.step(map_, now_.cycle, now_.filter->pose().position(), looks, open);
  search_.found_closed(now_.output.presence.closed.size());
  if (inputs.find_objects)
    now_.output.objects = now_.objects.step(map_, field_, now_.cycle, looks);
}

/// Other corridors have the same walls, and now and then an opening at the same place. As many as
/// the search needs for a place, one after the other, make the evidence of closed doors count.
void Registration::Self::note_openings(int before) {
  if (now_.search.openings > 0.0)
    now_.agreed = 0;
  else if (now_.search.own_openings > before && ++now_.agreed >= settings_.search.matches)
    now_.sure_closed = now_.presence.closed();
}

bool Registration::Self::holds_again() const {
  if (now_.doubted)
    return search_.own_leads();
  return now_.search.own_score > settings_.again_sure &&
         search_.contradiction() < settings_.doubts && search_.own_is_best();
}

const Output& Registration::Self::step(const Inputs& inputs) {
  now_.output.matches.clear();
  now_.output.presence = {};
  now_.output.objects.clear();
  move(inputs);
  if (now_.on && !lines_.empty()) {
    const std::vector<PlacedReading> readings = place(inputs.readings);
    const std::vector<const Percept*> percepts = fresh(inputs);
    correct(percepts);
    correct(readings);
    look_around(readings);
    const int openings = now_.search.own_openings;
    look_elsewhere(readings, percepts);
    note_openings(openings);
    if (now_.standing.step(now_.moved, readings))
      suspect_it_was_carried();
    if (now_.state == v1::REGISTRATION_TRACKING &&
        (now_.search.own_score < settings_.lost || search_.contradiction() >= settings_.refuted))
      now_.state = v1::REGISTRATION_LOST;
    else if (now_.state == v1::REGISTRATION_LOST && holds_again())
      now_.state = v1::REGISTRATION_TRACKING;
    if (now_.state == v1::REGISTRATION_TRACKING)
      now_.doubted = false;
    // Walls are alike elsewhere: the pose of a robot that was carried needs an opening, too.
    now_.confirmed = now_.confirmed ||
                     (now_.search.own_score >= settings_.sure &&
                      (!now_.carried || now_.search.own_openings > 0 || lines_.openings().empty()));
    now_.carried = now_.carried && !now_.confirmed;
    if (now_.state == v1::REGISTRATION_TRACKING && now_.confirmed)
      now_.other_map = false;
    look_for_news(inputs, readings);
  } else {
    now_.standing.forget();
  }
  report();
  return now_.output;
}

void Registration::Self::find_environment() {
  const auto before = now_.output.environment;
  now_.output.environment.reset();
  if (now_.state != v1::REGISTRATION_TRACKING && now_.state != v1::REGISTRATION_OFF)
    return;
  if (!now_.filter)
    return;
  int best = -1;
  for (const auto& [i, box] : regions_) {
    const int r = maps::traits(map_.features[i].type).environment;
    if (r < best || !box.contains(now_.filter->pose().position()))
      continue;
    // Where two of a kind cross, the robot stays in its present one.
    if (r > best || (before && *before == i)) {
      best = r;
      now_.output.environment = i;
    }
  }
}

void Registration::Self::report() {
  now_.output.state = now_.on ? now_.state : v1::REGISTRATION_OFF;
  find_environment();
  if (now_.filter) {
    now_.output.pose_in_map = now_.filter->pose();
    now_.output.covariance = now_.filter->pose_covariance();
  } else {
    now_.output.covariance = Eigen::Matrix3d::Identity() * 1e6;
  }
  now_.output.confidence = 0.0;
  if (!now_.on) {
    now_.output.reason = "switched off: the pose goes on by dead reckoning";
    now_.output.confidence = now_.filter ? 0.5 : 0.0;
  } else if (lines_.empty()) {
    now_.output.reason = "the map has no walls";
  } else if (now_.state == v1::REGISTRATION_UNPLACED) {
    now_.output.confidence = 0.0;
    now_.output.reason =
        now_.other_map ? "another map was loaded: looking for where the robot is on it"
        : now_.search.hypotheses.empty() ? "looking for where it is: no opening seen yet"
                                         : "looking for where it is: several places would do";
  } else if (now_.state == v1::REGISTRATION_LOST) {
    now_.output.reason = now_.doubted && now_.carried
                             ? "all around has changed while it stood, as if it had been carried: "
                               "what is heard has not confirmed yet that it is where it was"
                         : now_.doubted ? "dead reckoning has begun anew: what is heard has not "
                                          "confirmed yet that the robot is where it was"
                                        : "the readings do not fit the map at this pose";
  } else {
    const auto between = [](double score, double lost, double sure) {
      return std::clamp((score - lost) / (sure - lost), 0.0, 1.0);
    };
    now_.output.confidence =
        std::min(between(now_.search.own_score, settings_.lost, settings_.sure),
                 between(search_.contradiction() - explained_by_furniture(), settings_.refuted,
                         settings_.doubts));
    if (in_a_corridor())
      now_.output.confidence =
          std::min(now_.output.confidence, std::clamp(search_.near_share(), 0.0, 1.0));
    if (!now_.confirmed)
      now_.output.confidence = std::min(now_.output.confidence, kUnconfirmed);
    now_.output.reason =
        !now_.confirmed && now_.other_map
            ? "another map was loaded: too little was heard yet to confirm the pose on it"
        : !now_.confirmed && now_.carried
            ? "it was carried, as it seems, and has seen no opening of the map since: drive past a "
              "door, or tell it where it is (saphira map place)"
        : !now_.confirmed ? "as it was told or remembered: too little was heard yet to confirm it"
        : now_.output.confidence < 0.5        ? "the readings hardly fit the map"
        : now_.filter->sigma_position() > 0.5 ? "nothing matched for long: by dead reckoning"
                                              : "matched with the map";
  }
}

/// Rooms hold furniture that no map has: there the last metres alone say little.
bool Registration::Self::in_a_corridor() const {
  const auto& region = now_.output.environment;
  return region && (map_.features[*region].type == PointType::corridor ||
                    map_.features[*region].type == PointType::junction);
}

/// Maps leave furniture out: in a room, a share of the evidence of its walls says nothing.
double Registration::Self::explained_by_furniture() const {
  const auto& region = now_.output.environment;
  return region && map_.features[*region].type == PointType::office
             ? std::min(settings_.furniture, search_.contradiction_of_walls())
             : 0.0;
}

Registration::Registration(Settings settings, maps::Map map, std::optional<Pose> pose_in_map)
    : self_(std::make_unique<Self>(std::move(settings), std::move(map))) {
  if (pose_in_map)
    set_pose(*pose_in_map);
}
Registration::~Registration() = default;
Registration::Registration(Registration&&) noexcept = default;
Registration& Registration::operator=(Registration&&) noexcept = default;

const Output& Registration::step(const Inputs& inputs) {
  return self_->step(inputs);
}

const Output& Registration::output() const {
  return self_->output();
}

void Registration::set_map(maps::Map map) {
  auto next = std::make_unique<Self>(self_->settings(), std::move(map));
  next->set_state(self_->state());
  next->follow_edit(self_->map());
  self_ = std::move(next);
}

void Registration::archive(Archive& a) {
  maps::Map map = self_->map();
  RegistrationState state = self_->state();
  a("map", map)("state", state);
  if (!a.restores())
    return;
  auto next = std::make_unique<Self>(self_->settings(), std::move(map));
  next->set_state(std::move(state));
  self_ = std::move(next);
}

void Registration::doubt_the_map() {
  self_->doubt_the_map();
}

const maps::Map& Registration::map() const {
  return self_->map();
}

void Registration::set_pose(const Pose& pose_in_map, const Sigmas& sigmas) {
  const double drift = self_->settings().drift_error;
  self_->place(pose_in_map, covariance_of(sigmas), 0.0, drift * drift, kUnconfirmed);
}

void Registration::forget_pose() {
  self_->forget();
}

void Registration::switch_on(bool on) {
  self_->switch_on(on);
}

const std::set<std::uint32_t>& Registration::closed_doors() const {
  return self_->closed_doors();
}

void Registration::recall_closed(std::set<std::uint32_t> doors) {
  self_->recall_closed(std::move(doors));
}

const RegistrationState& Registration::state() const {
  return self_->state();
}

Memory Registration::save() const {
  return self_->save();
}

void Registration::restore(const Memory& memory, const std::optional<Pose>& start) {
  self_->restore(memory, start);
}

}  // namespace saphira::registration
