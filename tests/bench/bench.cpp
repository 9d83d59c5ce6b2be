#include "bench.hpp"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "saphira/base/places.hpp"

namespace saphira::bench {

namespace fs = std::filesystem;

namespace {

/// Starts argv; stdout goes to `out`, or nowhere.
pid_t start(std::vector<std::string> argv, int out, int network) {
  if (argv.at(0).find('/') == std::string::npos)
    argv[0] = program_folder() + "/" + argv[0];
  std::vector<char*> pointers;
  pointers.reserve(argv.size() + 1);
  for (std::string& word : argv)
    pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t pid = fork();
  if (pid < 0)
    throw std::runtime_error("fork failed");
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (network >= 0 && setns(network, CLONE_NEWNET) != 0)
      _exit(126);
    const int null = open("/dev/null", O_RDWR);
    dup2(null, 0);
    dup2(out < 0 ? null : out, 1);
    dup2(null, 2);
    execv(pointers[0], pointers.data());
    _exit(127);
  }
  return pid;
}

}  // namespace

Child::Child(std::vector<std::string> argv, int network)
    : pid_(start(std::move(argv), -1, network)) {}

Child::~Child() {
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

std::string output_of(const std::vector<std::string>& argv, int network) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error("pipe failed");
  const pid_t pid = start(argv, ends[1], network);
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n = 0; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(pid, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    std::string line;
    for (const std::string& word : argv)
      line.append(word).append(" ");
    throw std::runtime_error(line + "failed");
  }
  return text;
}

double cpu_seconds(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::size_t end = text.rfind(')');
  if (end == std::string::npos)
    return 0.0;
  std::istringstream fields(text.substr(end + 2));
  std::string skipped;
  for (int i = 0; i < 11; ++i)
    fields >> skipped;
  double user = 0.0;
  double system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double resident_mb(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/statm");
  double total = 0.0;
  double resident = 0.0;
  in >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

double proportional_mb(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/smaps_rollup");
  double kilobytes = 0.0;
  for (std::string word; in >> word;)
    if (word == "Pss:")
      in >> kilobytes;
  return kilobytes * 1024.0 / 1e6;
}

std::vector<pid_t> family(pid_t pid) {
  std::vector<pid_t> all{pid};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string process = std::to_string(all[i]);
    std::ifstream in("/proc/" + process + "/task/" + process + "/children");
    for (pid_t child = 0; in >> child;)
      all.push_back(child);
  }
  return all;
}

std::string name_of(pid_t pid) {
  std::error_code error;
  return fs::read_symlink("/proc/" + std::to_string(pid) + "/exe", error).filename().string();
}

}  // namespace saphira::bench
