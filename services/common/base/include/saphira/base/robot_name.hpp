#pragma once

#include <string>

namespace saphira {

/// The error of a robot's name, in words; empty: none. A name goes to the bus as it is, where a
/// wildcard would mean every robot.
std::string trouble_of_robot(const std::string& name);

}  // namespace saphira
