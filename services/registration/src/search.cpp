#include "saphira/registration/search.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::registration {
namespace {

constexpr double kOpening = 3.0;   // score of a present or missing door or junction
constexpr double kCorridor = 0.5;  // the same for a corridor
constexpr double kDenied = 4.0;    // evidence of a missing one against the present place
constexpr double kWall = 0.5;      // the same of a wall that the map does not have
constexpr double kPoor = 6.0;      // evidence of the readings against a new place that prevents it

bool same_place(const Pose& a, const Pose& b, double way, double turn) {
  return std::hypot(a.x - b.x, a.y - b.y) < way && std::abs(norm2_angle(a.th - b.th)) < turn;
}

bool elsewhere(const Pose& a, const Pose& b) {
  return !same_place(a, b, 0.5, radians(15.0));
}

/// True where the map has a wall there.
bool is_wall(const LineMap& lines, const Vec2& position) {
  constexpr double kBeside = 0.3;  // [m]
  return std::any_of(lines.surfaces().begin(), lines.surfaces().end(), [&](const Surface& surface) {
    const Vec2 way = surface.to - surface.from;
    const double along = std::clamp(
        (position - surface.from).dot(way) / std::max(1e-12, way.squaredNorm()), 0.0, 1.0);
    return (surface.from + along * way - position).norm() < kBeside;
  });
}
Pose inverse(const Pose& pose) {
  return relative(pose, Pose{});
}

}  // namespace

Search::Search(const maps::Map& map, const LineMap& lines, const RangeModel& model,
               const SearchSettings& settings, const MatchSettings& match_settings,
               const ReckoningErrors& reckoning, double drift_error, SearchState& state)
    : map_(&map),
      maps_corridors_(std::any_of(
          map.features.begin(), map.features.end(),
          [](const maps::Feature& feature) { return feature.type == lps::PointType::corridor; })),
      lines_(&lines),
      model_(&model),
      settings_(settings),
      match_settings_(match_settings),
      reckoning_(reckoning),
      drift_error_(drift_error),
      now_(state) {}

void Search::clear() {
  now_ = {};
}

double Search::worth(const Vec2& sensor_in_map, const Vec2& ahead, double range, bool echo) const {
  const double better = model_->log_likelihood(sensor_in_map, ahead, range, echo) -
                        (echo ? settings_.any_echo : settings_.any_silence);
  return settings_.trust * std::max(better, -settings_.surprise);
}

double Search::weigh(const Pose& pose, const PlacedReading& reading) const {
  const Pose sensor = compose(pose, relative(*now_.odom, reading.sensor_in_odom));
  return worth(sensor.position(), sensor.direction(), reading.range, reading.echo);
}

void Search::step(const Pose& pose_in_odom, const std::vector<PlacedReading>& readings,
                  const std::vector<const lps::Percept*>& fresh, const PoseFilter* own) {
  now_.own.reset();
  if (own != nullptr)
    now_.own = own->pose();
  const Pose moved = now_.odom ? relative(*now_.odom, pose_in_odom) : Pose{};
  const double way = std::hypot(moved.x, moved.y);
  now_.odom = pose_in_odom;
  now_.travelled += way + 0.3 * std::abs(moved.th);
  const double fading = std::exp(-way / settings_.memory);
  for (Hypothesis& h : now_.hypotheses) {
    h.filter.move(moved);
    h.way += way;
    h.score *= fading;
  }
  now_.own_score *= fading;
  now_.near_score *= std::exp(-way / settings_.near_memory);
  now_.openings *= std::exp(-way / settings_.openings_memory);
  // Readings of a robot that stands repeat one event.
  if (now_.travelled >= settings_.spacing) {
    now_.travelled -= settings_.spacing;
    for (const PlacedReading& reading : readings) {
      for (Hypothesis& h : now_.hypotheses)
        h.score += weigh(h.filter.pose(), reading);
      if (now_.own) {
        const double worth = weigh(*now_.own, reading);
        now_.own_score += worth;
        now_.near_score += worth;
      }
      now_.history.push_back(reading);
    }
    while (now_.history.size() > settings_.history)
      now_.history.pop_front();
    now_.travelled = std::min(now_.travelled, settings_.spacing);
  }
  for (const lps::Percept* percept : fresh) {
    const bool opening =
        percept->type == lps::PointType::door || percept->type == lps::PointType::junction;
    for (Hypothesis& h : now_.hypotheses) {
      const Match result = match(*percept, pose_in_odom, *map_, *lines_, match_settings_, h.filter);
      h.openings += opening && result.accepted ? 1 : 0;
      h.score += worth(*percept, result, h.filter.pose());
    }
    if (own != nullptr) {
      PoseFilter copy = *own;
      const Match result = match(*percept, pose_in_odom, *map_, *lines_, match_settings_, copy);
      const double score = worth(*percept, result, own->pose());
      now_.own_score += score;
      now_.near_score += score;
      if (opening && score > 0.0) {
        ++now_.own_openings;
        support_own(score, 1.0);
        now_.openings = std::max(0.0, now_.openings - score);
      } else if (opening && score < 0.0) {
        now_.openings += kDenied;
      } else if (!percept->is_hypothesis() && !result.accepted && !result.ambiguous) {
        now_.strange = std::min(now_.strange + kWall, settings_.strange);
      }
    }
    if (opening)
      propose(*percept);
  }
  thin_out();
}

void Search::support_own(double evidence, double share) {
  now_.against = std::max(0.0, now_.against - share * evidence);
  now_.strange = std::max(0.0, now_.strange - evidence);
}

void Search::test_own(double bearing, double worth) {
  if (worth > 0.0)
    support_own(std::min(worth, settings_.agrees), settings_.alike);
  else if (worth > settings_.trust * -settings_.surprise)
    now_.strange = std::min(now_.strange - worth, settings_.strange);
  else if (std::abs(std::sin(bearing)) > std::sin(settings_.sideways))
    now_.against -= worth;
}

void Search::found_closed(std::size_t doors) {
  now_.openings += static_cast<double>(doors) * settings_.closed;
}

/// The score of a present or missing object, for a place.
double Search::worth(const lps::Percept& percept, const Match& match,
                     const Pose& robot_in_map) const {
  if (!percept.is_hypothesis() || match.ambiguous)
    return 0.0;
  // A corridor is seen anew every few steps, a door once.
  const bool corridor = percept.type == lps::PointType::corridor;
  const double each = corridor ? kCorridor : kOpening;
  if (match.accepted)
    return each;
  // A map of walls alone defines the places of walls, but not those without corridors and doors.
  const Pose seen_in_map = compose(robot_in_map, relative(*now_.odom, percept.pose_in_odom));
  const bool denied = corridor
                          ? maps_corridors_
                          : !lines_->openings().empty() || is_wall(*lines_, seen_in_map.position());
  return denied ? -each : 0.0;
}

void Search::propose(const lps::Percept& percept) {
  const Pose seen = relative(*now_.odom, percept.pose_in_odom);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  const double position = percept.sigma_along * percept.sigma_along +
                          percept.sigma_across * percept.sigma_across + 0.1 * 0.1;
  const double heading = percept.sigma_heading * percept.sigma_heading + 0.05 * 0.05;
  covariance.diagonal() << position, position, heading;
  for (const Opening& opening : lines_->openings()) {
    if (std::abs(opening.width - percept.width) > match_settings_.width)
      continue;
    const Pose pose = compose(opening.pose_in_map, inverse(seen));
    const bool there = std::any_of(
        now_.hypotheses.begin(), now_.hypotheses.end(),
        [&](const Hypothesis& h) { return same_place(h.filter.pose(), pose, 0.4, radians(8.0)); });
    if (there)
      continue;
    Hypothesis fresh{PoseFilter(pose, covariance, 0.0, drift_error_ * drift_error_, reckoning_),
                     0.0, 0.0, 1, false};
    // The newest first: most places need only a few.
    for (auto reading = now_.history.rbegin();
         reading != now_.history.rend() && fresh.score > -kPoor; ++reading)
      fresh.score += weigh(pose, *reading);
    if (fresh.score > -kPoor)
      now_.hypotheses.push_back(fresh);
  }
}

void Search::thin_out() {
  if (now_.hypotheses.empty())
    return;
  std::stable_sort(now_.hypotheses.begin(), now_.hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
  const double least = now_.hypotheses.front().score - settings_.hopeless;
  std::vector<Hypothesis> left;
  for (Hypothesis& h : now_.hypotheses) {
    if (left.size() >= settings_.hypotheses)
      break;
    // A young hypothesis had no time for a high score.
    if (h.score < (h.way < settings_.way ? -kPoor : least))
      continue;
    const auto twice = std::find_if(left.begin(), left.end(), [&](const Hypothesis& other) {
      return same_place(h.filter.pose(), other.filter.pose(), 0.2, radians(5.0));
    });
    if (twice == left.end())
      left.push_back(h);
    else
      twice->told = twice->told || h.told;
  }
  now_.hypotheses = std::move(left);
}

void Search::suspect(const PoseFilter& filter) {
  now_.hypotheses.push_back({filter, 0.0, 0.0, 0, true});
}

bool Search::is_own(const Pose& pose_in_map) const {
  return now_.own && !elsewhere(pose_in_map, *now_.own);
}

bool Search::own_is_best() const {
  const auto other = best(true);
  return !other || other->hypothesis->score < now_.own_score;
}

double Search::near_share() const {
  const double usual = now_.own_score * settings_.near_memory / settings_.memory;
  return usual <= 0.0 ? 1.0 : now_.near_score / std::min(usual, settings_.near_enough);
}

void Search::set_own_score(double score) {
  now_.own_score = score;
  now_.near_score = score * settings_.near_memory / settings_.memory;
}

bool Search::leads(const Pose& pose, double score) const {
  return score >= settings_.evidence &&
         std::none_of(now_.hypotheses.begin(), now_.hypotheses.end(), [&](const Hypothesis& h) {
           // Any place in the map is less likely than the earlier or the given one.
           const double ahead = h.told ? settings_.margin : -settings_.margin;
           return elsewhere(h.filter.pose(), pose) && score < h.score + ahead;
         });
}

bool Search::own_leads() const {
  return now_.own && leads(*now_.own, now_.own_score);
}

const Search::Hypothesis* Search::told_leads() const {
  const auto told = std::find_if(now_.hypotheses.begin(), now_.hypotheses.end(),
                                 [](const Hypothesis& h) { return h.told; });
  if (told == now_.hypotheses.end() || told->score < now_.own_score + settings_.margin ||
      told->way < settings_.way || !leads(told->filter.pose(), told->score))
    return nullptr;
  return &*told;
}

std::optional<Search::Best> Search::best(bool beside_own) const {
  const bool own = beside_own && now_.own;
  const auto first = std::find_if(
      now_.hypotheses.begin(), now_.hypotheses.end(),
      [&](const Hypothesis& h) { return !own || elsewhere(h.filter.pose(), *now_.own); });
  if (first == now_.hypotheses.end())
    return std::nullopt;
  double second = 0.0;  // the average place
  if (own)
    second = std::max(second, now_.own_score);
  for (const Hypothesis& h : now_.hypotheses)
    if (elsewhere(h.filter.pose(), first->filter.pose()))
      second = std::max(second, h.score);
  const double margin = first->score - second;
  const bool enough = first->score >= settings_.evidence && first->way >= settings_.way;
  // With fewer explained openings it needs a larger lead.
  const bool sure =
      enough && ((first->openings >= settings_.matches && margin >= settings_.margin) ||
                 (first->openings >= settings_.matches - 1 && margin >= 1.6 * settings_.margin));
  const bool likely =
      enough && first->openings >= settings_.matches - 1 && margin >= settings_.margin;
  return Best{&*first, margin, likely, sure};
}

}  // namespace saphira::registration
