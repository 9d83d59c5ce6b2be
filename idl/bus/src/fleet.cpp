#include "fleet.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "internal.hpp"
#include "saphira/base/fnv1a.hpp"

namespace saphira::bus::internal {
namespace {

constexpr std::size_t kMostKnown = 1000;

}  // namespace

std::string field(std::string_view data, std::string_view key) {
  while (!data.empty()) {
    const std::string_view item = data.substr(0, data.find(';'));
    data.remove_prefix(std::min(data.size(), item.size() + 1));
    if (item.size() > key.size() && item.starts_with(key) && item[key.size()] == '=')
      return std::string(item.substr(key.size() + 1));
  }
  return {};
}

Fleet::Fleet(const NodeOptions& options) : robot_(options.robot), others_(options.others) {}

std::string Fleet::fields() const {
  return (robot_.empty() ? "" : "robot=" + robot_ + ";") + (others_ == Others::met ? "far=*;" : "");
}

bool Fleet::meets(const Announced& other) const {
  const std::string robot = field(other.data, "robot");
  return robot.empty() || robot_.empty() || others_ == Others::met ||
         partitions_meet(robot_, robot) || !field(other.data, "far").empty();
}

std::vector<std::uint16_t> Fleet::ports() const {
  if (others_ == Others::ignored && !robot_.empty() &&
      robot_.find_first_of("*?[") == std::string::npos) {
    Fnv1a hash;
    hash.add(robot_);
    return {static_cast<std::uint16_t>(kFirstPort + hash.value() % kPorts)};
  }
  std::vector<std::uint16_t> all(kPorts);
  std::iota(all.begin(), all.end(), kFirstPort);
  return all;
}

void Fleet::note(const Announced& other, Time now) {
  if (others_ != Others::noted)
    return;
  const std::scoped_lock lock(noted_->mutex);
  if (noted_->programs.size() >= kMostKnown)
    noted_->programs.clear();
  noted_->programs[{field(other.data, "robot"), other.name}] = now;
}

std::vector<OtherProgram> Fleet::others(Time now) const {
  const std::scoped_lock lock(noted_->mutex);
  std::vector<OtherProgram> all;
  for (const auto& [program, heard] : noted_->programs)
    if (now - heard < kForgotten)
      all.push_back(program);
  return all;
}

void Fleet::hear(std::string_view prefix, Time now) {
  if (known_.contains(prefix))
    return;
  if (known_.size() >= kMostKnown)
    known_.clear();
  known_.emplace(prefix);
  often_until_ = now + kOften;
}

bool Fleet::is_due(std::string_view data, Time now) {
  if (!std::exchange(begun_, true))
    often_until_ = now + kOften;
  if (now < sent_ + kOnce)
    return true;
  if (now >= often_until_ && now < sent_ + kSeldom && data == sent_data_)
    return false;
  sent_ = now;
  sent_data_ = data;
  return true;
}

}  // namespace saphira::bus::internal
