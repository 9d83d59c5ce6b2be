#include "saphira/interpretation/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saphira/base/wide.hpp"
#include "saphira/geometry/cone.hpp"

namespace saphira::interpretation {
namespace {

/// Evidence and log odds are counted in steps of this.
constexpr double kStep = 0.04;
constexpr int kMost = 120;
constexpr int kHalf = 128;
constexpr int kFine = 256;  // of a probability
constexpr int kLanes = 4;   // cells that are looked at at once

double logit(double probability) {
  return std::log(probability / (1.0 - probability));
}

/// A beam, and what it says of the cells of a row of a tile.
struct Beam {
  double heading;
  double cosine;
  double sine;
  double edge;       // tangent of half the opening angle
  double range;      // [m] that counts
  double far;        // [m] beyond it nothing is detected
  double detection;  // at no distance
  double echo;       // [m] infinite: none
  double spread;     // [m] error of the echo
};
static_assert(Grid::kTile % kLanes == 0, "look() fills whole steps of a row");
struct Row {
  std::array<double, Grid::kTile> behind;  // errors from the cell to the echo
  std::array<double, Grid::kTile> found;   // probability of an echo of the cell; -1: outside
  std::array<std::int32_t, Grid::kTile> bin;
};

/// The first cell is at dx, dy from the sonar, in cells of `size`.
SAPHIRA_WIDE void look(const Beam& beam, double column, double size, double x, double dy, int bins,
                       int count, Row& row) {
  const auto [heading, c, s, edge, range, far, detection, echo, spread] = beam;
  const double by_angle = bins / (2.0 * kPi);
  // Some cells more, for whole steps: nobody reads them.
  const int whole = (count + kLanes - 1) / kLanes * kLanes;
  for (int i = 0; i < whole; ++i) {
    const double dx = (column + i + 0.5) * size - x;
    const double along = c * dx + s * dy;
    const double across = -s * dx + c * dy;
    const double z = std::sqrt(dx * dx + dy * dy);
    const bool inside = (along > 0.0) & (std::abs(across) <= edge * along) & (z <= range);
    const double tangent = inside ? across / along : 0.0;
    const double off = 1.0 - tangent * tangent / (edge * edge);
    const double bearing = heading + tangent * (1.0 - tangent * tangent / 3.0);
    row.behind[i] = (echo - z) / spread;
    row.found[i] = inside ? detection * (1.0 - z / far) * off * off : -1.0;
    row.bin[i] = std::min(bins - 1, static_cast<int>(norm_angle(bearing) * by_angle));
  }
}

}  // namespace

Grid::Grid(const GridSettings& settings) : settings_(settings), prior_(logit(settings.prior)) {
  // With the probability `mirror` the surface of an occupied cell reflects the sound away, and the
  // readings from this direction give no evidence.
  const double q = settings_.mirror;
  int evidence = -kHalf;
  for (std::int16_t& weighed : weighed_) {
    const double said = std::log(q + (1.0 - q) * std::exp(kStep * evidence));
    weighed = static_cast<std::int16_t>(std::lround(said / kStep));
    ++evidence;
  }
  for (int total = -kMostTotal; total <= kMostTotal; ++total)
    probabilities_.push_back(1.0 / (1.0 + std::exp(-prior_ - kStep * total)));
  for (const double probability : probabilities_)
    bytes_.push_back(static_cast<std::uint8_t>(std::lround(200.0 * probability)));
  for (int steps = 0; steps < kMost; ++steps)
    detections_.push_back(1.0 - std::exp(-kStep * (steps + 0.5)));
  detections_.push_back(std::numeric_limits<double>::infinity());
  for (int i = 0; i <= kFine; ++i)
    least_steps_.push_back(static_cast<int>(
        std::upper_bound(detections_.begin(), detections_.end(), static_cast<double>(i) / kFine) -
        detections_.begin()));
}

int Grid::free_steps(double detection) const {
  int steps = least_steps_[static_cast<std::size_t>(static_cast<int>(detection * kFine))];
  while (detection >= detections_[static_cast<std::size_t>(steps)])
    ++steps;
  return steps;
}

int Grid::weighed(int said) const {
  const int index = said + kHalf;
  return weighed_[static_cast<std::size_t>(index)];
}

void Grid::clear() {
  for (const auto& [key, tile] : tiles_)
    cleared_.push_back(key);
  tiles_.clear();
  fired_.clear();
}

void Grid::move_to(const Vec2& robot) {
  dropped_.swap(cleared_);
  cleared_.clear();
  const double edge = kTile * settings_.resolution;
  for (auto it = tiles_.begin(); it != tiles_.end();) {
    it->second.changed = false;
    const Vec2 middle((static_cast<double>(it->first.column) + 0.5) * edge,
                      (static_cast<double>(it->first.row) + 0.5) * edge);
    if ((middle - robot).cwiseAbs().maxCoeff() > settings_.window + edge / 2.0) {
      dropped_.push_back(it->first);
      it = tiles_.erase(it);
    } else {
      ++it;
    }
  }
}

TileKey Grid::tile_of(const Vec2& at) const {
  const double edge = kTile * settings_.resolution;
  return {static_cast<long>(std::floor(at.x() / edge)),
          static_cast<long>(std::floor(at.y() / edge))};
}

std::vector<TileKey> Grid::tiles() const {
  std::vector<TileKey> keys;
  for (const auto& [key, tile] : tiles_)
    keys.push_back(key);
  return keys;
}

std::vector<TileKey> Grid::changed() const {
  std::vector<TileKey> keys;
  for (const auto& [key, tile] : tiles_)
    if (tile.changed)
      keys.push_back(key);
  return keys;
}

double Grid::probability(const Tile& tile, std::size_t cell) const {
  return probabilities_[static_cast<std::size_t>(tile.total[cell] + kMostTotal)];
}

std::optional<double> Grid::probability(const Vec2& at) const {
  const auto it = tiles_.find(tile_of(at));
  if (it == tiles_.end())
    return std::nullopt;
  const auto within = [&](double v, long tile) {
    return std::clamp(static_cast<long>(std::floor(v / settings_.resolution)) - tile * kTile, 0L,
                      kTile - 1);
  };
  const auto cell = static_cast<std::size_t>(within(at.y(), it->first.row) * kTile +
                                             within(at.x(), it->first.column));
  if (!it->second.seen[cell])
    return std::nullopt;
  return probability(it->second, cell);
}

std::vector<std::uint8_t> Grid::cells(const TileKey& key) const {
  const auto it = tiles_.find(key);
  if (it == tiles_.end())
    return {};
  std::vector<std::uint8_t> cells(kCells, kNeverSeen);
  const Tile& tile = it->second;
  const std::uint8_t* const bytes = bytes_.data() + kMostTotal;
  for (std::size_t cell = 0; cell < kCells; ++cell)
    if (tile.seen[cell])
      cells[cell] = bytes[tile.total[cell]];
  return cells;
}

void Grid::add(int sonar, const Pose& sonar_in_grid, std::optional<double> range) {
  if (sonar < 0)
    return;
  const auto number = static_cast<std::size_t>(sonar);
  if (number >= fired_.size())
    fired_.resize(number + 1);
  Fired& fired = fired_[number];
  if (fired.before && (fired.pose.position() - sonar_in_grid.position()).norm() < settings_.move &&
      std::abs(norm2_angle(fired.pose.th - sonar_in_grid.th)) < settings_.turn)
    return;
  fired = {true, sonar_in_grid};
  weigh(sonar_in_grid, range);
}

template <class F>
void Grid::for_cone(const Pose& sonar, double range, double echo, double spread, F&& f) {
  const double size = settings_.resolution;
  const double edge = std::tan(settings_.beam);
  const ConeRows cone(sonar, edge, range);
  const Beam beam{sonar.th,        cone.cosine(),       cone.sine(), edge,  range,
                  settings_.range, settings_.detection, echo,        spread};
  const auto cell_of = [size](double v) { return static_cast<long>(std::floor(v / size)); };
  const auto tile_at = [](long cell) {
    return cell >= 0 ? cell / kTile : -((-cell + kTile - 1) / kTile);
  };
  const auto distance = [&](long row) { return (static_cast<double>(row) + 0.5) * size - sonar.y; };
  const long first_row = cell_of(sonar.y + cone.rows().first);
  const long last_row = cell_of(sonar.y + cone.rows().second);
  const long first_column = cell_of(sonar.x + cone.columns().first);
  const long last_column = cell_of(sonar.x + cone.columns().second);
  spans_.clear();
  for (long row = first_row; row <= last_row; ++row) {
    // The cells with their middles in the cone, and a tenth of a cell against rounding.
    const auto [low, high] = cone.span(distance(row));
    spans_.emplace_back(std::max(first_column, cell_of(sonar.x + low + 0.4 * size)),
                        std::min(last_column, cell_of(sonar.x + high - 0.4 * size)));
  }
  Row seen;
  for (long tile_row = tile_at(first_row); tile_row <= tile_at(last_row); ++tile_row)
    for (long tile_column = tile_at(first_column); tile_column <= tile_at(last_column);
         ++tile_column) {
      const long row0 = tile_row * kTile;
      const long column0 = tile_column * kTile;
      Tile* tile = nullptr;
      for (long row = std::max(row0, first_row); row <= std::min(row0 + kTile - 1, last_row);
           ++row) {
        const auto& span = spans_[static_cast<std::size_t>(row - first_row)];
        const long begin = std::max(column0, span.first);
        const long count = std::min(column0 + kTile - 1, span.second) - begin + 1;
        if (count <= 0)
          continue;
        look(beam, static_cast<double>(begin), size, sonar.x, distance(row), kBins,
             static_cast<int>(count), seen);
        const auto cells = static_cast<std::size_t>(count);
        std::size_t first = 0;
        while (first < cells && seen.found[first] <= 0.0)
          ++first;
        if (first == cells)
          continue;
        if (!tile)
          tile = &tiles_[{tile_column, tile_row}];
        f(*tile, static_cast<std::size_t>((row - row0) * kTile + begin - column0), seen, first,
          cells);
      }
    }
}

void Grid::evidence(Tile& tile, std::size_t cell, int bin, int steps) {
  std::int8_t& said = tile.bins[cell][static_cast<std::size_t>(bin)];
  const auto before = static_cast<int>(said);  // NOLINT(bugprone-signed-char-misuse): a number
  const int after = std::clamp(before + steps, -kMost, kMost);
  tile.seen[cell] = true;
  if (after == before)
    return;
  said = static_cast<std::int8_t>(after);
  tile.total[cell] = static_cast<std::int16_t>(tile.total[cell] + weighed(after) - weighed(before));
}

void Grid::weigh(const Pose& sonar, std::optional<double> range) {
  const double far = settings_.range;
  // Beyond three deviations behind the echo there is no evidence.
  const double deviation =
      range ? settings_.noise + settings_.relative_noise * *range : settings_.noise;
  const double half_cell = settings_.resolution / 2.0;
  const double spread = std::hypot(deviation, half_cell);
  const double reach = range ? std::min(far, *range + 3.0 * spread) : far;
  arc_.clear();
  double sum = 0.0;
  std::uint64_t updates = 0;
  const double echo = range.value_or(std::numeric_limits<double>::infinity());
  const auto take = [&](Tile& tile, std::size_t cell0, const Row& row, std::size_t i,
                        std::size_t end) {
    tile.changed = true;
    for (; i < end; ++i) {
      const double found = row.found[i];
      if (found <= 0.0)
        continue;
      ++updates;
      const std::size_t cell = cell0 + i;
      const int bin = row.bin[i];
      const double behind = row.behind[i];
      if (behind > 3.0) {
        evidence(tile, cell, bin, -free_steps(found));
        continue;
      }
      Arc arc{&tile, cell, bin, 0.0, 1.0, 0.0};
      arc.density = found / (std::sqrt(2.0 * kPi) * spread) * std::exp(-behind * behind / 2.0);
      arc.before = 1.0 - found / (1.0 + std::exp(-1.7 * behind));
      arc.odds = probability(tile, cell);
      sum += arc.odds * arc.density;
      arc_.push_back(arc);
    }
  };
  for_cone(sonar, reach, echo, spread, take);
  updates_ += updates;
  // The echo came from somewhere on the arc: the beliefs in the rest of it explain it as well.
  for (const Arc& arc : arc_) {
    const double rest =
        settings_.false_echoes + settings_.attribution * (sum - arc.odds * arc.density);
    const double odds = std::log(arc.before * arc.density / rest + arc.before);
    evidence(*arc.tile, arc.cell, arc.bin, static_cast<int>(std::lround(odds / kStep)));
  }
}

}  // namespace saphira::interpretation
