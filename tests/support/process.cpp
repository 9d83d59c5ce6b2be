#include "process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace saphira::test {

namespace {

// See LineCheck of the simulator.
constexpr char kCheck[] = "SAPHIRA_CHECK";

std::string read_file(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr)
    throw std::runtime_error(std::string(name) + " is not set: run this test by ctest");
  return value;
}

}  // namespace

bool wait_until(const std::function<bool()>& condition, std::chrono::milliseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end)
      return condition();
    poll(nullptr, 0, 2);
  }
  return true;
}

TempDir::TempDir() {
  std::string name = (std::filesystem::temp_directory_path() / "saphira-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw std::runtime_error("no temporary folder");
  path_ = name;
}

TempDir::~TempDir() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string TempDir::path(const std::string& name) const {
  return name.empty() ? path_ : path_ + "/" + name;
}

Process::Process(std::vector<std::string> argv, std::string output_file,
                 const std::map<std::string, std::string>& environment)
    : output_file_(std::move(output_file)) {
  if (argv.at(0).find('/') == std::string::npos)
    argv[0] = program(argv[0]);
  if (complain != nullptr && !environment.contains(kCheck)) {
    check_file_ = output_file_ + ".check";
    check_begins_ = read_file(check_file_).size();
  }
  std::vector<char*> pointers;
  pointers.reserve(argv.size() + 1);
  for (std::string& word : argv)
    pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0)
    throw std::runtime_error("fork failed");
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
      _exit(127);
    const int out = open(output_file_.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    const int in = open("/dev/null", O_RDONLY);
    dup2(in, 0);
    dup2(out, 1);
    dup2(out, 2);
    for (const auto& [name, value] : environment)
      setenv(name.c_str(), value.c_str(), 1);
    if (!check_file_.empty())
      setenv(kCheck, check_file_.c_str(), 1);
    execv(pointers[0], pointers.data());
    _exit(127);
  }
}

Process::Process(Process&& other) noexcept
    : pid_(other.pid_),
      status_(other.status_),
      output_file_(std::move(other.output_file_)),
      check_file_(std::move(other.check_file_)),
      check_begins_(other.check_begins_),
      violations_expected_(other.violations_expected_) {
  other.pid_ = -1;
  other.check_file_.clear();
}

Process::~Process() {
  if (pid_ > 0 && running()) {
    kill(pid_, SIGCONT);
    kill(pid_, SIGTERM);
    if (!wait(std::chrono::seconds(10))) {
      kill(pid_, SIGKILL);
      wait();
    }
  }
  if (complain == nullptr || output_file_.empty())
    return;
  if (const std::string found = violations(); !found.empty() && !violations_expected_)
    complain("against the robots' protocol:\n" + found);
  // A killed program's exit code does not show the cause.
  const std::string said = output();
  if (const std::size_t at = said.find("Sanitizer:"); at != std::string::npos)
    complain(said.substr(said.rfind('\n', at) + 1, 4000));
}

void Process::signal(int number) const {
  kill(pid_, number);
}

bool Process::running() {
  return !wait(std::chrono::milliseconds(0)).has_value();
}

std::optional<int> Process::wait(std::chrono::milliseconds limit) {
  wait_until(
      [this] {
        int status = 0;
        if (!status_ && waitpid(pid_, &status, WNOHANG) == pid_)
          status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return status_.has_value();
      },
      limit);
  return status_;
}

std::string Process::output() const {
  return read_file(output_file_);
}

void (*Process::complain)(const std::string& violations) = nullptr;

std::string Process::checked() const {
  if (check_file_.empty())
    return {};
  const std::string all = read_file(check_file_);
  return all.substr(std::min(check_begins_, all.size()));
}

std::string Process::violations() const {
  std::istringstream lines(checked());
  std::string found;
  for (std::string line; std::getline(lines, line);)
    if (line.find(": violation: ") != std::string::npos)
      found += line + "\n";
  return found;
}

Outcome run(const std::vector<std::string>& argv,
            const std::map<std::string, std::string>& environment,
            std::chrono::milliseconds limit) {
  const TempDir folder;
  Process process(argv, folder.path("said"), environment);
  const int code = process.wait(limit).value_or(-1);
  return {code, process.output()};
}

Outcome saphira(std::vector<std::string> words,
                const std::map<std::string, std::string>& environment,
                std::chrono::milliseconds limit) {
  words.insert(words.begin(), "saphira");
  return run(words, environment, limit);
}

std::string program(const std::string& name) {
  return environment("SAPHIRA_BIN_DIR") + "/" + name;
}
std::string source(const std::string& path) {
  return environment("SAPHIRA_SOURCE_DIR") + "/" + path;
}
std::string domain() {
  return environment("SAPHIRA_DOMAIN");
}

std::string unique_robot() {
  static int count = 0;
  return "t" + std::to_string(getpid()) + "n" + std::to_string(++count);
}

std::string install_build(const std::string& prefix, const std::string& component) {
  const std::string build = std::getenv("SAPHIRA_BUILD_DIR");
  std::vector<std::string> command{"/usr/bin/env", "flock",     build + "/install.lock",
                                   "cmake",        "--install", build,
                                   "--strip",      "--prefix",  prefix};
  if (!component.empty())
    command.insert(command.end(), {"--component", component});
  const TempDir folder;
  Process install(command, folder.path("log"));
  const std::optional<int> code = install.wait(std::chrono::minutes(5));
  if (code == 0)
    return {};
  std::string said = code ? "exit code " + std::to_string(*code) : "not done in five minutes";
  std::istringstream lines(install.output());
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("-- "))
      said += "\n" + line;
  }
  return said;
}

}  // namespace saphira::test
