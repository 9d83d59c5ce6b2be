#pragma once

#include <string>
#include <utility>
#include <vector>

#include "saphira/bus/goal_client.hpp"

namespace saphira::test {

inline v1::Goal goal(const std::string& functor, std::vector<v1::Argument> arguments = {}) {
  return {.functor = functor, .arguments = std::move(arguments)};
}

}  // namespace saphira::test
