#include "interpretation/shell/shell.hpp"

#include "interpretation/shell/convert.hpp"
#include "lps/shell/convert.hpp"

namespace saphira::interpretation {
namespace {

/// A tile that changes is published once a second.
constexpr std::uint64_t kGridCycles = 10;

}  // namespace

Shell::Shell(bus::Node& node)
    : node_(node),
      cycle_(node),
      robot_(node),
      perceptions_(node.writer(bus::topics::kPerception)),
      tiles_(node.writer(bus::topics::kGrid)),
      processes_(node, table_) {}

bool Shell::step(const bus::Stop& stop) {
  const auto step = cycle_.next(stop, [this] { processes_.idle(); });
  if (!step)
    return false;
  processes_.step(cycle_.stamp());
  using Knowledge = bus::KnownRobot::Knowledge;
  const Knowledge known = robot_.of(cycle_.stamp().epoch(), stop);
  if (known == Knowledge::fresh) {
    for (const TileKey& key : published_)
      dispose(key);
    published_.clear();
    changed_.clear();
    Settings settings;
    settings.sonars = lps::mounts_from_bus(robot_.description());
    // The same robot again: ids go on, so that none stands for two things.
    if (interpretation_ && interpretation_->settings().sonars == settings.sonars)
      interpretation_->reset();
    else
      interpretation_.emplace(settings, &tasks_);
    odom_.reset();
  }
  v1::Perception sample;
  if (known != Knowledge::none) {
    // Another origin of the odometry: what was seen is elsewhere.
    if (odom_ && *odom_ != step->robot.odom())
      interpretation_->reset();
    odom_ = step->robot.odom();
    const Output& output = interpretation_->step({cycle_.stamp().cycle(),
                                                  lps::from_bus(step->robot.pose_in_odom()),
                                                  lps::sonars_from_bus(step->robot),
                                                  {}});
    sample = to_bus(output);
    publish_grid(output);
  }
  sample.stamp(cycle_.stamp());
  sample.odom(step->robot.odom());
  perceptions_.write(sample);
  cycle_.done();
  return true;
}

void Shell::publish_grid(const Output& output) {
  changed_.insert(output.changed_tiles.begin(), output.changed_tiles.end());
  for (const TileKey& key : output.dropped_tiles) {
    changed_.erase(key);
    if (published_.erase(key) > 0)
      dispose(key);
  }
  if (cycle_.stamp().cycle() % kGridCycles != 0)
    return;
  for (const TileKey& key : changed_) {
    v1::GridTile tile = to_bus(interpretation_->grid(), key);
    tile.stamp(cycle_.stamp());
    tile.odom(*odom_);
    tiles_.write(tile);
    published_.insert(key);
  }
  changed_.clear();
}

void Shell::dispose(const TileKey& key) {
  v1::GridTile tile;
  tile.column(static_cast<std::int32_t>(key.column));
  tile.row(static_cast<std::int32_t>(key.row));
  tiles_.dispose(tile);
}

}  // namespace saphira::interpretation
