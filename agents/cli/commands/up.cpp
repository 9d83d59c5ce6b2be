#include <fcntl.h>
#include <poll.h>
#include <pwd.h>
#include <sys/mman.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "check.hpp"
#include "commands.hpp"
#include "environment.hpp"
#include "run_folder.hpp"
#include "saphira/base/descriptor.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/cli/bounded_log.hpp"
#include "saphira/cli/deployment.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/cli/service_manager.hpp"
#include "saphira/cli/supervisor.hpp"
#include "system/system.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr double kStarted = 20.0;                    ///< [s]
constexpr double kStopped = 20.0;                    ///< [s]
constexpr const char* kLogVariable = "SAPHIRA_LOG";  ///< of a detached one: its log file
constexpr double kTried = 20.0;                      ///< [s]
constexpr const char* kHandedVariable = "SAPHIRA_HANDED_OVER";
constexpr std::int64_t kLongestLog = 8 << 20;  ///< [bytes] of each of two parts

/// Prints each line with the child's name before it, in a color of its own on a terminal.
Supervisor::Print prefixed(const std::vector<ChildSpec>& children) {
  std::size_t width = std::string("saphira").size();
  std::vector<std::string> names;
  for (const ChildSpec& child : children) {
    width = std::max(width, child.name.size());
    names.push_back(child.name);
  }
  const bool colors = isatty(STDOUT_FILENO) != 0;
  return [width, names, colors](std::string_view from, std::string_view line) {
    const auto index = static_cast<std::size_t>(std::ranges::find(names, from) - names.begin());
    const std::string_view name = from.empty() ? "saphira" : from;
    std::string text;
    if (colors)
      text += from.empty() ? "\x1b[1m" : "\x1b[3" + std::to_string(2 + index % 5) + "m";
    text += name;
    text.append(width - std::min(width, name.size()), ' ');
    text += " | ";
    if (colors)
      text += "\x1b[0m";
    text += line;
    text += '\n';
    out().print(text);
  };
}

/// One file for two robots gives two deployments.
std::string name_of(const Deployment& deployment, const bus::NodeOptions& options) {
  return std::filesystem::path(deployment.file).stem().string() + "-" +
         deployment.bus.robot.value_or(options.robot) + "-" +
         std::to_string(deployment.bus.domain.value_or(options.domain));
}
RunFolder folder_of(const Deployment& deployment, const bus::NodeOptions& options) {
  return {name_of(deployment, options), deployment.bus.robot.value_or(options.robot),
          deployment.bus.domain.value_or(options.domain)};
}

/// Its bus, for other commands.
RunningBus bus_of(const Deployment& deployment, const bus::NodeOptions& options) {
  RunningBus bus = cli::bus_of(
      "the deployment " + std::filesystem::path(deployment.file).stem().string(), options);
  bus.robot = deployment.bus.robot.value_or(bus.robot);
  bus.domain = deployment.bus.domain.value_or(bus.domain);
  bus.profile = deployment.bus.profile.value_or(bus.profile);
  bus.interface = deployment.bus.interface.value_or(bus.interface);
  if (!deployment.bus.peers.empty())
    bus.peers = deployment.bus.peers;
  bus.security = deployment.bus.security.value_or(bus.security);
  bus.deployment = true;
  return bus;
}

/// `saphira renew` asks for new versions by SIGUSR1.
class RenewSignal {
 public:
  RenewSignal() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGUSR1);
    sigprocmask(SIG_BLOCK, &signals, nullptr);
    fd_ = signalfd(-1, &signals, SFD_NONBLOCK | SFD_CLOEXEC);
  }
  int fd() const { return fd_; }
  bool came() const {
    signalfd_siginfo info;
    bool any = false;
    while (read(fd_, &info, sizeof info) == sizeof info)
      any = true;
    return any;
  }

 private:
  Descriptor fd_;
};

/// The reason why a program cannot be added to the running ones; empty: it can.
std::string other_contract(const std::string& program) {
  const auto contract = [](const std::string& text) {
    const std::size_t at = text.find("contract ");
    return at == std::string::npos ? std::string() : text.substr(at + 9, 8);
  };
  const std::string ours = contract(bus::version());
  const std::string theirs = contract(said_by("'" + program + "' --version 2>&1").text);
  if (theirs == ours)
    return {};
  return "the new one has " + (theirs.empty() ? "no contract" : "the contract " + theirs) +
         ", and what runs has " + ours + ": saphira stop, and up again, takes in all of it";
}

/// The reason why a child stays in its old version; empty: it is renewed.
std::string objection(const ChildSpec& child) {
  if (!child.robot.empty())
    return other_contract(child.argv[0]);
  return std::ranges::find(child.argv, "--resume") != child.argv.end()
             ? ""
             : "it is not on the bus, and would begin anew (it has no --resume)";
}

/// The words of this process.
std::vector<std::string> own_words() {
  std::vector<std::string> words;
  std::string word;
  for (const char c : read_bytes("/proc/self/cmdline")) {
    if (c != '\0')
      word += c;
    else
      words.push_back(std::exchange(word, {}));
  }
  return words;
}

/// Takes over from the version before, which was in this process. The children's line; nothing
/// where there was none.
std::optional<std::string> take_handed_over() {
  const char* const descriptor = std::getenv(kHandedVariable);
  if (descriptor == nullptr)
    return std::nullopt;
  const std::string text = read_bytes(std::string("/proc/self/fd/") + descriptor);
  close(std::atoi(descriptor));
  unsetenv(kHandedVariable);
  const std::size_t line = std::min(text.find('\n'), text.size() - 1);
  take_held(text.substr(0, line));
  return text.substr(line + 1);
}

/// This program's own file, and its replacement by another version while the children run.
class OwnVersion {
 public:
  explicit OwnVersion(const bus::NodeOptions& options)
      : environment_(as_environment(options)), program_(program_folder() + "/saphira") {
    if (const char* const log = std::getenv(kLogVariable))
      environment_[kLogVariable] = log;
    unsetenv(kLogVariable);
  }

  /// The reason why this version stays, in words. Otherwise it does not return.
  std::string replace(const Supervisor& supervisor, const ServiceManager& manager) const {
    if (file_of(program_) == file_)
      return {};
    if (std::string why = other_contract(program_); !why.empty())
      return "the supervisor stays as it is: " + why;
    std::vector<std::string> words = own_words();
    words.emplace_back("--try");
    if (start_and_wait(words) != bus::kExitOk)
      return "the supervisor stays as it is: the new one does not take this deployment";
    words.pop_back();
    const std::string text = keep_held() + "\n" + supervisor.hand_over();
    const int handed = memfd_create("saphira", 0);
    if (handed < 0 || ::write(handed, text.data(), text.size()) != std::ssize(text))
      return "the supervisor stays as it is: no memory for the handover";
    flush_output();
    manager.restore();
    for (const auto& [name, value] : environment_)
      setenv(name.c_str(), value.c_str(), 1);
    setenv(kHandedVariable, std::to_string(handed).c_str(), 1);
    execv(program_.c_str(), pointers(words).data());
    return "the supervisor stays as it is: " + cannot_be(program_, "run");
  }

 private:
  int start_and_wait(std::vector<std::string>& words) const {
    const std::vector<char*> argv = pointers(words);
    const pid_t child = fork();
    if (child == 0) {
      for (const auto& [name, value] : environment_)
        setenv(name.c_str(), value.c_str(), 1);
      execv(program_.c_str(), argv.data());
      _exit(bus::kExitBroken);
    }
    int status = 0;
    const auto began = Clock::now();
    while (child > 0 && waitpid(child, &status, WNOHANG) == 0) {
      if (seconds_since(began) > kTried)
        kill(child, SIGKILL);
      poll(nullptr, 0, 20);
    }
    return child > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : bus::kExitBroken;
  }

  std::map<std::string, std::string> environment_;
  std::string program_;
  std::string file_ = file_of(program_);
};

/// A deployment's robot that has its programs already.
struct Taken {
  std::string program;  ///< in words
  bool here = false;    ///< on this machine
};

/// Looks for the deployment's programs on the bus. Those of this user are locked (ProgramLocks).
std::optional<Taken> taken(const Deployment& deployment, bus::NodeOptions options,
                           const bus::Stop& stop) {
  const RunningBus bus = bus_of(deployment, options);
  options = on_bus(bus, std::move(options));
  options.name = "saphira";
  options.lockstep = false;
  const std::vector<Running> own = running_deployments();
  if (std::ranges::any_of(own, [&](const Running& one) {
        return one.robot == bus.robot && one.domain == bus.domain;
      }))
    return std::nullopt;
  // A console or an agent of another person is no second robot.
  std::set<std::string> names{"all"};
  for (const runtime::Unit& unit : system::units())
    names.insert(unit.name);
  std::erase_if(names, [&](const std::string& name) {
    return std::ranges::none_of(deployment.programs,
                                [&](const Program& program) { return program.name == name; });
  });
  if (names.empty())
    return std::nullopt;
  bus::Node node(options);
  Processes processes(node);
  listen(
      node, stop, processes, [&] { processes.poll(); }, [&] { return processes.news(); });
  for (const SeenProcess& each : processes.all())
    if (names.contains(each.status.name) && each.age <= kLostAge)
      return Taken{each.status.name + " (process " + std::to_string(each.status.pid) + " at " +
                       each.status.host + ")",
                   each.status.host == node.status().host};
  return std::nullopt;
}

/// Two robots of one name would share goals and stops. Where the name was not chosen and another
/// user of this machine has it, the robot gets a name of its own; otherwise the words of a refusal.
std::string take_robot(const std::string& name, bool named, bus::NodeOptions& options,
                       const bus::Stop& stop) {
  const Deployment deployment = load_deployment(find_deployment(name, find_places()));
  std::optional<Taken> other = taken(deployment, options, stop);
  if (other && other->here && !named && !deployment.bus.robot) {
    const passwd* const user = getpwuid(getuid());
    const std::string before = options.robot;
    options.robot += "-" + (user == nullptr ? std::to_string(getuid()) : user->pw_name);
    complain("saphira: another user's robot has the name \"%s\": this one is \"%s\"\n",
             before.c_str(), options.robot.c_str());
    other = taken(deployment, options, stop);
  }
  if (!other)
    return {};
  return "robot \"" + deployment.bus.robot.value_or(options.robot) + "\" has " + other->program +
         " already: give this robot another name (robot: in " + deployment.file +
         ", or --robot NAME)";
}

int up(const std::string& name, const std::vector<std::string>& set,
       const bus::NodeOptions& options, const bus::Stop& stop) {
  const std::optional<std::string> handed_over = take_handed_over();
  Places places = find_places();
  const Deployment deployment = load_deployment(find_deployment(name, places));
  RunFolder folder = folder_of(deployment, options);
  places.run = folder.path();
  places.robot = options.robot;
  std::vector<std::string> left_out;
  std::vector<ChildSpec> children = command_lines_on(options, deployment, places, set, &left_out);
  ProgramLocks locks;
  for (const ChildSpec& child : children)
    if (!child.robot.empty())
      locks.hold(child.name, child.robot, deployment.bus.domain.value_or(options.domain),
                 deployment.file + " (process " + std::to_string(getpid()) + ")");

  if (!handed_over) {
    if (const std::string why = refusal(deployment, places, set, options); !why.empty()) {
      std::cerr << "saphira: " << why;
      return bus::kExitUsage;
    }
    for (const std::string& file : deployment.forget) {
      std::error_code gone;
      std::filesystem::remove(std::filesystem::path(folder.path()) / file, gone);
    }
  }

  std::optional<BoundedLog> log;
  if (const char* const file = std::getenv(kLogVariable))
    log.emplace(file, std::vector{STDOUT_FILENO, STDERR_FILENO}, kLongestLog);
  const OwnVersion own(options);
  out().outlast_full_disk();
  const ServiceManager manager;
  const RenewSignal renew;
  const Supervisor::Print print = prefixed(children);
  for (const std::string& text : left_out)
    print({}, text);
  Supervisor supervisor(std::move(children), print);
  if (handed_over)
    supervisor.take_over(*handed_over);
  else
    supervisor.start();
  const FoundBus found(bus_of(deployment, options));
  const std::string started =
      counted(supervisor.children().size(), "program") + " of " + deployment.file;
  print({}, handed_over ? std::string("the supervisor is the new version, ") + bus::version() +
                              "; the programs go on"
                        : started + " started; Ctrl-C stops them");
  manager.ready(started);
  const auto period = std::min(milliseconds(10000), manager.period().value_or(milliseconds(10000)));
  bool own_is_due = false;
  while (!stop.requested() && !supervisor.finished() && !supervisor.misused()) {
    supervisor.step(period, {stop.fd(), renew.fd()});
    if (renew.came()) {
      supervisor.renew(objection);
      own_is_due = true;
    }
    if (own_is_due && !supervisor.renews()) {
      own_is_due = false;
      if (const std::string stays = own.replace(supervisor, manager); !stays.empty())
        print({}, stays);
    }
    manager.alive();
    folder.tell();
    if (log)
      log->keep_bounded();
  }
  manager.stopping();
  const auto misused = supervisor.misused();
  supervisor.stop();
  if (misused) {
    print({}, *misused + " refuses the options of " + deployment.file + ": see above");
    return bus::kExitUsage;
  }
  print({}, "all stopped");
  return bus::kExitOk;
}

/// Of a new version, before it takes the place of a running one.
int try_up(const std::string& name, const std::vector<std::string>& set,
           const bus::NodeOptions& options) {
  Places places = find_places();
  const Deployment deployment = load_deployment(find_deployment(name, places));
  const std::string why = refusal(deployment, places, set, options);
  std::cerr << why;
  return why.empty() ? bus::kExitOk : bus::kExitUsage;
}

/// Starts this program again, without a terminal: its output goes to the log.
pid_t start_again(const std::string& name, const std::vector<std::string>& set,
                  const bus::NodeOptions& options, const std::string& path, int log) {
  std::vector<std::string> words{"saphira", "up", name};
  for (const std::string& one : set)
    words.insert(words.end(), {"--set", one});
  const std::vector<char*> argv = pointers(words);
  auto environment = as_environment(options);
  environment[kLogVariable] = path;
  const pid_t child = fork();
  if (child != 0)
    return child;
  for (const auto& [variable, value] : environment)
    setenv(variable.c_str(), value.c_str(), 1);
  setsid();
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing < 0 || dup2(nothing, 0) < 0 || dup2(log, 1) < 0 || dup2(log, 2) < 0)
    _exit(bus::kExitBroken);
  execv("/proc/self/exe", argv.data());
  _exit(bus::kExitBroken);
}

/// True once its programs are started.
bool is_found(const RunningBus& bus) {
  const std::vector<RunningBus> all = running_buses();
  return std::ranges::any_of(all, [&](const RunningBus& one) {
    return one.what == bus.what && one.robot == bus.robot && one.domain == bus.domain;
  });
}

/// Starts it in the background, and reports the result of the start.
int detach(const std::string& name, const std::vector<std::string>& set,
           const bus::NodeOptions& options, const bus::Stop& stop) {
  // Errors in the file or the settings are reported here, not in a log.
  Places places = find_places();
  const Deployment deployment = load_deployment(find_deployment(name, places));
  places.run = "/tmp";
  std::vector<std::string> left_out;
  command_lines(deployment, places, set, &left_out);
  for (const std::string& text : left_out)
    std::cerr << "saphira: " << text << '\n';
  const std::string running = name_of(deployment, options);
  const std::string log = log_of(running);
  {
    const RunFolder unheld = folder_of(deployment, options);
  }  // the log of a running one stays as it is
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0)
    throw std::runtime_error(cannot_be(log, "written"));
  const pid_t child =
      start_again(std::filesystem::absolute(deployment.file), set, options, log, file);
  close(file);
  const auto began = Clock::now();
  int status = 0;
  while (!stop.requested() && seconds_since(began) < kStarted) {
    if (waitpid(child, &status, WNOHANG) == child) {
      const std::string said = read_bytes(log);
      std::cerr << said << "saphira: it has ended; "
                << (said.empty() ? "nothing could be written to " : "all that it said is in ")
                << log << '\n';
      return WIFEXITED(status) ? WEXITSTATUS(status) : bus::kExitBroken;
    }
    for (const Running& one : running_deployments())
      if (one.name == running && one.pid == child && is_found(bus_of(deployment, options))) {
        std::cout << running << " runs (process " << child << "); its output: " << log
                  << "; saphira stop ends it\n";
        return bus::kExitOk;
      }
    poll(nullptr, 0, 20);
  }
  std::cerr << "saphira: it has not begun within " << kStarted << " s; see " << log << '\n';
  return bus::kExitFailed;
}

/// A deployment that a person means. Without a value: any.
struct Meant {
  std::string name;
  std::optional<std::string> robot;
  std::optional<unsigned> domain;
};

/// root: whose --robot and --domain, or their variables, were given.
Meant meant_by(const std::string& name, const CLI::App& root, const bus::NodeOptions& options) {
  Meant result{name, {}, {}};
  if (root.get_option("--robot")->count() > 0 && options.robot != kEveryRobot)
    result.robot = options.robot;
  if (root.get_option("--domain")->count() > 0)
    result.domain = options.domain;
  return result;
}

/// The running deployment that is meant, or the only one; nothing, with the reason on stderr,
/// where it is ambiguous. `code` is the program's exit code then.
std::optional<Running> running_one(const Meant& wanted, int& code) {
  const std::string& name = wanted.name;
  std::vector<Running> meant;
  std::string names;
  for (const Running& one : running_deployments()) {
    names += (names.empty() ? "" : ", ") + one.name;
    if ((name.empty() || one.name == name || one.name.starts_with(name + "-")) &&
        one.robot == wanted.robot.value_or(one.robot) &&
        one.domain == wanted.domain.value_or(one.domain))
      meant.push_back(one);
  }
  if (meant.size() != 1) {
    const std::string none = "no deployment" + (name.empty() ? "" : " " + name) +
                             (wanted.robot ? " of robot " + *wanted.robot : "") +
                             (wanted.domain ? " in domain " + std::to_string(*wanted.domain) : "");
    std::cerr << "saphira: "
              << (names.empty()   ? "no deployment of yours runs on this machine"
                  : meant.empty() ? none + " runs; there are: " + names
                                  : "several deployments run: say which one, " + names)
              << '\n';
    code = names.empty() || meant.empty() ? bus::kExitFailed : bus::kExitUsage;
    return std::nullopt;
  }
  return meant[0];
}

bool send(const Running& running, int signal) {
  if (kill(running.pid, signal) == 0)
    return true;
  std::cerr << "saphira: process " << running.pid
            << " cannot be reached: " << std::generic_category().message(errno) << '\n';
  return false;
}

int renew_running(const Meant& wanted) {
  int code = bus::kExitOk;
  const std::optional<Running> running = running_one(wanted, code);
  if (!running)
    return code;
  if (!send(*running, SIGUSR1))
    return bus::kExitFailed;
  std::cout << running->name << " takes in new versions of its programs, and says so where its "
            << "output goes\n";
  return bus::kExitOk;
}

int stop_running(const Meant& wanted, const bus::Stop& stop) {
  int code = bus::kExitOk;
  const std::optional<Running> running = running_one(wanted, code);
  if (!running)
    return code;
  if (!send(*running, SIGTERM))
    return bus::kExitFailed;
  const auto began = Clock::now();
  while (!stop.requested() && seconds_since(began) < kStopped) {
    const auto left = running_deployments();
    if (std::ranges::none_of(left, [&](const Running& one) { return one.name == running->name; })) {
      std::cout << running->name << " has stopped\n";
      return bus::kExitOk;
    }
    poll(nullptr, 0, 50);
  }
  return failed(running->name + " (process " + std::to_string(running->pid) +
                ") has not stopped within " + plain(kStopped) + " s");
}

}  // namespace

void add_stop(CLI::App& app, Chosen& chosen) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("stop", "Stop a deployment that saphira up has started");
  chosen.reach[command] = {};
  chosen.apart.insert(command);
  command->add_option("deployment", *name, "such as demo; needed where several run");
  chosen.when(command, [&app, name](const bus::NodeOptions& options, const bus::Stop& stop) {
    return stop_running(meant_by(*name, app, options), stop);
  });
}

void add_renew(CLI::App& app, Chosen& chosen) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "renew", "Let a deployment take in new versions of its programs, one after the other");
  chosen.reach[command] = {};
  chosen.apart.insert(command);
  command->add_option("deployment", *name, "such as demo; needed where several run");
  chosen.when(command, [&app, name](const bus::NodeOptions& options, const bus::Stop&) {
    return renew_running(meant_by(*name, app, options));
  });
}

void add_up(CLI::App& app, Chosen& chosen) {
  struct Options {
    std::string deployment;
    std::vector<std::string> set;
    bool detached = false;
    bool tried = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("up", "Start and supervise what a deployment file lists");
  chosen.apart.insert(command);
  command->add_option("deployment", options->deployment, "a file, or a shipped one such as demo")
      ->required();
  command->add_option("--set", options->set, "name=value: a setting of the deployment")
      ->take_all()
      ->type_size(1);
  command->add_flag("--detach,-d", options->detached, "in the background; saphira stop ends it");
  command->add_flag("--try", options->tried, "starts nothing")->group("");
  chosen.when(command, [options, &app](bus::NodeOptions node, const bus::Stop& stop) -> int {
    if (options->tried)
      return try_up(options->deployment, options->set, node);
    if (std::getenv(kHandedVariable) != nullptr)
      return up(options->deployment, options->set, node, stop);
    const bool named = app.get_option("--robot")->count() > 0;
    if (const std::string why = take_robot(options->deployment, named, node, stop); !why.empty()) {
      complain("saphira: %s\n", why.c_str());
      return bus::kExitFailed;
    }
    return (options->detached ? detach : up)(options->deployment, options->set, node, stop);
  });
}

}  // namespace saphira::cli
