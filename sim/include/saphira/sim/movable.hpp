#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/text.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::sim {

// The things of a world file that are not walls; README, "Worlds". Positions in the world.

/// Their heights without the directive tall [m].
inline constexpr double kPersonHeight = 1.75;
inline constexpr double kDoorHeight = 2.0;
inline constexpr double kBoxHeight = 0.5;
inline constexpr double kPostHeight = 0.5;
/// Walls, which have no such directive.
inline constexpr double kWallHeight = 2.5;

/// The appearance of a thing to vision.
struct Look {
  std::string name;
  std::string color;    ///< directive color; empty: none for the cameras
  double height = 0.0;  ///< [m]
  /// Directive cloth [dB]: the absorption of the thing's surface; without it a person has that of
  /// all people's clothes (SonarModel::cloth), another thing none.
  std::optional<double> cloth;
};

/// A person who walks by a script.
struct PersonPlan {
  struct Leg {
    Vec2 to{0.0, 0.0};               ///< the target, unless speed is 0
    double speed = 0.0;              ///< [m/s]; 0: waits
    double wait = 0.0;               ///< [s]
    bool leads = false;              ///< walks while a robot is near, and waits for one otherwise
    std::optional<double> points{};  ///< [rad] stretches out an arm that way while waiting
  };
  Look look;
  Vec2 at{0.0, 0.0};
  double radius = 0.25;  ///< [m]
  std::vector<Leg> script;
  bool repeats = false;
  bool stubborn = false;  ///< stops before robots, and steps aside for none
};

/// A door that turns about its hinge.
struct DoorPlan {
  struct Event {
    double time = 0.0;  ///< [s]
    bool open = false;
  };
  Look look;
  Vec2 hinge{0.0, 0.0};
  Vec2 end{0.0, 0.0};  ///< the other one, while it is closed
  double swing = 0.0;  ///< [rad] opening angle, positive to the left
  std::vector<Event> schedule;
  double period = 0.0;  ///< [s] after which the schedule begins again; 0: never
};

/// A box on the floor that a robot can push.
struct BoxPlan {
  Look look;
  Pose pose_in_world;   ///< of its middle
  double length = 0.0;  ///< [m] along its x
  double width = 0.0;   ///< [m]
  double mass = 0.0;    ///< [kg]
};

/// A fixed round thing: a bin, a ball, a coloured can.
struct PostPlan {
  Look look;
  Vec2 at{0.0, 0.0};
  double radius = 0.0;  ///< [m]
};

struct MovablePlans {
  std::vector<PersonPlan> persons;
  std::vector<DoorPlan> doors;
  std::vector<BoxPlan> boxes;
  std::vector<PostPlan> posts;
  std::vector<Pose> robots;  ///< directive robot: starts of the second robot, the third, ...
};

/// Reads directives of a world file into plans.
class MovableReader {
 public:
  /// Reads the rest of the directive `word`, whose coordinates are relative to `frame_in_world`.
  /// False for any other directive. FileError where it is wrong.
  bool read(std::string_view word, LineReader& in, const Pose& frame_in_world);

  const MovablePlans& plans() const { return plans_; }

 private:
  enum class Last { kNone, kPerson, kDoor, kBox, kPost };

  Look read_look(LineReader& in, double height);
  Look& last_look(LineReader& in, std::string_view word);

  MovablePlans plans_;
  Last last_ = Last::kNone;
};

}  // namespace saphira::sim
