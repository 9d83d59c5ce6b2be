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
// Parts of a probability: no part has more than one limit between two numbers of steps.
constexpr int kFine = 4096;
constexpr int kLanes = 8;  // cells that are looked at at once

double logit(double probability) {
  return std::log(probability / (1.0 - probability));
}

/// A beam, and what it says of the cells of a row of a tile.
struct Beam {
  float heading;  // in bins
  float cosine;
  float sine;
  float edge;       // tangent of half the opening angle
  float range;      // [m] that counts
  float far;        // [m] beyond it nothing is detected
  float detection;  // at no distance
  float echo;       // [m] infinite: none
  float spread;     // [m] error of the echo
};
static_assert(Grid::kTile % kLanes == 0, "look() fills whole steps of a row");
struct Row {
  std::array<float, Grid::kTile> behind;  // errors from the cell to the echo
  std::array<float, Grid::kTile> found;   // probability of an echo of the cell; -1: outside
  std::array<std::int32_t, Grid::kTile> bin;
};

/// The first cell is at x, y from the sonar, in cells of `size`. In line, as for_cone(): a part of
/// weigh(), which is compiled twice.
[[gnu::always_inline]] inline void look(const Beam& beam, float x, float y, float size, int bins,
                                        int count, Row& row) {
  const auto [heading, c, s, edge, range, far, detection, echo, spread] = beam;
  const auto all_bins = static_cast<float>(bins);
  const float by_angle = all_bins / static_cast<float>(2.0 * kPi);
  // Some cells more, for whole steps: nobody reads them.
  const int whole = (count + kLanes - 1) / kLanes * kLanes;
  for (int i = 0; i < whole; ++i) {
    const float dx = x + static_cast<float>(i) * size;
    const float along = c * dx + s * y;
    const float across = -s * dx + c * y;
    const float z = std::sqrt(dx * dx + y * y);
    const bool inside = (along > 0.0F) & (std::abs(across) <= edge * along) & (z <= range);
    const float tangent = inside ? across / along : 0.0F;
    const float square = tangent * tangent;
    const float off = 1.0F - square / (edge * edge);
    const float bin = heading + tangent * (1.0F - square / 3.0F) * by_angle;
    row.behind[i] = (echo - z) / spread;
    row.found[i] = inside ? detection * (1.0F - z / far) * off * off : -1.0F;
    row.bin[i] = std::min(bins - 1, static_cast<int>(bin - all_bins * std::floor(bin / all_bins)));
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
  std::vector<float> limits;  // that give one more step than their index
  for (int steps = 0; steps < kMost; ++steps)
    limits.push_back(static_cast<float>(1.0 - std::exp(-kStep * (steps + 0.5))));
  limits.push_back(std::numeric_limits<float>::infinity());
  for (int i = 0; i <= kFine; ++i) {
    const auto next = std::upper_bound(limits.begin(), limits.end(), static_cast<float>(i) / kFine);
    free_steps_.push_back({*next, static_cast<std::uint8_t>(next - limits.begin())});
  }
}

inline int Grid::free_steps(float detection) const {
  const auto& [limit, steps] =
      free_steps_[static_cast<std::size_t>(static_cast<long>(detection * kFine))];
  return steps + (detection >= limit ? 1 : 0);
}

inline int Grid::weighed(int said) const {
  return weighed_[static_cast<std::size_t>(static_cast<long>(said) + kHalf)];
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
[[gnu::always_inline]] inline void Grid::for_cone(const Pose& sonar, double range, double echo,
                                                  double spread, F&& f) {
  const double size = settings_.resolution;
  const double edge = std::tan(settings_.beam);
  const ConeRows cone(sonar, edge, range);
  const auto narrow = [](double v) { return static_cast<float>(v); };
  const Beam beam{.heading = narrow(sonar.th * kBins / (2.0 * kPi)),
                  .cosine = narrow(cone.cosine()),
                  .sine = narrow(cone.sine()),
                  .edge = narrow(edge),
                  .range = narrow(range),
                  .far = narrow(settings_.range),
                  .detection = narrow(settings_.detection),
                  .echo = narrow(echo),
                  .spread = narrow(spread)};
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
      const long end_row = std::min(row0 + kTile - 1, last_row);
      for (long row = std::max(row0, first_row); row <= end_row; ++row) {
        const auto& span = spans_[static_cast<std::size_t>(row - first_row)];
        const long begin = std::max(column0, span.first);
        const long count = std::min(column0 + kTile - 1, span.second) - begin + 1;
        if (count <= 0)
          continue;
        look(beam, narrow((static_cast<double>(begin) + 0.5) * size - sonar.x),
             narrow(distance(row)), narrow(size), kBins, static_cast<int>(count), seen);
        const auto cells = static_cast<std::size_t>(count);
        std::size_t first = 0;
        while (first < cells && seen.found[first] <= 0.0F)
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

inline void Grid::evidence(Tile& tile, std::size_t cell, int bin, int steps) {
  std::int8_t& said = tile.bins[cell][static_cast<std::size_t>(bin)];
  const auto before = static_cast<int>(said);  // NOLINT(bugprone-signed-char-misuse): a number
  const int after = steps <= 0 ? std::max(before + steps, -kMost) : std::min(before + steps, kMost);
  tile.seen[cell] = true;
  if (after == before)
    return;
  said = static_cast<std::int8_t>(after);
  tile.total[cell] = static_cast<std::int16_t>(tile.total[cell] + weighed(after) - weighed(before));
}

SAPHIRA_WIDE void Grid::weigh(const Pose& sonar, std::optional<double> range) {
  const double far = settings_.range;
  // Beyond three deviations behind the echo there is no evidence.
  const double deviation =
      range ? settings_.noise + settings_.relative_noise * *range : settings_.noise;
  const double half_cell = settings_.resolution / 2.0;
  const double spread = std::hypot(deviation, half_cell);
  const double reach = range ? std::min(far, *range + 3.0 * spread) : far;
  arc_.clear();
  const auto most_density = static_cast<float>(1.0 / (std::sqrt(2.0 * kPi) * spread));
  float sum = 0.0F;
  const double echo = range.value_or(std::numeric_limits<double>::infinity());
  const auto take = [&](Tile& tile, std::size_t cell0, const Row& row, std::size_t i,
                        std::size_t end) {
    tile.changed = true;
    std::uint64_t met = 0;
    for (; i < end; ++i) {
      const float found = row.found[i];
      if (found <= 0.0F)
        continue;
      ++met;
      const std::size_t cell = cell0 + i;
      const int bin = row.bin[i];
      const float behind = row.behind[i];
      if (behind > 3.0F) {
        evidence(tile, cell, bin, -free_steps(found));
        continue;
      }
      Arc arc{&tile, cell, bin, 0.0F, 1.0F, 0.0F};
      arc.density = found * most_density * std::exp(-behind * behind / 2.0F);
      arc.before = 1.0F - found / (1.0F + std::exp(-1.7F * behind));
      arc.odds = static_cast<float>(probability(tile, cell));
      sum += arc.odds * arc.density;
      arc_.push_back(arc);
    }
    updates_ += met;
  };
  for_cone(sonar, reach, echo, spread, take);
  const auto false_echoes = static_cast<float>(settings_.false_echoes);
  const auto attribution = static_cast<float>(settings_.attribution);
  // The echo came from somewhere on the arc: the beliefs in the rest of it explain it as well.
  for (const Arc& arc : arc_) {
    const float rest = false_echoes + attribution * (sum - arc.odds * arc.density);
    const float odds = std::log(arc.before * arc.density / rest + arc.before);
    evidence(*arc.tile, arc.cell, arc.bin, static_cast<int>(std::lround(odds / kStep)));
  }
}

}  // namespace saphira::interpretation
