// The cost of security: the round trip over a secured bus compared with an open one, and the CPU
// time of the secured demo while its robot stands. And its worth: what intruders get.
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bench.hpp"
#include "intruders.hpp"
#include "ping.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/security/authority.hpp"
#include "support/process.hpp"
#include "support/strangers.hpp"

using namespace saphira;
using bench::kDomain;
using bench::RoundTrip;
using Clock = std::chrono::steady_clock;

namespace {

/// Makes a site in that folder.
security::Authority site_in(const std::string& folder) {
  const std::string roles = config_folder() + "/security/roles.yaml";
  return security::Authority::make(folder, "bench", read_file(roles), roles, unix_seconds());
}

/// 10,000 forged announcements within 10 s, and then a member who joins. `programs`: so many that
/// repeat themselves, and go on to while it joins.
nlohmann::json flood(const std::string& self, const std::string& credentials,
                     const std::string& folder, int programs = 0) {
  test::Process victim({self, "--echo", credentials}, folder + "/victim");
  test::Strangers strangers(kDomain);
  strangers.announce(10000, 1000, programs);
  const std::jthread go_on([&](const std::stop_token& stop) {
    while (programs > 0 && !stop.stop_requested())
      strangers.announce(programs, 1000, programs);
  });
  const auto began = Clock::now();
  const RoundTrip joiner(credentials);
  const double joined = std::chrono::duration<double>(Clock::now() - began).count();
  return {{"aborts", victim.running() ? 0 : 1},
          {"joined_s", joined},
          {"flooded_mb", bench::resident_mb(victim.pid())}};
}

nlohmann::json to_json(const bench::Intrusion& one) {
  return {{"who", one.who},           {"got", one.got},          {"named", one.named},
          {"named_by", one.named_by}, {"cycles", one.cycles},    {"late", one.late},
          {"aborted", one.aborted},   {"left_out", one.left_out}};
}

/// All intruders; `result` gets the sums.
void attack(security::Authority& site, const std::string& self, const std::string& credentials,
            const std::string& folder, nlohmann::json& result) {
  std::size_t escapes = 0;
  int aborts = 0;
  std::vector<std::string> misnamed;  // nobody named, or an intruder not named
  for (const bench::Intrusion& one : bench::intrude(site, folder, self, kDomain, unix_seconds())) {
    result["intruders"].push_back(to_json(one));
    escapes += one.got.size();
    aborts += one.aborted ? 1 : 0;
    if (!one.left_out && one.named.empty() != (one.who == bench::kNobody))
      misnamed.push_back(one.who);
    std::printf(
        "%-36s got %s; %zu of %zu cycles late; %s\n", one.who.c_str(),
        one.left_out      ? "left out: no right to hear packets"
        : one.got.empty() ? "nothing"
                          : joined(one.got).c_str(),
        one.late, one.cycles,
        one.named.empty() ? "not named" : (joined(one.named_by) + ": " + one.named).c_str());
    std::fflush(stdout);
  }
  result["misnamed"] = misnamed;
  result["member_escapes"] = escapes;
  const nlohmann::json once = flood(self, credentials, folder);
  const nlohmann::json repeated = flood(self, credentials, folder, 300);
  result["aborts"] = aborts + once["aborts"].get<int>() + repeated["aborts"].get<int>();
  result["joined_s"] = once["joined_s"];
  result["joined_while_repeated_s"] = repeated["joined_s"];
  result["flooded_mb"] = once["flooded_mb"];
}

double idle_cpu_percent(const std::string& security, unsigned seconds) {
  setenv("SAPHIRA_DOMAIN", std::to_string(kDomain - 1).c_str(), 1);
  setenv("SAPHIRA_ROBOT", "bench-secure", 1);
  setenv("SAPHIRA_SECURITY", security.c_str(), 1);
  const bench::Child up({"saphira", "up", "demo"});
  constexpr std::size_t kPrograms = 5;
  for (int i = 0; i < 300 && bench::family(up.pid()).size() < kPrograms; ++i)
    usleep(100'000);
  sleep(6);  // past discovery and the connection to the robot
  const std::vector<pid_t> processes = bench::family(up.pid());
  if (processes.size() < kPrograms)
    throw std::runtime_error("the demo did not come up within 30 s");
  const auto used = [&] {
    double sum = 0.0;
    for (const pid_t pid : processes)
      sum += bench::cpu_seconds(pid);
    return sum;
  };
  const double before = used();
  sleep(seconds);
  return 100.0 * (used() - before) / seconds;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"Cost of security: round trip beside an open bus, and the idle demo"};
  bool json = false;
  int pings = 500;
  unsigned seconds = 20;
  bool attacked = true;
  std::string answering;
  std::string guarded;
  app.add_flag("--json", json, "one JSON object on the last line");
  app.add_option("--pings", pings, "round trips on each bus").in_range(10, 100000);
  app.add_option("--seconds", seconds,
                 "how long to watch the idle demo; 0: idle_cpu_percent is null")
      .in_range(0, 3600);
  app.add_flag("!--no-attack", attacked, "without intruders");
  app.add_option("--echo", answering, "be the other process").hidden();
  app.add_option("--watched", guarded, "be the bridge that is attacked").hidden();
  if (const auto code = app.parse(argc, argv))
    return *code;
  if (!answering.empty())
    bench::echo(answering);
  if (!guarded.empty())
    return bench::watched(guarded, kDomain);

  const test::TempDir folder;
  security::Authority site = site_in(folder.path("site"));
  const std::string credentials =
      site.add("bench", {"bridge", "services", "operator"}, "", 1, unix_seconds());
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  nlohmann::json result;
  {
    const bench::Child open_echo({self, "--echo", bus::kOpenBus});
    const bench::Child secured_echo({self, "--echo", credentials});
    RoundTrip open(bus::kOpenBus);
    RoundTrip secured(credentials);
    for (int i = 0; i < pings; ++i) {
      open.measure();
      secured.measure();
      usleep(5000);
    }
    result = {{"open_p50_us", open.quantile(0.5)},
              {"open_p99_us", open.quantile(0.99)},
              {"secure_p50_us", secured.quantile(0.5)},
              {"secure_p99_us", secured.quantile(0.99)},
              {"ratio_p50", secured.quantile(0.5) / open.quantile(0.5)},
              {"open_answered", open.answered()},
              {"secure_answered", secured.answered()}};
  }
  if (attacked)
    attack(site, self, credentials, folder.path(), result);
  result["idle_cpu_percent"] = nullptr;  // --seconds 0: not measured
  if (seconds > 0)
    result["idle_cpu_percent"] = idle_cpu_percent(credentials, seconds);
  bench::print(result, json);
  return result.value("member_escapes", 0) == 0 && result.value("aborts", 0) == 0 &&
                 result.value("misnamed", nlohmann::json::array()).empty()
             ? 0
             : 1;
}
