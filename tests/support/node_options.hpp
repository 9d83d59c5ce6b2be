#pragma once

#include <cstdint>
#include <string>

#include "process.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::test {

/// For a node on a bus in memory.
inline bus::NodeOptions memory_options(const std::string& name, bool lockstep = false) {
  bus::NodeOptions options;
  options.name = name;
  options.lockstep = lockstep;
  return options;
}

/// For a node of a test on the test's own domain.
inline bus::NodeOptions node_options(const std::string& name, const std::string& robot) {
  bus::NodeOptions options;
  options.name = name;
  options.robot = robot;
  options.domain = static_cast<std::uint32_t>(std::stoul(domain()));
  return options;
}

}  // namespace saphira::test
