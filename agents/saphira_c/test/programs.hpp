#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "process.hpp"
#include "saphira/sim/trace.hpp"

namespace saphira {
namespace test {

/// The component saphira_c of this build, installed once for all tests of the process.
inline const std::string& prefix() {
  static const TempDir folder;
  static const std::string path = [] {
    std::string to = folder.path("installed");
    EXPECT_EQ(install_build(to, "saphira_c"), "");
    return to;
  }();
  return path;
}

/// The program gets the library's sanitizer.
inline std::string sanitized() {
  const std::string which = SANITIZE;
  return which.empty() ? "" : " -g -fsanitize=" + which;
}

/// A program, compiled by the system's compiler against the installed library.
inline std::string compiled(const std::string& file, const TempDir& dir, bool cpp,
                            const std::string& options = "") {
  std::string out = dir.path("program");
  Process compile({"/bin/sh", "-c",
                   std::string(cpp ? "c++ -x c++" : "cc -x c -std=c11") + sanitized() +
                       " -Wall -Wextra -Wno-main " + options + " '" + file + "' -x none -o '" +
                       out + "' $(PKG_CONFIG_PATH=$(dirname $(find " + prefix() +
                       " -name saphira.pc)) pkg-config --cflags --libs saphira)"},
                  dir.path("compiler"));
  EXPECT_EQ(compile.wait(), std::optional<int>(0)) << compile.output();
  return out;
}

/// A simulator and a program that drives in it.
class Programs : public testing::Test {
 protected:
  /// `things`: further things in the world, in the form of its file.
  /// `rate`: times real time. `line`: the option for its end of the line.
  void simulate(const std::string& position = "19000 19000 0", const std::string& world = "simple",
                const std::string& things = "", const std::string& rate = "4",
                const std::string& line = "--socket") {
    std::vector<std::string> argv{
        "saphira-sim",          "--world", world, "--position", position, line, socket(), "--trace",
        dir_.path("trace.csv"), "--seed",  "3",   "--rate",     rate};
    if (!things.empty()) {
      std::ofstream(dir_.path("things.wld")) << things << "\n";
      argv.insert(argv.end(), {"--things", dir_.path("things.wld")});
    }
    simulator_.emplace(argv, dir_.path("sim"));
    ASSERT_TRUE(wait_until([this] { return ::access(socket().c_str(), F_OK) == 0; }));
  }
  /// Compiles as C++ for a check, and as C for the run.
  std::string build(const std::string& file) {
    compiled(file, dir_, true);
    return compiled(file, dir_, false);
  }
  std::string example(const std::string& name) {
    return build(source("agents/saphira_c/examples/" + name + ".c"));
  }
  std::string written(const std::string& text) {
    const std::string path = dir_.path("program.c");
    std::ofstream(path) << "#include \"saphira.h\"\n" << text;
    return build(path);
  }
  Process start(const std::string& program) {
    return Process({program}, dir_.path("out"),
                   {{"ROBOT_SOCKET", socket()}, {"SAPHIRA_COM1", socket()}});
  }
  std::vector<sim::TraceRow> truth() const {
    std::ifstream in(dir_.path("trace.csv"));
    std::stringstream text;
    text << in.rdbuf();
    return sim::parse_trace(text.str(), "trace");
  }
  /// The greatest way along the heading of the start [m].
  double farthest() const {
    double most = 0.0;
    const std::vector<sim::TraceRow> rows = truth();
    for (const sim::TraceRow& row : rows)
      most = std::max(most, std::hypot(row.pose_in_world.x - rows[0].pose_in_world.x,
                                       row.pose_in_world.y - rows[0].pose_in_world.y));
    return most;
  }
  bool stands() const {
    const std::vector<sim::TraceRow> rows = truth();
    return !rows.empty() && rows.back().velocity == 0.0 && rows.back().rotation_velocity == 0.0;
  }
  bool moves() const {
    const std::vector<sim::TraceRow> rows = truth();
    return !rows.empty() && rows.back().velocity > 0.1;
  }
  std::string socket() const { return dir_.path("robot"); }

  TempDir dir_;
  std::optional<Process> simulator_;
};

}  // namespace test
}  // namespace saphira
