#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <vector>

#include "saphira/protocol/parameters.hpp"
#include "saphira/sim/scene.hpp"

namespace saphira::sim {

/// The cause of a contact.
enum class Blame {
  kCaused,      ///< the robot moved towards the thing, and could have heard it in time
  kWalkedInto,  ///< the robot stood, or did not move towards it: the other one came
  kUnseen,      ///< the robot moved towards the thing, but no sonar could have heard it in time
};

enum class ThingKind { kPerson, kPost, kBox, kDoor, kRobot, kWall };

struct Contact {
  std::uint64_t tick = 0;  ///< of the scene
  ThingKind kind = ThingKind::kWall;
  bool walks = false;  ///< a person who walks about in this world; else one who stands
  std::string name;    ///< as in the world file; of a robot its number, of a wall none
  Blame blame = Blame::kCaused;
  double towards = 0.0;  ///< [m/s] of the robot's hull towards the thing
  double heard = 0.0;    ///< [s] before, with the object in the main lobe of some sonar
  double needed = 0.0;   ///< [s] of that needed to avoid the contact
  Vec2 at_in_world{0.0, 0.0};
};

/// Watches one robot of a scene and judges its contacts, by the true state.
class ContactWatch {
 public:
  /// The scene outlives this object.
  ContactWatch(const Scene& scene, RobotNumber robot, const protocol::RobotParameters& parameters);

  /// After every tick of the scene.
  void tick();

  const std::vector<Contact>& contacts() const { return contacts_; }
  /// [m] The smallest gap to a person so far; infinite where there are none.
  double closest_person() const { return closest_person_; }

 private:
  struct Thing {
    ThingKind kind = ThingKind::kWall;
    std::size_t number = 0;  // of its kind
    Vec2 nearest{0.0, 0.0};  // its nearest point to the robot
    double gap = std::numeric_limits<double>::infinity();
  };
  // The present contact with it.
  struct State {
    ThingKind kind = ThingKind::kWall;
    std::size_t number = 0;
    bool touches = false;
  };
  // The past, as far back as it counts.
  struct Past {
    Pose robot_in_world;
    std::vector<Vec2> persons;  // two shins each
  };

  void remember();
  std::vector<Thing> things() const;
  State& state_of(const Thing& thing);
  void judge(const Thing& thing);
  Contact blame(const Thing& thing, double towards) const;
  double heard(const Thing& thing) const;
  bool in_a_lobe(const Pose& robot, const Vec2& point) const;
  std::string name_of(const Thing& thing) const;

  const Scene* scene_;
  RobotNumber robot_;
  protocol::RobotParameters parameters_;
  double most_range_;  // [m] of a sonar, heard or not
  mutable Neighbourhood near_;
  std::deque<Past> past_;
  std::vector<State> states_;
  std::vector<Contact> contacts_;
  double velocity_ = 0.0;  // [m/s] at the end of the last tick
  double stood_ = 0.0;     // [s]
  double closest_person_ = std::numeric_limits<double>::infinity();
};

}  // namespace saphira::sim
