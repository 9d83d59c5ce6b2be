#include "saphira/cli/second_deployment.hpp"

namespace saphira::cli {

std::string second_deployment(const std::vector<SeenProcess>& processes) {
  std::string programs;
  for (const SeenProcess& process : processes) {
    const v1::ServiceStatus& status = process.status;
    if (process.namesake && process.age <= kLostAge)
      programs += (programs.empty() ? "" : ", ") + status.name +
                  (status.state == v1::SERVICE_WAITING ? " (waits, process " : " (process ") +
                  std::to_string(status.pid) + " at " + status.host + ")";
  }
  if (programs.empty())
    return {};
  return "two deployments have this robot; a second time there are: " + programs +
         ". Stop one of the two (Ctrl-C of its saphira up), or give its robot another name "
         "(robot: in the deployment, or --robot)";
}

std::optional<std::string> SecondDeployment::news(const std::vector<SeenProcess>& processes,
                                                  double now) {
  const std::string words = second_deployment(processes);
  if (seen_ == words.empty()) {
    seen_ = !words.empty();
    since_ = now;
  }
  if (!doubtful() || now - since_ < kCertain)
    return std::nullopt;
  told_ = seen_;
  return seen_ ? words : "there is one deployment with this robot again";
}

}  // namespace saphira::cli
