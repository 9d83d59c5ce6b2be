#include "saphira/bus/status_words.hpp"

namespace saphira::bus {
namespace {

std::string beginning(const std::string& name) {
  return "another " + name + ", process ";
}

}  // namespace

std::string another(const v1::ServiceStatus& other) {
  return beginning(other.name) + std::to_string(other.pid) + " at " + other.host + ",";
}

bool has_namesake(const v1::ServiceStatus& status) {
  return status.reason.starts_with(beginning(status.name));
}

bool waits_for_robot(const v1::ServiceStatus& status) {
  return status.state == v1::SERVICE_WAITING && status.reason.starts_with("waits for robot/");
}

bool serves(const v1::ServiceStatus& status) {
  return status.state == v1::SERVICE_RUNNING || status.state == v1::SERVICE_DEGRADED;
}

}  // namespace saphira::bus
