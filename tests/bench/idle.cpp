// The cost of the running system while the robot stands: CPU and memory of every process, live.
#include <stdlib.h>
#include <unistd.h>

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "bench.hpp"
#include "saphira/command_line/command_line.hpp"

using namespace saphira::bench;

int main(int argc, char** argv) {
  saphira::CommandLine app{"Cost of the idle system, live at 10 Hz"};
  bool json = false;
  unsigned seconds = 20;
  std::string deployment = "demo";
  app.add_flag("--json", json, "one JSON object on the last line");
  app.add_option("--seconds", seconds, "how long to watch").in_range(2, 3600);
  app.add_option("--deployment", deployment, "what to run");
  if (const auto code = app.parse(argc, argv))
    return *code;

  setenv("SAPHIRA_DOMAIN", "199", 1);
  setenv("SAPHIRA_ROBOT", "bench-idle", 1);
  setenv("ROBOT_SOCKET", ("/tmp/saphira-bench-idle-" + std::to_string(getpid())).c_str(), 1);
  const Child up({"saphira", "up", deployment});
  sleep(5);  // past discovery and the connection to the robot

  const std::vector<pid_t> processes = family(up.pid());
  std::map<pid_t, double> before;
  for (const pid_t pid : processes)
    before[pid] = cpu_seconds(pid);
  sleep(seconds);

  double cpu = 0.0;
  double memory = 0.0;
  nlohmann::json each = nlohmann::json::array();
  for (const pid_t pid : processes) {
    const double percent = 100.0 * (cpu_seconds(pid) - before[pid]) / seconds;
    const double resident = resident_mb(pid);
    std::printf("%-20s %6.2f %% of a core  %6.1f MB\n", name_of(pid).c_str(), percent, resident);
    each.push_back({{"program", name_of(pid)}, {"cpu_percent", percent}, {"rss_mb", resident}});
    cpu += percent;
    memory += resident;
  }
  std::printf("%-20s %6.2f %% of a core  %6.1f MB  (limit 15 %%)\n", "all", cpu, memory);
  if (processes.size() < 5) {
    std::fprintf(stderr, "the deployment did not come up: %zu processes\n", processes.size());
    return 1;
  }
  if (json)
    std::printf("%s\n",
                nlohmann::json{{"idle_cpu_percent", cpu}, {"rss_mb", memory}, {"processes", each}}
                    .dump()
                    .c_str());
  return 0;
}
