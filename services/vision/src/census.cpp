#include "saphira/vision/census.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

#include "saphira/base/wide.hpp"

namespace saphira::vision {
namespace {

// 24 of the 7 x 7 neighbours, in three times eight: as good as all 48 at half the cost.
constexpr int kReach = 3;
constexpr std::size_t kPlanes = 3;
constexpr std::array<std::array<std::array<int, 2>, 8>, kPlanes> kNeighbours{{
    {{{-3, -3}, {-1, -3}, {1, -3}, {3, -3}, {-2, -2}, {0, -2}, {2, -2}, {-3, -1}}},
    {{{-1, -1}, {1, -1}, {3, -1}, {-2, 0}, {2, 0}, {-3, 1}, {-1, 1}, {1, 1}}},
    {{{3, 1}, {-2, 2}, {0, 2}, {2, 2}, {-3, 3}, {-1, 3}, {1, 3}, {3, 3}}},
}};
constexpr double kBits = 8.0 * kPlanes;
constexpr std::int16_t kWorst = std::numeric_limits<std::int16_t>::max();

// The loops below are functions of their own: the compiler takes many elements at a time only where
// it is told that the arrays do not overlap.

// For each pixel a byte with a bit for each of eight neighbours: 1 where the neighbour is darker.
SAPHIRA_WIDE void compare(int count, const std::uint8_t* __restrict middle,
                          const std::array<const std::uint8_t*, 8>& others,
                          std::uint8_t* __restrict out) {
  const auto [a, b, c, d, e, f, g, h] = others;
  for (int i = 0; i < count; ++i) {
    const std::uint8_t here = middle[i];
    out[i] = static_cast<std::uint8_t>((a[i] < here ? 128 : 0) | (b[i] < here ? 64 : 0) |
                                       (c[i] < here ? 32 : 0) | (d[i] < here ? 16 : 0) |
                                       (e[i] < here ? 8 : 0) | (f[i] < here ? 4 : 0) |
                                       (g[i] < here ? 2 : 0) | (h[i] < here ? 1 : 0));
  }
}

// Adds the number of bits that differ.
SAPHIRA_WIDE void add_differences(int count, const std::uint8_t* __restrict a,
                                  const std::uint8_t* __restrict b, std::uint8_t* __restrict out) {
  for (int i = 0; i < count; ++i) {
    const auto bits = static_cast<std::uint8_t>(a[i] ^ b[i]);
    const auto pairs = static_cast<std::uint8_t>(bits - (bits >> 1U & 0x55U));
    const auto fours = static_cast<std::uint8_t>((pairs & 0x33U) + (pairs >> 2U & 0x33U));
    out[i] = static_cast<std::uint8_t>(out[i] + ((fours + (fours >> 4U)) & 0x0FU));
  }
}

SAPHIRA_WIDE void add(int count, const std::uint8_t* __restrict each,
                      std::int16_t* __restrict sums) {
  for (int i = 0; i < count; ++i)
    sums[i] = static_cast<std::int16_t>(sums[i] + each[i]);
}

SAPHIRA_WIDE void subtract(int count, const std::uint8_t* __restrict each,
                           std::int16_t* __restrict sums) {
  for (int i = 0; i < count; ++i)
    sums[i] = static_cast<std::int16_t>(sums[i] - each[i]);
}

// Sums over a window of each element and `half` on both sides of it.
SAPHIRA_WIDE void sum_across(int count, int half, const std::int16_t* __restrict sums,
                             std::int16_t* __restrict out) {
  std::copy_n(sums, count, out);
  for (int offset = 1; offset <= half; ++offset)
    for (int i = 0; i < count; ++i)
      out[i] = static_cast<std::int16_t>(out[i] + sums[i - offset] + sums[i + offset]);
}

SAPHIRA_WIDE void keep_best(int count, std::int16_t disparity, const std::int16_t* __restrict cost,
                            std::int16_t* __restrict best, std::int16_t* __restrict at) {
  for (int i = 0; i < count; ++i) {
    const bool better = cost[i] < best[i];
    at[i] = better ? disparity : at[i];
    best[i] = better ? cost[i] : best[i];
  }
}

// The costs of the disparities before and after the best one. To be called before `best` and `at`
// have been brought up to date with `cost`.
SAPHIRA_WIDE void keep_beside(int count, std::int16_t disparity,
                              const std::int16_t* __restrict cost,
                              const std::int16_t* __restrict best,
                              const std::int16_t* __restrict at, std::int16_t* __restrict before,
                              std::int16_t* __restrict after, std::int16_t* __restrict last) {
  const auto previous = static_cast<std::int16_t>(disparity - 1);
  for (int i = 0; i < count; ++i) {
    const bool better = cost[i] < best[i];
    const std::int16_t next = at[i] == previous ? cost[i] : after[i];
    after[i] = better ? kWorst : next;
    before[i] = better ? last[i] : before[i];
    last[i] = cost[i];
  }
}

}  // namespace

void Census::compare_row(const ImageView& image, int row, std::uint8_t* out) const {
  const int count = columns_ - 2 * kReach;
  for (const auto& plane : kNeighbours) {
    std::array<const std::uint8_t*, 8> others{};
    for (std::size_t i = 0; i < others.size(); ++i)
      others[i] = image.row(row + plane[i][1]) + plane[i][0] + kReach;
    compare(count, image.row(row) + kReach, others, out + kReach);
    out += columns_;
  }
}

// Replaces the oldest row of the window.
void Census::take_row(const ImageView& left, const ImageView& right, int row) {
  compare_row(left, row, left_.data());
  compare_row(right, row, right_.data());
  const auto columns = static_cast<std::size_t>(columns_);
  const auto window = static_cast<std::size_t>(2 * settings_.half_window + 1);
  const auto disparities = static_cast<std::size_t>(settings_.most) + 1;
  std::uint8_t* const counts =
      counts_.data() + static_cast<std::size_t>(row) % window * disparities * columns;
  for (std::size_t disparity = 0; disparity < std::min(disparities, columns); ++disparity) {
    const std::size_t start = disparity * columns + disparity;
    const auto count = static_cast<int>(columns - disparity);
    subtract(count, counts + start, sums_.data() + start);
    std::fill_n(counts + start, count, std::uint8_t{0});
    for (std::size_t plane = 0; plane < kPlanes; ++plane)
      add_differences(count, left_.data() + plane * columns + disparity,
                      right_.data() + plane * columns, counts + start);
    add(count, counts + start, sums_.data() + start);
  }
}

void Census::match_row(float* out) {
  const int half = settings_.half_window;
  std::fill(best_cost_.begin(), best_cost_.end(), kWorst);
  std::fill(right_cost_.begin(), right_cost_.end(), kWorst);
  std::fill(last_.begin(), last_.end(), kWorst);
  for (int disparity = 0; disparity <= settings_.most; ++disparity) {
    const int first = disparity + half + kReach;
    const int count = columns_ - half - kReach - first;
    if (count <= 0)
      break;
    const auto now = static_cast<std::int16_t>(disparity);
    sum_across(count, half,
               sums_.data() + static_cast<std::ptrdiff_t>(disparity) * columns_ + first,
               cost_.data());
    keep_beside(count, now, cost_.data(), best_cost_.data() + first, best_at_.data() + first,
                before_.data() + first, after_.data() + first, last_.data() + first);
    keep_best(count, now, cost_.data(), best_cost_.data() + first, best_at_.data() + first);
    keep_best(count, now, cost_.data(), right_cost_.data() + first - disparity,
              right_at_.data() + first - disparity);
  }
  const int side = 2 * half + 1;
  const auto most = static_cast<std::int16_t>(settings_.worst * side * side * kBits);
  for (int column = 0; column < columns_; ++column) {
    const auto i = static_cast<std::size_t>(column);
    out[column] = -1.0F;
    if (best_cost_[i] > most || best_at_[i] == 0)
      continue;
    const int other = column - best_at_[i];
    if (other < 0 || std::abs(right_at_[static_cast<std::size_t>(other)] - best_at_[i]) > 1)
      continue;
    float fraction = 0.0F;
    if (before_[i] != kWorst && after_[i] != kWorst) {
      const float bend = static_cast<float>(before_[i]) + static_cast<float>(after_[i]) -
                         2.0F * static_cast<float>(best_cost_[i]);
      if (bend > 0.0F)
        fraction = std::clamp(
            0.5F * (static_cast<float>(before_[i]) - static_cast<float>(after_[i])) / bend, -0.5F,
            0.5F);
    }
    out[column] = static_cast<float>(best_at_[i]) + fraction;
  }
}

const DisparityMap& Census::match(const ImageView& left, const ImageView& right, int first_row,
                                  int last_row) {
  const int half = settings_.half_window;
  columns_ = left.columns;
  first_row = std::max(first_row, half + kReach);
  last_row = std::min({last_row, left.rows - half - kReach, right.rows - half - kReach});
  map_.columns = columns_;
  map_.first_row = first_row;
  map_.rows = std::max(0, last_row - first_row);
  const auto columns = static_cast<std::size_t>(columns_);
  map_.disparities.assign(columns * static_cast<std::size_t>(map_.rows), -1.0F);
  if (map_.rows == 0 || right.columns != left.columns)
    return map_;
  const auto disparities = static_cast<std::size_t>(settings_.most) + 1;
  left_.assign(kPlanes * columns, 0);
  right_.assign(kPlanes * columns, 0);
  counts_.assign(static_cast<std::size_t>(2 * half + 1) * disparities * columns, 0);
  sums_.assign(disparities * columns, 0);
  for (auto* const each :
       {&cost_, &best_cost_, &best_at_, &before_, &after_, &last_, &right_cost_, &right_at_})
    each->assign(columns, 0);
  for (int row = first_row - half; row < last_row + half; ++row) {
    take_row(left, right, row);
    if (row >= first_row + half)
      match_row(map_.disparities.data() +
                static_cast<std::size_t>(row - half - first_row) * columns);
  }
  return map_;
}

}  // namespace saphira::vision
