#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "saphira/base/random.hpp"
#include "saphira/logs/scan_matching.hpp"

namespace saphira::logs::test {

struct Piece {
  Vec2 from;
  Vec2 to;
};

/// A room of 8 by 5 m with a cupboard, and a corridor of 2 m around a block beside it.
inline const std::vector<Piece>& pieces() {
  static const std::vector<Piece> kPieces{// The room, with a door of 1 m in its right wall.
                                          {{0.0, 0.0}, {8.0, 0.0}},
                                          {{0.0, 5.0}, {8.0, 5.0}},
                                          {{0.0, 0.0}, {0.0, 5.0}},
                                          {{8.0, 0.0}, {8.0, 2.0}},
                                          {{8.0, 3.0}, {8.0, 5.0}},
                                          {{5.0, 5.0}, {5.0, 4.0}},
                                          {{5.0, 4.0}, {6.0, 4.0}},
                                          {{6.0, 4.0}, {6.0, 5.0}},
                                          // The corridors: outer sides, and the block.
                                          {{8.0, -6.0}, {8.0, 0.0}},
                                          {{8.0, 5.0}, {8.0, 8.0}},
                                          {{8.0, 8.0}, {26.0, 8.0}},
                                          {{26.0, 8.0}, {26.0, -6.0}},
                                          {{26.0, -6.0}, {8.0, -6.0}},
                                          {{10.0, -4.0}, {24.0, -4.0}},
                                          {{24.0, -4.0}, {24.0, 6.0}},
                                          {{24.0, 6.0}, {10.0, 6.0}},
                                          {{10.0, 6.0}, {10.0, -4.0}},
                                          // Objects in the corridors.
                                          {{13.0, -6.0}, {13.0, -5.6}},
                                          {{13.0, -5.6}, {13.6, -5.6}},
                                          {{13.6, -5.6}, {13.6, -6.0}},
                                          {{20.0, 8.0}, {20.0, 7.5}},
                                          {{20.0, 7.5}, {20.5, 7.5}},
                                          {{20.5, 7.5}, {20.5, 8.0}},
                                          {{26.0, 1.0}, {25.6, 1.0}},
                                          {{25.6, 1.0}, {25.6, 2.2}},
                                          {{25.6, 2.2}, {26.0, 2.2}}};
  return kPieces;
}

inline double range_to(const Vec2& origin, double angle, const std::vector<Piece>& among) {
  const Vec2 ahead(std::cos(angle), std::sin(angle));
  double nearest = std::numeric_limits<double>::infinity();
  for (const Piece& piece : among) {
    const Vec2 along = piece.to - piece.from;
    const double cross = ahead.x() * along.y() - ahead.y() * along.x();
    if (std::abs(cross) < 1e-12)
      continue;
    const Vec2 off = piece.from - origin;
    const double range = (off.x() * along.y() - off.y() * along.x()) / cross;
    const double share = (off.x() * ahead.y() - off.y() * ahead.x()) / cross;
    if (range > 0.0 && share >= 0.0 && share <= 1.0)
      nearest = std::min(nearest, range);
  }
  return nearest;
}

/// 181 beams from a pose of the robot there, exact or with noise.
inline Scan scan_from(const Pose& pose, Random* random = nullptr,
                      const std::vector<Piece>& among = pieces()) {
  std::vector<double> ranges;
  const Beams beams;
  for (int i = 0; i <= 180; ++i)
    ranges.push_back(
        range_to(pose.position(), pose.th + beams.first_angle + i * beams.step, among) +
        (random != nullptr ? random->normal(0.0, 0.01) : 0.0));
  return make_scan(ranges, beams);
}

}  // namespace saphira::logs::test
