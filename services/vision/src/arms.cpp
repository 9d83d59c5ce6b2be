#include "saphira/vision/arms.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "median.hpp"

namespace saphira::vision {
namespace {

// Below an arm, at these heights, is what is behind it.
constexpr double kBelowLow = 0.90;    // [m]
constexpr double kBelowHigh = 1.10;   // [m]
constexpr double kBelowMost = 0.04;   // [m] of it may match as near as the person
constexpr double kBeginSlack = 0.10;  // [m] from the torso to the first part that matches
constexpr double kSigmaOfArm = 0.3;   // [pixels] of a disparity
constexpr std::size_t kFewest = 5;    // columns of an arm

// A part of the scene beside a person, at the person's range, in one column of the picture.
struct Slice {
  double across = 0.0;  // [m] from the person's middle, to the left
  double along = 0.0;   // [m] behind the person's middle
  bool arm = false;     // a bar with nothing below it; otherwise an object, or a part of the torso
};

class Beside {
 public:
  Beside(const Sight& person, const DisparityMap& map, const Rig& rig, int rows,
         const ArmSettings& settings)
      : map_(map), rig_(rig), rows_(rows), settings_(settings) {
    from_eye_ = person.place_in_robot - Vec2(rig.forward, rig.baseline / 2.0);
    sight_ = from_eye_.normalized();
    aside_ = Vec2(-sight_.y(), sight_.x());
    slack_ = 2.0 * kSigmaOfArm / (rig.focal * rig.baseline) * from_eye_.squaredNorm();
  }

  std::optional<double> direction() {
    const std::optional<Vec2> left = arm(1.0);
    const std::optional<Vec2> right = arm(-1.0);
    if (left.has_value() == right.has_value())
      return std::nullopt;
    const Vec2 way = left ? *left : *right;
    return std::atan2(way.y(), way.x());
  }

 private:
  // From the person's middle to the middle of the arm on a side, left: 1, right: -1.
  std::optional<Vec2> arm(double side) {
    std::vector<double> across;
    std::vector<double> along;
    double end = settings_.begin;
    for (int column = column_at(side * settings_.begin);
         column >= 0 && column<map_.columns; column += side> 0.0 ? -1 : 1) {
      const std::optional<Slice> slice = slice_of(column);
      if (!slice)
        continue;
      const double out = side * slice->across;
      if (out < settings_.begin)
        continue;
      if (out - end > (across.empty() ? kBeginSlack : settings_.gap))
        break;
      if (!slice->arm) {
        if (end < settings_.nearest)
          return std::nullopt;
        break;  // it reaches to a wall
      }
      end = out;
      if (end > settings_.farthest)
        return std::nullopt;
      across.push_back(slice->across);
      along.push_back(slice->along);
    }
    if (across.size() < kFewest || end < settings_.nearest)
      return std::nullopt;
    return Vec2(aside_ * median(across) + sight_ * median(along));
  }

  int column_at(double across) const {
    const Vec2 at = from_eye_ + aside_ * across;
    return at.x() <= 0.0
               ? -1
               : static_cast<int>(0.5 * map_.columns - rig_.focal * at.y() / at.x() - 0.5);
  }

  std::optional<Slice> slice_of(int column) {
    const double slope = -(column + 0.5 - 0.5 * map_.columns) / rig_.focal;
    bar_.clear();
    below_.clear();
    for (int row = map_.first_row; row < map_.first_row + map_.rows; ++row) {
      const auto disparity = map_.at(column, row);
      if (!disparity || *disparity < 0.5)
        continue;
      const double range = rig_.focal * rig_.baseline / *disparity;
      const double height = rig_.height + (0.5 * rows_ - row - 0.5) * range / rig_.focal;
      const Vec2 off = Vec2(range, slope * range) - from_eye_;
      if (std::abs(off.dot(sight_)) > settings_.reach)
        continue;
      if (height > kBelowLow && height < kBelowHigh)
        below_.push_back(off);
      else if (height > settings_.low && height < settings_.high)
        bar_.push_back(off);
    }
    const auto along = [&](const Vec2& off) { return off.dot(sight_); };
    const auto nearer = [&](const Vec2& a, const Vec2& b) { return along(a) < along(b); };
    std::sort(bar_.begin(), bar_.end(), nearer);
    const double pixel = from_eye_.norm() / rig_.focal;
    const auto fewest = static_cast<std::size_t>(settings_.thinnest / pixel) + 1;
    if (bar_.size() < fewest)
      return std::nullopt;
    // The nearest surface: a wall behind an arm is none of it.
    const Vec2 middle = bar_[fewest / 2];
    const double behind = along(middle) + settings_.deep + slack_;
    const auto near = [&](const Vec2& off) { return along(off) < behind; };
    const double thick = pixel * static_cast<double>(std::count_if(bar_.begin(), bar_.end(), near));
    const double below =
        pixel * static_cast<double>(std::count_if(below_.begin(), below_.end(), near));
    return Slice{middle.dot(aside_), along(middle),
                 thick >= settings_.thinnest && thick <= settings_.thickest && below <= kBelowMost};
  }

  const DisparityMap& map_;
  const Rig& rig_;
  int rows_;
  const ArmSettings& settings_;
  Vec2 from_eye_;       // of the left camera, to the person's middle
  Vec2 sight_;          // the line of sight
  Vec2 aside_;          // to its left
  double slack_ = 0.0;  // [m] two sigmas of a range there
  std::vector<Vec2> bar_, below_;
};

}  // namespace

std::optional<double> arm_of(const Sight& person, const DisparityMap& map, const Rig& rig, int rows,
                             const ArmSettings& settings) {
  return Beside(person, map, rig, rows, settings).direction();
}

}  // namespace saphira::vision
