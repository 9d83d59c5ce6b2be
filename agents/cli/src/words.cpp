#include "saphira/cli/words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>

namespace saphira::cli {

namespace {

std::string fixed(double value, int digits) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

}  // namespace

const char* name_of(v1::ServiceState state) {
  switch (state) {
    case v1::SERVICE_STARTING:
      return "starting";
    case v1::SERVICE_WAITING:
      return "waiting";
    case v1::SERVICE_RUNNING:
      return "running";
    case v1::SERVICE_DEGRADED:
      return "degraded";
    case v1::SERVICE_STOPPING:
      return "stopping";
  }
  return "?";
}

const char* name_of(v1::LogLevel level) {
  switch (level) {
    case v1::LOG_DEBUG:
      return "debug";
    case v1::LOG_INFO:
      return "info";
    case v1::LOG_WARNING:
      return "warning";
    case v1::LOG_ERROR:
      return "error";
  }
  return "?";
}

const char* name_of(v1::Role role) {
  switch (role) {
    case v1::ROLE_NONE:
      return "nobody";
    case v1::ROLE_ESTOP:
      return "estop";
    case v1::ROLE_TELEOP:
      return "teleop";
    case v1::ROLE_DIRECT:
      return "direct";
    case v1::ROLE_BEHAVIORS:
      return "behaviors";
  }
  return "?";
}

const char* name_of(v1::GuardAction action) {
  switch (action) {
    case v1::GUARD_NONE:
      return "passes";
    case v1::GUARD_LIMIT:
      return "limits";
    case v1::GUARD_SLOW:
      return "slows";
    case v1::GUARD_STOP:
      return "stops";
  }
  return "?";
}

std::string latched(const v1::Grant& grant) {
  if (grant.estopped())
    return "EMERGENCY STOP, pressed by " +
           (grant.estop_source().empty() ? "a program without a name" : grant.estop_source()) +
           ": the robot stands until saphira estop reset";
  if (grant.waits_for_hand_back())
    return "autonomy waits until the robot is handed back: saphira drive hand-back";
  return {};
}

std::string describe(const v1::Grant& grant) {
  std::string text;
  if (grant.estopped()) {
    text = latched(grant);
  } else {
    text = name_of(grant.role());
    text += grant.role() == v1::ROLE_NONE ? " drives" : " drives (" + grant.source() + ")";
    if (!grant.reason().empty())
      text += ": " + grant.reason();
    if (grant.waits_for_hand_back() && grant.reason().find("hand-back") == std::string::npos)
      text += "; " + latched(grant);
  }
  if (grant.guard() != v1::GUARD_NONE)
    text += "; the guard " + std::string(name_of(grant.guard())) + ": " + grant.guard_reason();
  for (const v1::Refusal& refusal : grant.refused())
    text +=
        "; refused " + refusal.source() + " (" + name_of(refusal.role()) + "): " + refusal.reason();
  return text;
}

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

std::string status_table(std::vector<SeenProcess> processes) {
  std::sort(processes.begin(), processes.end(), [](const SeenProcess& a, const SeenProcess& b) {
    return std::pair(a.status.name(), a.status.pid()) < std::pair(b.status.name(), b.status.pid());
  });
  std::vector<std::vector<std::string>> rows{{"NAME", "STATE", "AGE s", "EPOCH", "CYCLE", "LATE",
                                              "STEP ms", "MAX", "CPU %", "MB", "HOST", "PID",
                                              "REASON"}};
  for (const auto& [status, age, namesake] : processes) {
    const bool lost = age > kLostAge;
    rows.push_back(
        {status.name(), lost ? "lost" : name_of(status.state()), fixed(age, 1),
         std::to_string(status.stamp().epoch()), std::to_string(status.stamp().cycle()),
         std::to_string(status.late_cycles()), fixed(status.step_ms_mean(), 2),
         fixed(status.step_ms_max(), 2), fixed(status.cpu_percent(), 1), fixed(status.rss_mb(), 1),
         status.host(), std::to_string(status.pid()),
         lost ? "not heard any more; its last words: " + std::string(name_of(status.state())) +
                    (status.reason().empty() ? "" : ", " + status.reason())
              : status.reason()});
  }
  return table(rows);
}

std::string missing_services(const std::vector<SeenProcess>& processes) {
  std::vector<std::string> missing;
  for (const char* name : {"bridge", "behaviors", "intentions"})
    if (std::none_of(processes.begin(), processes.end(), [name](const SeenProcess& process) {
          return process.status.name() == name && process.age <= kLostAge;
        }))
      missing.emplace_back(name);
  std::string text;
  for (std::size_t i = 0; i < missing.size(); ++i)
    text += (i == 0 ? "" : i + 1 == missing.size() ? " and " : ", ") + missing[i];
  return text;
}

}  // namespace saphira::cli
