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
  kWalkedInto,  ///< the robot stood, or moved away: the other one came
  kUnseen,      ///< the robot moved towards the thing, but no sonar could have heard it in time
};

enum class ThingKind { kPerson, kPost, kBox, kDoor, kRobot, kWall };

struct Contact {
  std::uint64_t tick = 0;  ///< of the scene
  ThingKind kind = ThingKind::kWall;
  std::string name;  ///< as in the world file; of a robot its number, of a wall none
  Blame blame = Blame::kCaused;
  double towards = 0.0;  ///< [m/s] of the robot's hull towards the thing
  double heard = 0.0;    ///< [s] before, with the object in the main lobe of some sonar
  double needed = 0.0;   ///< [s] of that needed to avoid the contact
  Vec2 at_in_world{0.0, 0.0};
};

/// The robot passed near an object without slowing down.
struct NearContact {
  std::uint64_t tick = 0;
  ThingKind kind = ThingKind::kWall;
  std::string name;
  double gap = 0.0;    ///< [m] at that tick
  double speed = 0.0;  ///< [m/s] of the robot by a person, towards any other thing
};

struct ContactSettings {
  double touch = 0.002;     ///< [m] a smaller gap is a contact...
  double apart = 0.05;      ///< [m] ...which has ended when the gap is larger than this
  double towards = 0.05;    ///< [m/s] a slower robot is not to blame
  double at_rest = 0.3;     ///< [s] nor one that has stood this long
  double reaction = 0.6;    ///< [s] from the sound to the brakes, at worst
  double near_gap = 0.1;    ///< [m]
  double near_speed = 0.2;  ///< [m/s]
  // The true range for a sonar, heard or not.
  double lobe = radians(9.0);  ///< [rad] to either side of the axis
  double least_range = 0.2;    ///< [m]
  double most_range = 2.0;     ///< [m]
  double memory = 10.0;        ///< [s] older readings do not count
};

/// Watches one robot of a scene and judges its contacts, by the true state.
class ContactWatch {
 public:
  /// The scene outlives this object.
  ContactWatch(const Scene& scene, RobotNumber robot, const protocol::RobotParameters& parameters,
               const ContactSettings& settings = {});

  /// After every tick of the scene (Scene::set_watch).
  void tick();

  const std::vector<Contact>& contacts() const { return contacts_; }
  const std::vector<NearContact>& near_contacts() const { return near_contacts_; }
  std::size_t count(Blame blame) const;
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
    bool near = false;
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
  ContactSettings settings_;
  mutable Neighbourhood near_;
  std::deque<Past> past_;
  std::vector<State> states_;
  std::vector<Contact> contacts_;
  std::vector<NearContact> near_contacts_;
  double velocity_ = 0.0;  // [m/s] at the end of the last tick
  double stood_ = 0.0;     // [s]
  double closest_person_ = std::numeric_limits<double>::infinity();
};

}  // namespace saphira::sim
