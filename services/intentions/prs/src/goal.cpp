#include "saphira/intentions/goal.hpp"

#include <cstdio>

namespace saphira::intentions {

std::string describe(const GoalId& id) {
  char text[48];
  std::snprintf(text, sizeof text, "%llx:%llu", static_cast<unsigned long long>(id.writer),
                static_cast<unsigned long long>(id.number));
  return text;
}

}  // namespace saphira::intentions
