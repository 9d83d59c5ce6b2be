#pragma once

#include <cstdint>
#include <vector>

#include "saphira/base/random.hpp"

namespace saphira::sim {

inline std::uint32_t hash(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  std::uint32_t h = a * 0x9E3779B1U + b * 0x85EBCA77U + c * 0xC2B2AE3DU;
  h ^= h >> 15U;
  h *= 0x2C1B3C6DU;
  return h ^ h >> 13U;
}

inline std::int32_t floor_of(double value) {
  const auto whole = static_cast<std::int32_t>(value);
  return whole - static_cast<std::int32_t>(value < whole);
}

/// The visible details of a texture for a pixel of a size: those of two pixels and more. Finer ones
/// are left out, since they would differ between the cameras.
struct Detail {
  double scale = 100.0;  ///< [1/m] of the finest: 1 cm, or its double, ...
  double fade = 1.0;     ///< its share
  std::uint32_t octave = 0;

  /// `pixel`: [m].
  static Detail of(double pixel);
};

/// A line of pixels: a grey of 0 to 255 each, and a texture on it. All are evaluated at once.
class Pixels {
 public:
  explicit Pixels(std::size_t count);

  void set(std::size_t at, double grey) {
    grey_[at] = grey;
    strength_[at] = 0.0;
  }
  /// `strength`: the texture is between plus and minus it; u, v: [m] on the surface; `seed`: which
  /// surface.
  void set(std::size_t at, double grey, double strength, double u, double v, std::uint32_t seed,
           const Detail& detail) {
    grey_[at] = grey;
    strength_[at] = strength;
    u_[at] = u * detail.scale;
    v_[at] = v * detail.scale;
    fade_[at] = detail.fade;
    seed_[at] = seed + detail.octave * 977U;
  }

  /// The values that a camera measures. Its noise is triangular, plus and minus `noise`.
  const std::vector<std::uint8_t>& expose(double gain, double noise, Random& random);

 private:
  std::vector<double> grey_, strength_, u_, v_, fade_;
  std::vector<std::uint32_t> seed_, draws_;
  std::vector<std::uint8_t> values_;
};

}  // namespace saphira::sim
