#include "saphira/vision/people.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "median.hpp"

namespace saphira::vision {
namespace {

constexpr int kColumnStep = 2;            // every second column of a picture is used
constexpr double kAboveHeads = 1.97;      // [m] doors reach so high, people do not
constexpr double kAboveHalf = 0.05;       // [m]
constexpr double kBandHalf = 0.08;        // [m] above and below a band's height
constexpr double kGap = radians(2.0);     // width of unmatched columns within one shape
constexpr double kBeside = radians(4.0);  // angle beside a shape for its background
constexpr double kTellsRound = 0.15;      // [m] of two sigmas of a range
constexpr double kSigmaDisparity = 0.3;   // [pixels]
constexpr double kTooNear = 1.2;          // [m]
constexpr double kNearestTorso = 0.8;     // [m] of a torso that lies in the picture

// Neighbouring columns of a band at one range.
struct Shape {
  std::size_t first = 0;  // columns
  std::size_t last = 0;
  double range = 0.0;  // [m] along the camera's axis
  double left = 0.0;   // [m] across it
  double right = 0.0;
  bool whole = true;  // nothing before it hides a part
};

class Shapes {
 public:
  Shapes(const Band& band, const Bands& bands, const PeopleSettings& settings)
      : band_(band), eye_(bands.eye_forward), bands_(bands), settings_(settings) {}

  std::vector<Shape> of_people() const {
    std::vector<Shape> found;
    std::vector<std::size_t> run;
    for (std::size_t column = 0; column < band_.size(); ++column) {
      if (!band_[column])
        continue;
      if (!run.empty() && !together(run.back(), column)) {
        take(run, found);
        run.clear();
      }
      run.push_back(column);
    }
    take(run, found);
    return found;
  }

 private:
  double depth(std::size_t column) const { return band_[column]->x() - eye_; }
  // From the left camera: columns lie side by side in its picture, however far their points are.
  double bearing(std::size_t column) const {
    return std::atan2(band_[column]->y() - bands_.eye_left, depth(column));
  }
  // Two sigmas of a range.
  double slack(double range) const { return 2.0 * bands_.uncertainty * range * range; }

  bool together(std::size_t a, std::size_t b) const {
    const double nearer = std::min(depth(a), depth(b));
    return std::abs(bearing(a) - bearing(b)) < kGap &&
           std::abs(depth(a) - depth(b)) < settings_.apart + slack(nearer);
  }

  // True where there is nothing below: a part of an arm.
  bool overhangs(std::size_t column) const {
    const auto& below = bands_.bands.front()[column];
    return below && below->x() - eye_ > depth(column) + settings_.apart;
  }

  void take(const std::vector<std::size_t>& run, std::vector<Shape>& found) const {
    if (take_whole(run, found))
      return;
    // Perhaps a torso with an outstretched arm.
    auto first = run.begin();
    auto last = run.end();
    while (first != last && overhangs(*first))
      ++first;
    while (first != last && overhangs(*(last - 1)))
      --last;
    if (first != run.begin() || last != run.end())
      take_whole({first, last}, found);
  }

  bool take_whole(const std::vector<std::size_t>& run, std::vector<Shape>& found) const {
    if (run.size() < 3)
      return false;
    Shape shape{run.front(), run.back(), 0.0, band_[run.front()]->y(), band_[run.back()]->y(),
                true};
    std::vector<double> depths;
    depths.reserve(run.size());
    for (const std::size_t column : run)
      depths.push_back(depth(column));
    std::sort(depths.begin(), depths.end());
    shape.range = depths[depths.size() / 2];
    const double deep = depths[depths.size() * 9 / 10] - depths[depths.size() / 10];
    const double width = shape.left - shape.right;
    if (shape.range < settings_.nearest || shape.range > settings_.farthest ||
        width < settings_.narrowest || width > settings_.widest + 0.1 * shape.range ||
        deep > settings_.deepest + slack(shape.range))
      return false;
    if (slack(shape.range) < kTellsRound && bulge(run) < settings_.round)
      return false;
    if (goes_on_above(run, shape.range))
      return false;
    const int before = background(run.front(), -1, shape.range);
    const int behind = background(run.back(), 1, shape.range);
    if (before < 0 && behind < 0)
      return false;  // seen through a gap
    shape.whole = before > 0 && behind > 0;
    if (before + behind <= 0)
      return false;
    found.push_back(shape);
    return true;
  }

  // The lead of the middle half over the sides [m], for any turn of the shape.
  double bulge(const std::vector<std::size_t>& run) const {
    const double centre = (band_[run.front()]->y() + band_[run.back()]->y()) / 2.0;
    const double half = (band_[run.front()]->y() - band_[run.back()]->y()) / 4.0;
    std::array<std::vector<double>, 3> parts;  // left, middle, right
    for (const std::size_t column : run) {
      const double off = band_[column]->y() - centre;
      parts[off > half ? 0 : off < -half ? 2 : 1].push_back(depth(column));
    }
    for (const auto& part : parts)
      if (part.empty())
        return 0.0;
    return (median(parts[0]) + median(parts[2])) / 2.0 - median(parts[1]);
  }

  bool goes_on_above(const std::vector<std::size_t>& run, double range) const {
    if (bands_.above.size() != band_.size())
      return false;
    std::size_t on = 0;
    for (const std::size_t column : run) {
      const auto& point = bands_.above[column];
      on += point && std::abs(point->x() - eye_ - range) < settings_.apart + slack(range) ? 1U : 0U;
    }
    return 3 * on > run.size();
  }

  // The range beside a shape: 1 farther (or nothing), -1 nearer, 0 as far, or the picture's end.
  int background(std::size_t from, int direction, double range) const {
    const double edge = bearing(from);
    // To its left the shape hides a strip from the right camera, which has no match.
    const double beside = kBeside + (direction < 0 ? 2.0 * bands_.eye_left / range : 0.0);
    for (auto column = static_cast<std::ptrdiff_t>(from) + direction;; column += direction) {
      if (column < 0 || column >= static_cast<std::ptrdiff_t>(band_.size()))
        return 0;
      const auto i = static_cast<std::size_t>(column);
      if (!band_[i])
        continue;
      if (std::abs(bearing(i) - edge) > beside)
        return range > kTooNear ? 1 : 0;  // nothing, or so near that it does not match
      const double behind = depth(i) - range;
      if (std::abs(behind) > settings_.apart)
        return behind > 0.0 ? 1 : -1;
    }
  }

  const Band& band_;
  double eye_;
  const Bands& bands_;
  const PeopleSettings& settings_;
};

// A person's middle, by one shape.
Vec2 middle(const Shape& shape, double eye, double radius) {
  const Vec2 front(shape.range, (shape.left + shape.right) / 2.0);
  const Vec2 back = front * (1.0 + radius / front.norm());
  return {back.x() + eye, back.y()};
}

}  // namespace

std::pair<int, int> torso_rows(const Rig& rig, int rows) {
  const auto row = [&](double height) {
    return static_cast<int>(0.5 * rows - (height - rig.height) * rig.focal / kNearestTorso);
  };
  return {std::max(0, row(kTorso.back() + kBandHalf)),
          std::min(rows, row(kTorso.front() - kBandHalf) + 1)};
}

Bands bands_of(const DisparityMap& map, const Rig& rig, int rows) {
  Bands out{.eye_forward = rig.forward,
            .eye_left = rig.baseline / 2.0,
            .uncertainty = kSigmaDisparity / (rig.focal * rig.baseline)};
  std::array<std::vector<double>, kTorso.size()> seen;
  std::vector<double> above;
  for (int column = 0; column < map.columns; column += kColumnStep) {
    for (auto& each : seen)
      each.clear();
    above.clear();
    for (int row = map.first_row; row < map.first_row + map.rows; ++row) {
      const auto disparity = map.at(column, row);
      if (!disparity || *disparity < 0.5)
        continue;
      const double range = rig.focal * rig.baseline / *disparity;
      const double height = rig.height + (0.5 * rows - row - 0.5) * range / rig.focal;
      if (std::abs(height - kAboveHeads) < kAboveHalf)
        above.push_back(range);
      for (std::size_t band = 0; band < kTorso.size(); ++band)
        if (std::abs(height - kTorso[band]) < kBandHalf)
          seen[band].push_back(range);
    }
    const double across = (column + 0.5 - 0.5 * map.columns) / rig.focal;
    const auto place = [&](std::vector<double>& ranges) -> std::optional<Vec2> {
      if (ranges.size() < 2)
        return std::nullopt;
      const double range = median(ranges);
      return Vec2(range + rig.forward, rig.baseline / 2.0 - across * range);
    };
    for (std::size_t band = 0; band < kTorso.size(); ++band)
      out.bands[band].push_back(place(seen[band]));
    out.above.push_back(place(above));
  }
  return out;
}

std::vector<Sight> find_people(const Bands& bands, const PeopleSettings& settings) {
  struct Candidate {
    Vec2 middle;
    double width;
    bool whole;
    std::size_t band;
    bool taken = false;
  };
  std::vector<Candidate> candidates;
  for (std::size_t band = 0; band < bands.bands.size(); ++band)
    for (const Shape& shape : Shapes(bands.bands[band], bands, settings).of_people())
      candidates.push_back({middle(shape, bands.eye_forward, settings.radius),
                            shape.left - shape.right, shape.whole, band});
  std::vector<Sight> people;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Candidate& one = candidates[i];
    if (one.taken)
      continue;
    const double far = (one.middle - Vec2(bands.eye_forward, 0.0)).norm();
    const double slack = 2.0 * bands.uncertainty * far * far;
    Vec2 sum = one.middle;
    double width = one.width;
    int whole = one.whole ? 1 : 0;
    int agreeing = 1;
    std::size_t last = one.band;
    for (std::size_t j = i + 1; j < candidates.size(); ++j) {
      Candidate& other = candidates[j];
      if (other.taken || other.band == last ||
          (other.middle - one.middle).norm() > settings.agree + slack)
        continue;
      other.taken = true;
      last = other.band;
      sum += other.middle;
      width += other.width;
      whole += other.whole ? 1 : 0;
      ++agreeing;
    }
    if (agreeing < 2)
      continue;
    people.push_back({.place_in_robot = sum / agreeing,
                      .sigma_range = 0.08 + bands.uncertainty * far * far,
                      .sigma_across = 0.05 + 0.01 * far,
                      .width = width / agreeing,
                      .evidence = (agreeing == 3 ? 1.0 : 0.7) * (whole >= 2 ? 1.0 : 0.6)});
  }
  return people;
}

bool in_view(const Bands& bands, const Vec2& place_in_robot, const PeopleSettings& settings) {
  const Vec2 from_eye = place_in_robot - Vec2(bands.eye_forward, 0.0);
  const double front = from_eye.x() - settings.radius;
  if (front < settings.nearest || from_eye.x() > settings.farthest)
    return false;
  const double to_left = std::atan2(from_eye.y() - bands.eye_left, front);
  const double to_right = std::atan2(from_eye.y() + bands.eye_left, front);
  const double half = settings.narrowest / 2.0 / front;
  double least = kPi;
  double most = -kPi;
  int free = 0;
  int hidden = 0;
  for (const Band& band : bands.bands)
    for (const std::optional<Vec2>& point : band) {
      if (!point)
        continue;
      const double range = point->x() - bands.eye_forward;
      const double to = std::atan2(point->y() - bands.eye_left, range);
      least = std::min(least, to);
      most = std::max(most, to);
      if (std::abs(to - to_left) < half)
        (range < from_eye.x() - settings.apart ? hidden : free) += 1;
    }
  return to_left - half > least && to_right + half < most && hidden <= free;
}

}  // namespace saphira::vision
