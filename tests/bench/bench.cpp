#include "bench.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "saphira/base/places.hpp"

namespace saphira::bench {

namespace {

/// A name without a folder is one of the project's programs.
std::vector<std::string> located(std::vector<std::string> argv) {
  if (argv.at(0).find('/') == std::string::npos)
    argv[0] = program_folder() + "/" + argv[0];
  return argv;
}

}  // namespace

Child::Child(std::vector<std::string> argv) : Process(located(std::move(argv)), "/dev/null") {}

std::string output_of(const std::vector<std::string>& argv) {
  std::vector<std::string> words = located(argv);
  words.insert(words.begin(), {"/bin/sh", "-c", "exec \"$0\" \"$@\" 2>/dev/null"});
  const test::TempDir folder;
  test::Process process(words, folder.path("said"));
  siginfo_t ended{};
  waitid(P_PID, static_cast<id_t>(process.pid()), &ended, WEXITED | WNOWAIT);  // nothing polls
  if (process.wait() != 0)
    throw std::runtime_error(argv[0] + " failed: " + process.output());
  return process.output();
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

}  // namespace saphira::bench
