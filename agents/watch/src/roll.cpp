#include "saphira/watch/roll.hpp"

#include <algorithm>

namespace saphira::watch {

Roll::Id Roll::id_of(const bus::WriterId& writer) {
  Id id{};
  std::copy_n(writer.begin(), id.size(), id.begin());
  return id;
}

void Roll::update(const std::vector<bus::ProgramEntry>& announced,
                  const std::set<bus::WriterId>& writers, double now) {
  std::set<Id> programs;
  std::set<Id> bridges;
  std::map<Id, std::string> robots;
  for (const bus::WriterId& writer : writers)
    bridges.insert(id_of(writer));
  for (const bus::ProgramEntry& one : announced) {
    robots[one.id] = one.robot;
    if (one.kind() == "bridge")
      bridges.insert(one.id);
  }
  programs = bridges;
  for (const bus::ProgramEntry& one : announced)
    programs.insert(one.id);
  if (!began_)
    began_ = now;
  if (!changed_ || !std::ranges::includes(programs_, programs))
    changed_ = now;
  programs_ = std::move(programs);
  bridges_.clear();
  bridgeless_.clear();
  for (const bus::ProgramEntry& one : announced)
    if (one.kind() == "behaviors" && !one.robot.empty())
      bridgeless_.insert(one.robot);
  for (const Id& id : bridges) {
    bridges_[id] = robots[id].empty() ? "a robot without a name" : robots[id];
    bridgeless_.erase(bridges_[id]);
  }
}

std::vector<std::string> Roll::robots() const {
  return without({});
}

std::vector<std::string> Roll::without(const std::set<bus::WriterId>& writers) const {
  std::set<Id> ids;
  for (const bus::WriterId& writer : writers)
    ids.insert(id_of(writer));
  std::vector<std::string> robots(bridgeless_.begin(), bridgeless_.end());
  for (const auto& [id, robot] : bridges_)
    if (!ids.contains(id))
      robots.push_back(robot);
  std::ranges::sort(robots);
  return robots;
}

}  // namespace saphira::watch
