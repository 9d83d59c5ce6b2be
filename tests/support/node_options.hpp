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

/// For a node on a domain: the test's own, unless another is given.
inline bus::NodeOptions node_options(const std::string& name, const std::string& robot,
                                     bool lockstep = false,
                                     const std::string& on_domain = domain()) {
  bus::NodeOptions options = memory_options(name, lockstep);
  options.robot = robot;
  options.domain = static_cast<std::uint32_t>(std::stoul(on_domain));
  return options;
}

}  // namespace saphira::test
