#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "trouble.hpp"

/// The common parts of tests of whole programs: processes, temporary folders, waiting.
namespace saphira::test {

/// Calls `condition` until it is true or the time is up; returns its last result. The limit is for
/// broken runs only, so be generous.
bool wait_until(const std::function<bool()>& condition,
                std::chrono::milliseconds limit = std::chrono::seconds(30));

/// A folder that is removed with the object.
class TempDir {
 public:
  TempDir();
  ~TempDir();
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;
  std::string path(const std::string& name = {}) const;

 private:
  std::string path_;
};

/// A child process; killed with its object. Its output (both streams) goes to a file.
///
/// In a test, every simulator that it is or starts has the strict protocol checker on its lines,
/// and violations fail the test at the object's end.
class Process {
 public:
  /// argv[0] without a slash is one of the project's programs. `environment` is added to our own.
  Process(std::vector<std::string> argv, std::string output_file,
          const std::map<std::string, std::string>& environment = {});
  ~Process();
  Process(Process&& other) noexcept;
  Process& operator=(Process&&) = delete;
  Process(const Process&) = delete;

  pid_t pid() const { return pid_; }
  void signal(int number) const;
  bool running();
  /// The exit code (128 + number after a signal), or nothing while it still runs.
  std::optional<int> wait(std::chrono::milliseconds limit = std::chrono::seconds(60));
  /// The output so far.
  std::string output() const;

  /// The violations found so far, a line each.
  std::string violations() const;
  /// The test damages the line: violations are no failure.
  void expect_violations() { violations_expected_ = true; }

  /// The function that gets the violations and the findings of a sanitizer; without it there is no
  /// check. Each test sets it (checked.cpp).
  static void (*complain)(const std::string& found);

 private:
  /// All output of the checker: findings, and a summary for each closed connection.
  std::string checked() const;

  pid_t pid_ = -1;
  std::optional<int> status_;
  std::string output_file_;
  std::string check_file_;        // empty: no check
  std::size_t check_begins_ = 0;  // end of an earlier process's entries
  bool violations_expected_ = false;
};

/// A program that has ended: its exit code, below 0 where it has not, and all that it said.
struct Outcome {
  int code = -1;
  std::string text;
};
Outcome run(const std::vector<std::string>& argv,
            const std::map<std::string, std::string>& environment = {},
            std::chrono::milliseconds limit = std::chrono::seconds(60));
/// `saphira` with these words.
Outcome saphira(std::vector<std::string> words,
                const std::map<std::string, std::string>& environment = {},
                std::chrono::milliseconds limit = std::chrono::seconds(60));

/// A program of this build, such as saphira-bridge; a file of the source tree, such as
/// config/robots.
std::string program(const std::string& name);
std::string source(const std::string& path);
/// The DDS domain that this test may use.
std::string domain();
/// A robot (partition) of this test alone.
std::string unique_robot();

/// Installs this build, or one component of it, below `prefix`; returns the error, or nothing. One
/// at a time on a machine, since unstripped files take ten times the room.
std::string install_build(const std::string& prefix, const std::string& component = {});

}  // namespace saphira::test
