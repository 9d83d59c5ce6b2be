#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "process.hpp"

namespace saphira::test {

/// This build, installed to a separate folder: the project for third parties.
class Installed {
 public:
  Installed() { EXPECT_EQ(install_build(prefix()), ""); }

  std::string prefix() const { return dir_.path("installed"); }
  std::string program(const std::string& name) const { return prefix() + "/bin/" + name; }
  std::string path(const std::string& name) const { return dir_.path(name); }

  /// Configures and builds a project of the source tree against the installed tree; returns the
  /// build folder.
  std::string build(const std::string& project) const {
    std::string folder = dir_.path("build");
    const std::string sanitize = cached("SAPHIRA_SANITIZE");
    run({"/usr/bin/env", "cmake", "-S", source(project), "-B", folder, "-G", "Ninja",
         "-DCMAKE_PREFIX_PATH=" + prefix(), "-DCMAKE_CXX_COMPILER=" + cached("CMAKE_CXX_COMPILER"),
         "-DCMAKE_CXX_FLAGS=" + (sanitize.empty() ? "" : "-fsanitize=" + sanitize)});
    run({"/usr/bin/env", "cmake", "--build", folder});
    return folder;
  }

  static std::string build_folder() {
    const char* const folder = std::getenv("SAPHIRA_BUILD_DIR");
    return folder == nullptr ? "" : folder;
  }

  /// An entry of the CMake cache of this build, so that others are built the same way.
  static std::string cached(const std::string& name) {
    std::ifstream cache(build_folder() + "/CMakeCache.txt");
    for (std::string line; std::getline(cache, line);) {
      if (line.starts_with(name + ":"))
        return line.substr(line.find('=') + 1);
    }
    return {};
  }

 private:
  void run(const std::vector<std::string>& command) const {
    Process process(command, dir_.path("log"));
    ASSERT_EQ(process.wait(std::chrono::minutes(5)), std::optional<int>(0)) << process.output();
  }

  TempDir dir_;
};

}  // namespace saphira::test
