#pragma once

#include "saphira/idl/agents.hpp"
#include "saphira/idl/map.hpp"
#include "saphira/idl/perception.hpp"
#include "saphira/idl/robot.hpp"
#include "saphira/idl/vision.hpp"
#include "saphira/mcp/session.hpp"

namespace saphira::mcp {

/// The newest samples about the robot's place. Null: not heard.
struct Surroundings {
  const v1::RobotState* robot = nullptr;
  const v1::SonarBuckets* sonars = nullptr;
  const v1::Registration* registration = nullptr;
  const v1::FloorMap* map = nullptr;
  const v1::Perception* perception = nullptr;
  const v1::Vision* vision = nullptr;
};

/// The robot's pose on the map, the places that have a name, nearest first, and the closed doors.
Result map_of(const Surroundings& around);

/// The walls, doors, people and echoes around the robot, nearest first: distance [m], direction,
/// and place in the frame `robot` [m].
Result view_of(const Surroundings& around);

/// The facts that people told the robot: number, words, speaker and time. Null: not heard.
Result facts_of(const v1::Knowledge* knowledge);

}  // namespace saphira::mcp
