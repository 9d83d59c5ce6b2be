#include "saphira/watch/processes.hpp"

#include <algorithm>
#include <set>

#include "saphira/base/enumerators.hpp"
#include "saphira/bus/introspect.hpp"
#include "saphira/bus/status_words.hpp"
#include "saphira/situation/words.hpp"
#include "saphira/watch/diagnosis.hpp"

namespace saphira::watch {
namespace {

// Programs come and go for months, and anybody may write a status.
constexpr std::size_t kMostEntries = 1000;

}  // namespace

void Processes::poll() {
  for (const auto& sample : reader_.take()) {
    if (entries_.size() >= kMostEntries && !entries_.contains(sample.data.instance))
      entries_.erase(
          std::ranges::min_element(entries_, {}, [](const auto& one) { return one.second.came; }));
    Entry& entry = entries_[sample.data.instance];
    entry.gone = sample.info.disposed;
    if (!sample.info.disposed) {
      entry.age = entry.samples++ == 0 ? sample.info.age : std::min(entry.age, sample.info.age);
      entry.status = sample.data;
      entry.came = Clock::now();
    }
  }
  if (news() > news_)
    changed_ = Clock::now();
  news_ = news();
}

std::vector<situation::Program> Processes::all() const {
  std::vector<situation::Program> processes;
  for (const auto& [instance, entry] : entries_)
    if (!entry.gone && !entry.status.name.empty())
      // The first sample may be that of a program which hangs: old, and kept for late readers.
      processes.push_back({entry.status, seconds_since(entry.came), bus::has_namesake(entry.status),
                           entry.samples > 1 || entry.age < 0.0 ? entry.age : 0.0});
  return processes;
}

std::vector<std::string> Processes::found() const {
  // A lost packet of discovery is repeated after 3 s, one of a status within a second.
  const bool far = node_.options().profile != bus::Profile::host;
  const double lately = far ? 8.0 : 5.0;  // [s] what has not reported by then does not, or hangs
  const double late = far ? 6.0 : situation::kLostAge;  // [s] likewise
  std::vector<std::string> names;
  for (const bus::ProgramEntry& program : bus::found_programs(node_)) {
    const auto of_it = std::ranges::find_if(entries_, [&program](const auto& entry) {
      const v1::ServiceStatus& status = entry.second.status;
      return status.name == program.name && status.pid == program.pid &&
             status.host == program.host;
    });
    const double age = of_it == entries_.end() ? program.known : seconds_since(of_it->second.came);
    const bool is_open = of_it == entries_.end()
                             ? age < lately
                             : age > situation::kLostAge && age < late && !of_it->second.gone;
    // The commands of people have no status.
    if (program.pid != 0 && program.name != "cli" && program.let_in && !program.silent && is_open)
      names.push_back(program.name);
  }
  return names;
}

situation::Situation Processes::situation() const {
  situation::Situation now;
  now.programs = all();
  now.found = found();
  now.listened = seconds_since(began_);
  return now;
}

std::uint64_t Processes::late_cycles() const {
  std::uint64_t sum = 0;
  for (const auto& [instance, entry] : entries_)
    sum += entry.status.late_cycles;
  return sum;
}

const char* name_of(bus::Profile profile) {
  return word_of(profile, {"host", "lan", "wan"});
}

namespace {

/// Further advice for an unheard program.
const char* remedy(bus::Profile profile) {
  switch (profile) {
    case bus::Profile::host:
      return "; programs of other machines need --profile lan or wan";
    case bus::Profile::lan:
      return "; on a network without multicast (much of WiFi) both sides need profile wan, and one "
             "the "
             "other's address (--peer)";
    case bus::Profile::wan:
      return "; one side needs the other's address (--peer)";
  }
  return "";
}

/// "robot alpha and robot beta": those with a bridge in this domain.
std::string other_robots(bus::Node& node) {
  std::set<std::string> robots;
  for (const bus::OtherProgram& program : bus::Census(node).others())
    if (program.name == "bridge")
      robots.insert("robot " + program.robot);
  return situation::listed({robots.begin(), robots.end()});
}

}  // namespace

bool is_recording(const Processes& processes) {
  return is_heard(processes.situation().programs, "replay");
}

std::string who_is_there(const Processes& processes) {
  bus::Node& node = processes.node();
  const bus::NodeOptions& options = node.options();
  const situation::Situation now = processes.situation();
  const auto& all = now.programs;
  const std::string where = "robot " + options.robot + ", domain " +
                            std::to_string(options.domain) + ", profile " +
                            name_of(options.profile);
  if (all.empty()) {
    std::string bar = node.bar();
    if (const auto own = node.identity(); own && bar.empty())
      bar = why_kept_out(bus::found_programs(node), own->name);
    if (!bar.empty())
      return "the bus is secured (" + where + "): " + bar + " (docs/security.md)";
  }
  const bool listens =
      options.profile != bus::Profile::host &&
      std::chrono::duration<double>(processes.quiet()) < listening_time(node, false);
  if (const std::string others = all.empty() ? other_robots(node) : ""; !others.empty())
    return "no program of robot " + options.robot + " is on the bus, but of " + others +
           ": --robot NAME chooses one";
  if (all.empty())
    return (listens ? "no program is heard yet (" : "no program is on the bus (") + where +
           "): is it up (saphira up demo), and are these the same on both sides?" +
           (node.identity() ? " Without security: --security none." : "") + remedy(options.profile);
  if (is_recording(processes))
    return "this is a recording, which saphira replay plays: it takes no orders (" + where + ")";
  if (const std::string missing = situation::listed(unheard(now)); !missing.empty())
    return "not heard (" + where + "): " + missing + "; saphira status shows what is" +
           remedy(options.profile);
  for (const situation::Program& process : all)
    if (process.status.state != v1::SERVICE_RUNNING && !process.status.reason.empty())
      return process.status.name + " is " + situation::name_of(process.status.state) + ": " +
             process.status.reason;
  if (const std::string trouble = situation::trouble(now); !trouble.empty())
    return trouble + " (" + where + ")";
  std::set<std::string> heard;
  for (const situation::Program& process : all)
    if (process.age <= situation::kLostAge)
      heard.insert(process.status.name);
  return situation::listed({heard.begin(), heard.end()}) + (heard.size() == 1 ? " is" : " are") +
         " on the bus (" + where + ")";
}

std::chrono::milliseconds listening_time(const bus::Node& node, bool heard) {
  if (!heard && node.options().profile != bus::Profile::host)
    return std::chrono::milliseconds(4000);
  // With security: Fast DDS repeats a lost handshake message after a second.
  return std::chrono::milliseconds(node.identity() ? 2600 : 1300);
}

double listen(bus::Node& node, const bus::Stop& stop, const Processes& processes,
              const std::function<void()>& poll, const std::function<std::size_t()>& news) {
  const std::chrono::seconds most(node.options().profile == bus::Profile::host ? 10 : 15);
  const auto began = Clock::now();
  auto changed = began;
  std::size_t before = news();
  // On a network the programs that a robot needs may be found late.
  const auto is_done = [&] {
    const auto quiet = Clock::now() - changed;
    if (quiet < listening_time(node, processes.heard_any()))
      return false;
    const situation::Situation now = processes.situation();
    return now.found.empty() && (unheard(now).empty() || quiet >= listening_time(node, false));
  };
  while (!stop.requested() && !is_done() && Clock::now() - began < most) {
    node.wait(std::chrono::milliseconds(50), &stop);
    poll();
    if (news() > before)
      changed = Clock::now();
    before = news();
  }
  return std::chrono::duration<double>(changed - began).count();
}

std::string absence(const bus::Node& node, const Processes& processes, const std::string& program) {
  const situation::Situation known = processes.situation();
  const std::chrono::duration<double> needed = listening_time(node, processes.heard_any());
  if (is_heard(known.programs, program) || processes.quiet() < needed.count())
    return {};
  if (known.programs.empty())
    return who_is_there(processes);
  return "no saphira-" + program + " is heard (robot " + node.options().robot + ", domain " +
         std::to_string(node.options().domain) +
         "): it does not run (saphira up office has it), hangs, or is cut off";
}

}  // namespace saphira::watch
