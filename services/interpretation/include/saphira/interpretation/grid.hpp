#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::interpretation {

struct GridSettings {
  double resolution = 0.05;       ///< [m] edge of a cell
  double window = 8.0;            ///< [m] cells farther from the robot, to any side, are dropped
  double beam = radians(15.0);    ///< half angle of the cone
  double range = 4.0;             ///< [m] beyond it nothing is detected: a(z) of the paper is 0
  double detection = 0.6;         ///< a(0)
  double noise = 0.01;            ///< [m] s(0)...
  double relative_noise = 0.015;  ///< ...plus this share of the range
  double false_echoes = 0.1;      ///< [1/m] density F of readings without an object
  /// The degree to which the rest of its arc explains an echo: 0, not at all (each cell by itself,
  /// as in the paper); 1, as if all cells of the arc were heard independently. Our own parameter,
  /// found by experiment: tests/bench/perception/README.md.
  double attribution = 0.15;
  double mirror = 0.4;         ///< probability that a surface is a mirror to a given direction
  double prior = 0.25;         ///< probability that a cell is occupied
  double move = 0.06;          ///< [m] a sonar that has moved less, and...
  double turn = radians(6.0);  ///< ...turned less, repeats itself
};

/// A tile's key: its corner is (column, row) * kTile * resolution.
struct TileKey {
  long column = 0;
  long row = 0;
  bool operator==(const TileKey&) const = default;
  bool operator<(const TileKey& other) const {
    return column != other.column ? column < other.column : row < other.row;
  }
};

/// An occupancy grid in the frame of its caller, in square tiles around the robot: MURIEL
/// (Konolige, "Improved occupancy grids for map building", Autonomous Robots 4, 1997). Evidence
/// counts once for each place of the sonar and is stored by the direction of view. No direction
/// alone can clear a cell, since its surface may be a mirror from there.
class Grid {
 public:
  static constexpr long kTile = 32;  ///< cells along a tile's edge
  static constexpr std::uint8_t kNeverSeen = 255;

  explicit Grid(const GridSettings& settings = {});

  /// A cycle begins with the robot at that place: drops distant cells. changed() and dropped()
  /// begin anew.
  void move_to(const Vec2& robot);
  /// A firing; nothing: no echo.
  void add(int sonar, const Pose& sonar_in_grid, std::optional<double> range);
  void clear();

  /// Probability of an obstacle; nothing where no beam has been.
  std::optional<double> probability(const Vec2& at) const;
  /// The cells of a tile by rows from the smallest y, in each from the smallest x: the probability
  /// times 200; kNeverSeen. Empty: no such tile.
  std::vector<std::uint8_t> cells(const TileKey& key) const;
  TileKey tile_of(const Vec2& at) const;
  /// All tiles, in order.
  std::vector<TileKey> tiles() const;
  /// In this cycle, in order.
  std::vector<TileKey> changed() const;
  const std::vector<TileKey>& dropped() const { return dropped_; }
  std::uint64_t updates() const { return updates_; }  ///< cells, since the beginning
  const GridSettings& settings() const { return settings_; }

  SAPHIRA_ARCHIVE(tiles_, cleared_, fired_, updates_)

 private:
  static constexpr int kBins = 12;  // of the direction of view
  static constexpr std::size_t kCells = static_cast<std::size_t>(kTile * kTile);
  struct Tile {
    // Evidence by direction, and the total: log odds in steps of kStep.
    std::array<std::array<std::int8_t, kBins>, kCells> bins{};
    std::array<std::int16_t, kCells> total{};
    std::array<bool, kCells> seen{};
    bool changed = false;

    template <class Archive>
    void archive(Archive& a) {
      a.bytes("bins", bins).bytes("total", total).bytes("seen", seen);
    }
  };
  struct Arc {
    Tile* tile = nullptr;
    std::size_t cell = 0;
    int bin = 0;
    float density = 0.0F;  // of the reading, if the cell were occupied [1/m]
    float before = 1.0F;   // probability that no other cell gave the echo before
    float odds = 0.0F;
  };
  struct Fired {
    bool before = false;
    Pose pose;
  };
  /// Calls f(tile, number of the row's first cell in it, values of the row, first cell with
  /// evidence, number of cells) for each row of a tile that a cone meets. `spread`: [m] error of
  /// the echo.
  template <class F>
  void for_cone(const Pose& sonar, double range, double echo, double spread, F&& f);
  void weigh(const Pose& sonar, std::optional<double> range);
  int weighed(int said) const;
  /// Steps of evidence against a cell from where a beam, with this probability, would have had an
  /// echo: rounded logarithms, from tables.
  int free_steps(float detection) const;
  void evidence(Tile& tile, std::size_t cell, int bin, int steps);
  double probability(const Tile& tile, std::size_t cell) const;

  GridSettings settings_;
  static constexpr int kMostTotal = 128 * kBins;
  std::array<std::int16_t, 256> weighed_{};  // a bin's log odds, by its evidence
  std::vector<double> probabilities_;        // by total log odds from -kMostTotal on
  std::vector<std::uint8_t> bytes_;          // the same times 200
  struct FreeSteps {
    float limit;  // of the probability; from it on one step more
    std::uint8_t steps;
  };
  std::vector<FreeSteps> free_steps_;  // by probability in parts of kFine
  double prior_ = 0.0;
  std::map<TileKey, Tile> tiles_;
  std::vector<TileKey> dropped_;
  std::vector<TileKey> cleared_;  // reported with the next cycle
  std::vector<Fired> fired_;      // by sonar
  std::vector<Arc> arc_;
  std::vector<std::pair<long, long>> spans_;  // of the columns of a cone, by row
  std::uint64_t updates_ = 0;
};

}  // namespace saphira::interpretation
