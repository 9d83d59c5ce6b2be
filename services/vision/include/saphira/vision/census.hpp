#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/vision/picture.hpp"

namespace saphira::vision {

struct CensusSettings {
  int most = 64;        ///< [pixels] of disparity: nearer objects are not matched
  int half_window = 4;  ///< [pixels] the costs of 9 x 9 pixels are summed
  double worst = 0.3;   ///< [0..1] of the bits may differ in a match
};

/// Disparities of the left picture, of rows `first_row` on.
struct DisparityMap {
  int columns = 0;
  int first_row = 0;
  int rows = 0;
  std::vector<float> disparities;  ///< [pixels] below 0: none

  std::optional<double> at(int column, int row) const {
    const float value =
        disparities[static_cast<std::size_t>(row - first_row) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(column)];
    return value < 0.0F ? std::nullopt : std::optional(static_cast<double>(value));
  }
};

/// Ranges by the census of Zabih and Woodfill, as Flakey's (paper 2.1). A pixel becomes a word with
/// a bit for each darker neighbour; words are compared by the number of different bits, summed over
/// a window. A match that differs from right to left is dropped; a parabola through the costs gives
/// fractions of a pixel.
class Census {
 public:
  explicit Census(const CensusSettings& settings = {}) : settings_(settings) {}

  /// Of the rows from `first_row` to before `last_row`, as far as the window lies in the pictures.
  const DisparityMap& match(const ImageView& left, const ImageView& right, int first_row,
                            int last_row);

 private:
  void compare_row(const ImageView& image, int row, std::uint8_t* out) const;
  void take_row(const ImageView& left, const ImageView& right, int row);
  void match_row(float* out);

  CensusSettings settings_;
  DisparityMap map_;
  int columns_ = 0;
  // [eight neighbours each][column]
  std::vector<std::uint8_t> left_, right_;
  // [disparity][column of the left picture]
  std::vector<std::uint8_t> counts_;  ///< of different bits, for each of the window's rows
  std::vector<std::int16_t> sums_;    ///< of them over the window's rows
  std::vector<std::int16_t> cost_;
  std::vector<std::int16_t> best_cost_, best_at_, before_, after_, last_;
  std::vector<std::int16_t> right_cost_, right_at_;
};

}  // namespace saphira::vision
