#pragma once

#include <memory>

#include "../src/robot.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::c {

/// The robot of the options on the bus, or on one in memory.
std::unique_ptr<Robot> robot_on_bus(bus::NodeOptions options, Say say,
                                    std::shared_ptr<bus::MemoryBus> memory = nullptr);

}  // namespace saphira::c
