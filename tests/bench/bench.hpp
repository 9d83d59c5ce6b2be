#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "study.hpp"
#include "support/process.hpp"

/// The common parts of the benchmark programs.
namespace saphira::bench {

/// A child with its output dropped; terminated with the object.
class Child : public test::Process {
 public:
  explicit Child(std::vector<std::string> argv);
};

/// Runs a program to its end and returns its stdout; std::runtime_error when it fails.
std::string output_of(const std::vector<std::string>& argv);

/// CPU seconds of a process, and its resident memory [MB]. 0 when it is gone.
double cpu_seconds(pid_t pid);
double resident_mb(pid_t pid);
/// [MB] The proportional set size of a process; 0 when it is gone.
double proportional_mb(pid_t pid);
/// The process and all its descendants.
std::vector<pid_t> family(pid_t pid);

}  // namespace saphira::bench
