#include "saphira/cli/words.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "saphira/base/format.hpp"

namespace saphira::cli {

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i == widths.size())
        widths.push_back(0);
      widths[i] = std::max(widths[i], row[i].size());
    }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - row[i].size(), ' ');
      const bool number =
          !row[i].empty() && std::isdigit(static_cast<unsigned char>(row[i][0])) != 0;
      if (i + 1 == row.size())
        line += row[i];
      else
        line += (number ? padding + row[i] : row[i] + padding) + "  ";
    }
    while (line.ends_with(' '))
      line.pop_back();
    text += line + "\n";
  }
  return text;
}

std::array<std::string, 2> two_lines(const std::string& text, std::size_t width) {
  if (text.size() <= width)
    return {text, ""};
  const std::size_t space = text.rfind(' ', width);
  if (space == std::string::npos || space == 0)
    return {text.substr(0, width), text.substr(width, width)};
  return {text.substr(0, space), text.substr(space + 1, width)};
}

std::string status_table(std::vector<SeenProcess> processes,
                         const std::vector<std::string>& unheard) {
  std::ranges::sort(processes, [](const SeenProcess& a, const SeenProcess& b) {
    return std::pair(a.status.name, a.status.pid) < std::pair(b.status.name, b.status.pid);
  });
  std::vector<std::vector<std::string>> rows{{"NAME", "STATE", "AGE s", "EPOCH", "CYCLE", "LATE",
                                              "STEP ms", "MAX", "CPU %", "MB", "HOST", "PID",
                                              "REASON"}};
  for (const SeenProcess& process : processes) {
    const v1::ServiceStatus& status = process.status;
    const double age = process.age;
    const bool lost = age > kLostAge;
    rows.push_back(
        {status.name, lost ? "lost" : name_of(status.state), format("%.1f", age),
         std::to_string(status.stamp.epoch), std::to_string(status.stamp.cycle),
         std::to_string(status.late_cycles), format("%.2f", status.step_ms_mean),
         format("%.2f", status.step_ms_max), format("%.1f", status.cpu_percent),
         format("%.1f", status.rss_mb), status.host, std::to_string(status.pid),
         lost ? "not heard any more; its last words: " + std::string(name_of(status.state)) +
                    (status.reason.empty() ? "" : ", " + status.reason)
              : status.reason});
  }
  for (const std::string& name : unheard)
    if (std::ranges::none_of(processes,
                             [&name](const SeenProcess& one) { return one.status.name == name; }))
      rows.push_back({name, "not heard"});
  return table(rows);
}

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

void expect_ending(const std::string& path, const std::string& ending) {
  if (!path.ends_with(ending))
    throw std::invalid_argument(path + ": expected a name that ends with " + ending +
                                ", the kind of file that this writes");
}

}  // namespace saphira::cli
