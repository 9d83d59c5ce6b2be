#include "saphira/interpretation/core.hpp"

#include <utility>

namespace saphira::interpretation {
namespace {

/// [cycles] A changed tile is published once a second.
constexpr std::uint64_t kGridCycles = 10;

}  // namespace

Core::Outputs Core::step(const Inputs& inputs) {
  Outputs outputs;
  if (inputs.new_robot != nullptr)
    begin(*inputs.new_robot, outputs.gone);
  else if (inputs.new_frame)
    interpretation_->reset();  // percepts were in the old frame
  outputs.output = &interpretation_->step({inputs.cycle, inputs.pose_in_odom, inputs.readings});
  note_tiles(*outputs.output, inputs.cycle, outputs);
  return outputs;
}

void Core::begin(const std::vector<lps::SonarMount>& sonars, std::vector<TileKey>& gone) {
  gone.assign(told_.begin(), told_.end());
  told_.clear();
  changed_.clear();
  // The same robot again: ids continue, so that none stands for two objects.
  if (interpretation_ && interpretation_->settings().sonars == sonars)
    interpretation_->reset();
  else
    make(sonars);
}

void Core::make(const std::vector<lps::SonarMount>& sonars) {
  Settings settings;
  settings.sonars = sonars;
  interpretation_.emplace(std::move(settings), &tasks_);
}

void Core::note_tiles(const Output& output, std::uint64_t cycle, Outputs& outputs) {
  for (const TileKey& key : output.dropped_tiles) {
    changed_.erase(key);
    if (told_.erase(key) > 0)
      outputs.gone.push_back(key);
  }
  // A tile may be left behind and begun anew in the same cycle.
  changed_.insert(output.changed_tiles.begin(), output.changed_tiles.end());
  if (cycle % kGridCycles != 0)
    return;
  outputs.tiles.assign(changed_.begin(), changed_.end());
  told_.insert(changed_.begin(), changed_.end());
  changed_.clear();
}

}  // namespace saphira::interpretation
