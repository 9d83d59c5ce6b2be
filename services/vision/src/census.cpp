#include "saphira/vision/census.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

// A function that is compiled twice, and whose faster form is taken where the processor has it. The
// arithmetic is the same to the bit.
#if defined(__x86_64__) && defined(__OPTIMIZE__) && !defined(__clang__)
#define SAPHIRA_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define SAPHIRA_WIDE
#endif

namespace saphira::vision {
namespace {

// 24 of the 7 x 7 neighbours: as good as all 48 at half the cost, since 24 bits fit a word of which
// four are counted at a time.
constexpr int kReach = 3;
constexpr std::array<std::array<int, 2>, 24> kNeighbours{{
    {-3, -3}, {-1, -3}, {1, -3}, {3, -3}, {-2, -2}, {0, -2}, {2, -2}, {-3, -1},
    {-1, -1}, {1, -1},  {3, -1}, {-2, 0}, {2, 0},   {-3, 1}, {-1, 1}, {1, 1},
    {3, 1},   {-2, 2},  {0, 2},  {2, 2},  {-3, 3},  {-1, 3}, {1, 3},  {3, 3},
}};
constexpr std::int16_t kWorst = std::numeric_limits<std::int16_t>::max();

SAPHIRA_WIDE void census_row(const ImageView& image, int row, std::uint32_t* words) {
  std::fill(words, words + image.columns, 0U);
  const std::uint8_t* const middle = image.row(row);
  for (const auto& [dx, dy] : kNeighbours) {
    const std::uint8_t* const other = image.row(row + dy) + dx;
    for (int column = kReach; column < image.columns - kReach; ++column)
      words[column] = words[column] << 1U | (other[column] < middle[column] ? 1U : 0U);
  }
}

}  // namespace

// For one row of words, for each disparity and column.
SAPHIRA_WIDE void Census::add_differences(const Words& left, const Words& right, int row,
                                          bool add) {
  const std::size_t start = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
  const std::int16_t sign = add ? 1 : -1;
  for (int disparity = 0; disparity <= settings_.most; ++disparity) {
    const std::uint32_t* const a = left.data() + start;
    const std::uint32_t* const b = right.data() + start;
    std::int16_t* const sums = sums_.data() + static_cast<std::ptrdiff_t>(disparity) * columns_;
    for (int column = disparity; column < columns_; ++column) {
      std::uint32_t bits = a[column] ^ b[column - disparity];
      bits -= bits >> 1U & 0x55555555U;
      bits = (bits & 0x33333333U) + (bits >> 2U & 0x33333333U);
      bits = (bits + (bits >> 4U)) & 0x0F0F0F0FU;
      bits += bits >> 8U;
      bits += bits >> 16U;
      const auto count = static_cast<std::int16_t>(bits & 0xFFU);
      sums[column] = static_cast<std::int16_t>(sums[column] + sign * count);
    }
  }
}

SAPHIRA_WIDE void Census::match_row(float* out) {
  const int half = settings_.half_window;
  std::fill(best_cost_.begin(), best_cost_.end(), kWorst);
  std::fill(right_cost_.begin(), right_cost_.end(), kWorst);
  std::fill(last_.begin(), last_.end(), kWorst);
  for (int disparity = 0; disparity <= settings_.most; ++disparity) {
    const std::int16_t* const sums =
        sums_.data() + static_cast<std::ptrdiff_t>(disparity) * columns_;
    const int first = disparity + half + kReach;
    const int end = columns_ - half - kReach;
    if (first >= end)
      break;
    std::int16_t* const cost = cost_.data();
    for (int column = first; column < end; ++column)
      cost[column] = sums[column - half];
    for (int offset = 1 - half; offset <= half; ++offset)
      for (int column = first; column < end; ++column)
        cost[column] = static_cast<std::int16_t>(cost[column] + sums[column + offset]);
    const auto now = static_cast<std::int16_t>(disparity);
    std::int16_t* const best = best_cost_.data();
    std::int16_t* const at = best_at_.data();
    std::int16_t* const before = before_.data();
    std::int16_t* const after = after_.data();
    std::int16_t* const last = last_.data();
    for (int column = first; column < end; ++column) {
      const std::int16_t value = cost[column];
      const bool better = value < best[column];
      const bool follows = at[column] == now - 1;
      after[column] = better ? kWorst : follows ? value : after[column];
      before[column] = better ? last[column] : before[column];
      at[column] = better ? now : at[column];
      best[column] = better ? value : best[column];
      last[column] = value;
    }
    std::int16_t* const right_best = right_cost_.data() + first - disparity;
    std::int16_t* const right_at = right_at_.data() + first - disparity;
    const std::int16_t* const from = cost + first;
    for (int i = 0; i < end - first; ++i) {
      const bool better = from[i] < right_best[i];
      right_at[i] = better ? now : right_at[i];
      right_best[i] = better ? from[i] : right_best[i];
    }
  }
  const int side = 2 * half + 1;
  const auto most = static_cast<std::int16_t>(settings_.worst * side * side *
                                              static_cast<double>(kNeighbours.size()));
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
  left_.resize(columns * static_cast<std::size_t>(left.rows));
  right_.resize(left_.size());
  sums_.assign(disparities * columns, 0);
  for (auto* const each :
       {&cost_, &best_cost_, &best_at_, &before_, &after_, &last_, &right_cost_, &right_at_})
    each->assign(columns, 0);
  const auto take = [&](int row) {
    census_row(left, row, left_.data() + static_cast<std::size_t>(row) * columns);
    census_row(right, row, right_.data() + static_cast<std::size_t>(row) * columns);
    add_differences(left_, right_, row, true);
  };
  for (int row = first_row - half; row < first_row + half; ++row)
    take(row);
  for (int row = first_row; row < last_row; ++row) {
    take(row + half);
    match_row(map_.disparities.data() + static_cast<std::size_t>(row - first_row) * columns);
    add_differences(left_, right_, row - half, false);
  }
  return map_;
}

}  // namespace saphira::vision
