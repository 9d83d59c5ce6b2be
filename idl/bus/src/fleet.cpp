#include "fleet.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "internal.hpp"
#include "saphira/base/fnv1a.hpp"
#include "saphira/base/text.hpp"

namespace saphira::bus::internal {
namespace {

constexpr std::size_t kMostKnown = 1000;

/// True where a list of names, with commas, has this one or stands for all.
bool has(const std::string& list, const std::string& name) {
  return list == "*" || ("," + list + ",").find("," + name + ",") != std::string::npos;
}

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

Fleet::Fleet(const NodeOptions& options)
    : name_(options.name), robot_(options.robot), far_(joined(options.far, ",")) {}

std::string Fleet::fields() const {
  return (robot_.empty() ? "" : "robot=" + robot_ + ";") +
         (far_.empty() ? "" : "far=" + far_ + ";");
}

bool Fleet::meets(const Announced& other) const {
  const std::string robot = field(other.data, "robot");
  return robot.empty() || robot_.empty() || partitions_meet(robot_, robot) ||
         has(far_, other.name) || has(field(other.data, "far"), name_);
}

std::vector<std::uint16_t> Fleet::ports() const {
  if (!robot_.empty() && robot_.find_first_of("*?[") == std::string::npos && far_.empty()) {
    Fnv1a hash;
    hash.add(robot_);
    return {static_cast<std::uint16_t>(kFirstPort + hash.value() % kPorts)};
  }
  std::vector<std::uint16_t> all(kPorts);
  std::iota(all.begin(), all.end(), kFirstPort);
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
