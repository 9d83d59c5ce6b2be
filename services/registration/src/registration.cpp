#include "saphira/registration/registration.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <utility>

namespace saphira::registration {
namespace {

using lps::Percept;
using lps::PointType;

constexpr double kNear = 1.0;                // [m] another place within this and...
constexpr double kNearTurn = radians(20.0);  // ...this is a correction; farther off it was lost
constexpr std::size_t kTurns = 600;          // cycles
constexpr std::size_t kKeptReadings = 4000;  // used ones that are remembered

/// Hypotheses before features, paper 3.2: what constrains most comes first.
int order(PointType type) {
  switch (type) {
    case PointType::corridor:
      return 0;
    case PointType::wall:
      return 1;
    case PointType::junction:
      return 2;
    case PointType::door:
      return 3;
    default:
      return 4;
  }
}

int rank(PointType type) {
  switch (type) {
    case PointType::junction:
      return 3;
    case PointType::corridor:
      return 2;
    case PointType::lane:
      return 1;
    case PointType::office:
      return 0;
    default:
      return -1;
  }
}

Eigen::Matrix3d covariance_of(const Sigmas& sigmas) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.diagonal() << sigmas.position * sigmas.position, sigmas.position * sigmas.position,
      sigmas.heading * sigmas.heading;
  return covariance;
}

}  // namespace

std::string_view word(State state) {
  switch (state) {
    case State::off:
      return "off";
    case State::unplaced:
      return "unplaced";
    case State::tracking:
      return "tracking";
    case State::lost:
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
        search_(map_, lines_, model_, settings_.search, settings_.match, settings_.reckoning,
                settings_.drift_error) {}
  Self(const Self&) = delete;
  Self& operator=(const Self&) = delete;

  const Output& step(const Inputs& inputs);
  const Output& output() const { return output_; }
  const maps::Map& map() const { return map_; }
  const Settings& settings() const { return settings_; }
  bool on() const { return on_; }

  void place(const Pose& pose, const Eigen::Matrix3d& covariance, double drift,
             double drift_variance, double confidence);
  void forget();
  void switch_on(bool on);
  void take_over(const Self& other);
  Memory save() const;
  void restore(const Memory& memory);
  const std::set<std::uint32_t>& closed_doors() const { return presence_.closed(); }
  void recall_closed(std::set<std::uint32_t> doors) {
    presence_.recall(std::move(doors));
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
  void forget_looks();
  void look_for_news(const Inputs& inputs, const std::vector<PlacedReading>& readings);
  bool uses_old_readings(const Percept& percept) const;
  double turned_since(const Percept& percept) const;
  void find_environment();
  void report();

  struct Done {
    std::uint32_t percept;
    std::uint64_t cycle;
    Pose pose_in_odom;  // of the robot
    double width;
    double length;
  };

  Settings settings_;
  maps::Map map_;
  LineMap lines_;
  Field field_;
  RangeModel model_;
  Search search_;

  ParticleCloud cloud_{settings_.cloud};
  std::map<int, double> weighed_;  // [m] of way when a sonar was weighed last
  double way_ = 0.0;               // [m] ever
  double lead_ = 0.0;              // of the cloud before the filter
  double cloud_score_ = 0.0;
  bool leads_ = false;  // the cloud, and the filter is set by it
  double led_ = 0.0;    // [m]
  double trial_ = settings_.trial / 2.0;

  Presence presence_{settings_.presence};
  ObjectFinder objects_{settings_.objects};

  bool on_ = true;
  State state_ = State::unplaced;
  std::optional<PoseFilter> filter_;
  std::uint64_t cycle_ = 0;
  std::optional<std::uint64_t> odom_;
  Pose pose_in_odom_;
  Pose moved_;                                          // in this cycle
  double since_readings_ = 0.0;                         // [m] of way since readings corrected it
  double turned_ = 0.0;                                 // [rad] ever, either way
  std::deque<std::pair<std::uint64_t, double>> turns_;  // the same by cycle, of late
  std::vector<Done> done_;
  std::set<std::pair<std::uint64_t, int>> used_;  // readings of accepted percepts
  std::optional<Memory> restored_;
  Output output_;
};

/// What was heard from a pose, or of a map, that did not hold says nothing.
void Registration::Self::forget_looks() {
  presence_.recall(presence_.closed());
  objects_ = ObjectFinder(settings_.objects);
}

void Registration::Self::place(const Pose& pose, const Eigen::Matrix3d& covariance, double drift,
                               double drift_variance, double confidence) {
  filter_.emplace(pose, covariance, drift, drift_variance, settings_.reckoning);
  search_.clear();
  search_.believe(confidence * settings_.sure);
  state_ = State::tracking;
  done_.clear();
  cloud_.clear();
  leads_ = false;
  forget_looks();
}

void Registration::Self::forget() {
  cloud_.clear();
  filter_.reset();
  search_.clear();
  state_ = State::unplaced;
  done_.clear();
  forget_looks();
}

void Registration::Self::switch_on(bool on) {
  on_ = on;
  if (!on)
    cloud_.clear();
}

void Registration::Self::take_over(const Self& other) {
  on_ = other.on_;
  state_ = other.state_;
  filter_ = other.filter_;
  cloud_ = other.cloud_;
  lead_ = other.lead_;
  cloud_score_ = other.cloud_score_;
  leads_ = other.leads_;
  led_ = other.led_;
  trial_ = other.trial_;
  way_ = other.way_;
  weighed_ = other.weighed_;
  presence_ = other.presence_;
  objects_ = other.objects_;
  search_.believe(other.search_.own_score());
  cycle_ = other.cycle_;
  odom_ = other.odom_;
  pose_in_odom_ = other.pose_in_odom_;
  output_ = other.output_;
  output_.matches.clear();
  output_.presence = {};
  output_.objects.clear();
  restored_ = other.restored_;
  find_environment();
}

Memory Registration::Self::save() const {
  Memory memory;
  memory.odom = odom_.value_or(0);
  memory.pose_in_odom = pose_in_odom_;
  memory.placed = filter_.has_value() && state_ != State::lost;
  if (filter_) {
    memory.pose_in_map = filter_->pose();
    memory.covariance = filter_->covariance();
    memory.drift = filter_->drift();
    memory.confidence = output_.confidence;
  }
  return memory;
}

void Registration::Self::restore(const Memory& memory) {
  if (!memory.placed)
    return;
  place(memory.pose_in_map, memory.covariance.topLeftCorner<3, 3>(), memory.drift,
        memory.covariance(3, 3), memory.confidence);
  filter_->set_covariance(memory.covariance);
  odom_ = memory.odom;
  pose_in_odom_ = memory.pose_in_odom;
  report();
}

void Registration::Self::move(const Inputs& inputs) {
  moved_ = Pose{};
  if (odom_ && *odom_ == inputs.odom) {
    moved_ = relative(pose_in_odom_, inputs.pose_in_odom);
  } else if (odom_) {
    // Dead reckoning begins anew: the robot has been switched off, and may have been moved a bit.
    done_.clear();
    used_.clear();
    search_.clear();
    if (filter_)
      filter_->widen(0.3, radians(10.0));
    cloud_.clear();
  }
  odom_ = inputs.odom;
  pose_in_odom_ = inputs.pose_in_odom;
  cycle_ = inputs.cycle;
  turned_ += std::abs(moved_.th);
  turns_.emplace_back(cycle_, turned_);
  if (turns_.size() > kTurns)
    turns_.pop_front();
  if (filter_)
    filter_->move(moved_);
  cloud_.move(moved_);
}

std::vector<PlacedReading> Registration::Self::place(
    const std::vector<lps::SonarReading>& readings) const {
  std::vector<PlacedReading> placed;
  const Pose before = compose(pose_in_odom_, relative(moved_, Pose{}));
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto mount =
        std::find_if(settings_.sonars.begin(), settings_.sonars.end(),
                     [&](const lps::SonarMount& m) { return m.sonar == readings[i].sonar; });
    if (mount == settings_.sonars.end())
      continue;
    // They came one after the other while the robot moved.
    const double part = static_cast<double>(i + 1) / static_cast<double>(readings.size());
    const Pose at = compose(before, {moved_.x * part, moved_.y * part, moved_.th * part});
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
                                   return used_.count({id.cycle, id.sonar}) != 0;
                                 });
  return 2 * static_cast<std::size_t>(old) > percept.readings.size();
}

double Registration::Self::turned_since(const Percept& percept) const {
  // Half of what made it is newer.
  const std::uint64_t cycle =
      percept.readings.empty() ? percept.seen : percept.readings[percept.readings.size() / 2].cycle;
  const auto at = std::lower_bound(
      turns_.begin(), turns_.end(), cycle,
      [](const std::pair<std::uint64_t, double>& turn, std::uint64_t c) { return turn.first < c; });
  return at == turns_.end() ? 0.0 : turned_ - at->second;
}

std::vector<const Percept*> Registration::Self::fresh(const Inputs& inputs) {
  std::vector<const Percept*> result;
  for (const Percept& percept : inputs.percepts) {
    if (percept.confidence < settings_.least_confidence ||
        percept.seen + settings_.fresh < inputs.cycle ||
        turned_since(percept) > settings_.most_turned)
      continue;
    const auto last = std::find_if(done_.begin(), done_.end(),
                                   [&](const Done& done) { return done.percept == percept.id; });
    if (last != done_.end()) {
      const Pose since = relative(last->pose_in_odom, inputs.pose_in_odom);
      const bool point = percept.type == PointType::door || percept.type == PointType::junction ||
                         percept.type == PointType::breach;
      // What was seen of an opening does not get better by driving on; a wall is seen anew.
      if (point ? std::abs(last->width - percept.width) < 0.05
                : std::hypot(since.x, since.y) < settings_.again &&
                      std::abs(since.th) < settings_.again_turned)
        continue;
      done_.erase(last);
    }
    result.push_back(&percept);
  }
  std::stable_sort(result.begin(), result.end(), [](const Percept* a, const Percept* b) {
    return order(a->type) < order(b->type);
  });
  return result;
}

void Registration::Self::correct(const std::vector<const Percept*>& percepts) {
  for (const Percept* percept : percepts) {
    done_.push_back({percept->id, cycle_, pose_in_odom_, percept->width, percept->length});
    if (!filter_)
      continue;
    if (percept->type != PointType::door && percept->type != PointType::junction &&
        uses_old_readings(*percept)) {
      Match result;
      result.percept = percept->id;
      result.reason = "its readings have been used";
      output_.matches.push_back(result);
      continue;
    }
    const Pose before = filter_->pose();
    const Eigen::Matrix3d covariance_before = filter_->pose_covariance();
    const Match result = match(*percept, pose_in_odom_, map_, lines_, settings_.match, *filter_);
    // Walls are drawn through what dead reckoning put together; the cloud has their readings.
    if (result.accepted && !cloud_.empty() && order(percept->type) >= order(PointType::junction))
      cloud_.learn(before, covariance_before, filter_->pose(), filter_->pose_covariance());
    if (result.accepted)
      for (const lps::ReadingId& id : percept->readings)
        used_.insert({id.cycle, id.sonar});
    output_.matches.push_back(result);
  }
  while (used_.size() > kKeptReadings)
    used_.erase(used_.begin());
  if (done_.size() > 200)
    done_.erase(done_.begin(), done_.begin() + 100);
}

void Registration::Self::correct(const std::vector<PlacedReading>& readings) {
  since_readings_ += std::hypot(moved_.x, moved_.y) + 0.3 * std::abs(moved_.th);
  if (since_readings_ < settings_.search.spacing || !filter_ || leads_)
    return;
  since_readings_ = 0.0;
  for (const PlacedReading& reading : readings) {
    if (!reading.echo || reading.range > settings_.wall_range)
      continue;
    const Pose robot = filter_->pose();
    const Pose sensor = compose(robot, relative(pose_in_odom_, reading.sensor_in_odom));
    const Field::Nearest nearest = field_.nearest(sensor.position());
    if (nearest.towards.dot(sensor.direction()) < std::cos(settings_.range.facing))
      continue;
    const Vec2 arm = sensor.position() - robot.position();
    Eigen::Matrix<double, 1, 4> jacobian = Eigen::Matrix<double, 1, 4>::Zero();
    jacobian.leftCols<2>() = -nearest.towards.transpose();
    jacobian(0, 2) = -nearest.towards.dot(Vec2(-arm.y(), arm.x()));
    const double spread =
        std::sqrt((jacobian * filter_->covariance() * jacobian.transpose()).value());
    const Eigen::Matrix<double, 1, 1> innovation(reading.range - nearest.distance);
    if (std::abs(innovation.value()) > std::clamp(1.5 * spread, 0.15, 0.3))
      continue;
    filter_->correct<1>(innovation, jacobian,
                        Eigen::Matrix<double, 1, 1>(settings_.wall_sigma * settings_.wall_sigma));
  }
}

void Registration::Self::look_around(const std::vector<PlacedReading>& readings) {
  if (!filter_)
    return;
  if (cloud_.empty()) {
    cloud_.begin(filter_->pose(), filter_->pose_covariance(), filter_->drift(),
                 std::max(settings_.cloud.drift, std::sqrt(filter_->covariance()(3, 3))));
    lead_ = 0.0;
    cloud_score_ = search_.own_score();
    return;
  }
  const double way = std::hypot(moved_.x, moved_.y);
  // Turning on the spot shows the same things again: what the map does not have, as a door that is
  // closed, would weigh more with each turn.
  way_ += way;
  const double fading = std::exp(-way / settings_.lead_memory);
  lead_ *= fading;
  cloud_score_ *= fading;
  const std::vector<PlacedReading> fresh = fresh_ones(readings);
  if (!fresh.empty()) {
    const Pose middle = cloud_.estimate().pose;
    for (const PlacedReading& reading : fresh) {
      const Pose in_robot = relative(pose_in_odom_, reading.sensor_in_odom);
      const auto worth = [&](const Pose& sensor_in_map) {
        return search_.worth(sensor_in_map, reading.range, reading.echo);
      };
      cloud_.weigh(in_robot, worth);
      const double here = worth(compose(middle, in_robot));
      cloud_score_ += here;
      lead_ += here - worth(compose(filter_->pose(), in_robot));
    }
    cloud_.select();
  }
  if (!leads_ && std::abs(lead_) <= settings_.lead)
    return;  // neither is better
  const ParticleCloud::Estimate there = cloud_.estimate();
  if (leads_) {
    filter_.emplace(there.pose, there.covariance, there.drift, there.drift_variance,
                    settings_.reckoning);
    lead_ = 0.0;
    led_ += way;
    if (led_ > trial_)
      leads_ = false;
    return;
  }
  const double apart = (there.pose.position() - filter_->pose().position()).norm();
  const double turned = std::abs(norm2_angle(there.pose.th - filter_->pose().th));
  if (apart < settings_.lead_apart && turned < settings_.lead_turned)
    return;
  if (lead_ < -settings_.lead)
    cloud_.clear();  // and begins anew from the filter
  // Where the filter has fitted better on the whole, it is what is seen here that the map lacks.
  else if (lead_ > settings_.lead && cloud_score_ > search_.own_score() && dense(there))
    follow(there, cloud_score_);
}

bool Registration::Self::dense(const ParticleCloud::Estimate& cloud) const {
  return cloud.covariance(0, 0) + cloud.covariance(1, 1) < settings_.dense * settings_.dense &&
         cloud.covariance(2, 2) < settings_.dense_turned * settings_.dense_turned;
}

/// Dead reckoning is worse than the filter may take it to be: for some way the cloud leads.
void Registration::Self::follow(const ParticleCloud::Estimate& cloud, double score) {
  if ((cloud.pose.position() - filter_->pose().position()).norm() > kNear ||
      std::abs(norm2_angle(cloud.pose.th - filter_->pose().th)) > kNearTurn)
    state_ = State::lost;  // said, so that who relies on the pose hears that it did not hold
  filter_.emplace(cloud.pose, cloud.covariance, cloud.drift, cloud.drift_variance,
                  settings_.reckoning);
  search_.believe(score);
  done_.clear();
  leads_ = true;
  led_ = 0.0;
  trial_ *= 2.0;
  lead_ = 0.0;
}

/// Those that do not repeat what their sonar heard a moment ago.
std::vector<PlacedReading> Registration::Self::fresh_ones(
    const std::vector<PlacedReading>& readings) {
  std::vector<PlacedReading> result;
  for (const PlacedReading& reading : readings) {
    const auto last = weighed_.find(reading.sonar);
    if (last != weighed_.end() && way_ < last->second + settings_.search.spacing)
      continue;
    weighed_[reading.sonar] = way_;
    result.push_back(reading);
  }
  return result;
}

void Registration::Self::look_elsewhere(const std::vector<PlacedReading>& readings,
                                        const std::vector<const Percept*>& percepts) {
  search_.step(pose_in_odom_, readings, percepts, filter_ ? &*filter_ : nullptr);
  const auto best = search_.best(state_ == State::tracking);
  if (!best)
    return;
  const Pose there = best->hypothesis->filter.pose();
  const bool near = filter_ && (there.position() - filter_->pose().position()).norm() < kNear &&
                    std::abs(norm2_angle(there.th - filter_->pose().th)) < kNearTurn;
  if (state_ == State::tracking && !near) {
    // Said before it is mended, so that who relies on the pose hears that it did not hold.
    if (best->likely)
      state_ = State::lost;
    return;
  }
  if (!best->sure)
    return;
  const PoseFilter found = best->hypothesis->filter;
  const double drift_variance = found.covariance()(3, 3);
  place(found.pose(), found.pose_covariance(), found.drift(), drift_variance, 1.0);
  // It is the best of many: its own matches have made it surer than it may be.
  filter_->widen(0.1, radians(3.0));
}

/// What is missed of the map, and what stands where it has nothing.
void Registration::Self::look_for_news(const Inputs& inputs,
                                       const std::vector<PlacedReading>& readings) {
  if (state_ != State::tracking || search_.own_score() < settings_.sure ||
      filter_->sigma_position() > settings_.sure_position)
    return;
  std::vector<Look> looks;
  for (const PlacedReading& reading : readings)
    looks.push_back({compose(filter_->pose(), relative(pose_in_odom_, reading.sensor_in_odom)),
                     reading.range, reading.echo});
  std::vector<std::uint32_t> open;
  for (const Match& match : output_.matches)
    if (match.accepted &&
        std::any_of(inputs.percepts.begin(), inputs.percepts.end(), [&](const Percept& percept) {
          return percept.id == match.percept && percept.type == PointType::door;
        }))
      open.push_back(match.artifact);
  output_.presence = presence_.step(map_, cycle_, filter_->pose().position(), looks, open);
  if (inputs.find_objects)
    output_.objects = objects_.step(map_, field_, cycle_, looks);
}

const Output& Registration::Self::step(const Inputs& inputs) {
  output_.matches.clear();
  output_.presence = {};
  output_.objects.clear();
  move(inputs);
  if (on_ && !lines_.empty()) {
    const std::vector<PlacedReading> readings = place(inputs.readings);
    const std::vector<const Percept*> percepts = fresh(inputs);
    correct(percepts);
    correct(readings);
    look_around(readings);
    look_elsewhere(readings, percepts);
    if (state_ == State::tracking && search_.own_score() < settings_.lost)
      state_ = State::lost;
    else if (state_ == State::lost && search_.own_score() > settings_.again_sure &&
             search_.own_is_best())
      state_ = State::tracking;
    look_for_news(inputs, readings);
  }
  report();
  return output_;
}

void Registration::Self::find_environment() {
  const auto before = output_.environment;
  output_.environment.reset();
  if (state_ != State::tracking && state_ != State::off)
    return;
  if (!filter_)
    return;
  int best = -1;
  for (std::size_t i = 0; i < map_.features.size(); ++i) {
    const maps::Feature& feature = map_.features[i];
    const int r = rank(feature.type);
    if (r < best || !maps::contains(feature, filter_->pose().position()))
      continue;
    // Where two of a kind cross, it stays in the one that it is in.
    if (r > best || (before && *before == i)) {
      best = r;
      output_.environment = i;
    }
  }
}

void Registration::Self::report() {
  output_.state = on_ ? state_ : State::off;
  if (filter_) {
    output_.pose_in_map = filter_->pose();
    output_.covariance = filter_->pose_covariance();
  } else {
    output_.covariance = Eigen::Matrix3d::Identity() * 1e6;
  }
  output_.confidence = 0.0;
  if (!on_) {
    output_.reason = "switched off: the pose goes on by dead reckoning";
    output_.confidence = filter_ ? 0.5 : 0.0;
  } else if (lines_.empty()) {
    output_.reason = "the map has no walls";
  } else if (state_ == State::unplaced) {
    output_.confidence = 0.0;
    output_.reason = search_.hypotheses().empty()
                         ? "looking for where it is: no opening seen yet"
                         : "looking for where it is: several places would do";
  } else if (state_ == State::lost) {
    output_.reason = "the readings do not fit the map at this pose";
  } else {
    output_.confidence = std::clamp(
        (search_.own_score() - settings_.lost) / (settings_.sure - settings_.lost), 0.0, 1.0);
    output_.reason = output_.confidence < 0.5 ? "the readings hardly fit the map"
                     : filter_->sigma_position() > 0.5
                         ? "nothing matched for long: by dead reckoning"
                         : "matched with the map";
  }
  find_environment();
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
  next->take_over(*self_);
  self_ = std::move(next);
}

const maps::Map& Registration::map() const {
  return self_->map();
}

void Registration::set_pose(const Pose& pose_in_map, const Sigmas& sigmas) {
  const double drift = self_->settings().drift_error;
  self_->place(pose_in_map, covariance_of(sigmas), 0.0, drift * drift, 0.8);
}

void Registration::forget_pose() {
  self_->forget();
}

void Registration::switch_on(bool on) {
  self_->switch_on(on);
}

bool Registration::on() const {
  return self_->on();
}

const std::set<std::uint32_t>& Registration::closed_doors() const {
  return self_->closed_doors();
}

void Registration::recall_closed(std::set<std::uint32_t> doors) {
  self_->recall_closed(std::move(doors));
}

Memory Registration::save() const {
  return self_->save();
}

void Registration::restore(const Memory& memory) {
  self_->restore(memory);
}

}  // namespace saphira::registration
