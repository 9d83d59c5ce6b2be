#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/registration/object_finder.hpp"
#include "saphira/registration/particle_cloud.hpp"
#include "saphira/registration/presence.hpp"
#include "saphira/registration/registration.hpp"
#include "saphira/registration/search.hpp"
#include "saphira/registration/standing.hpp"

namespace saphira::registration {

/// The whole learnt state of a Registration, without data that follow from its map or settings.
/// State that a step leaves for a later one belongs here: a map edit keeps this whole, so that no
/// member can be forgotten.
struct RegistrationState {
  /// A matched percept.
  struct Done {
    std::uint32_t percept = 0;
    std::uint64_t cycle = 0;
    Pose pose_in_odom;  ///< of the robot
    double width = 0.0;
    double length = 0.0;
  };

  explicit RegistrationState(const Settings& settings)
      : trial(settings.trial / 2.0),
        cloud(settings.cloud),
        presence(settings.presence),
        objects(settings.objects) {}

  SAPHIRA_ARCHIVE(on, state, filter, confirmed, doubted, carried, start, other_map, cycle, odom,
                  pose_in_odom, moved, way, turned, turns, done, used, since_readings, trial,
                  weighed, lead, cloud_score, leads, led, cloud, search, standing, presence,
                  sure_closed, agreed, objects, output)

  bool on = true;
  v1::RegistrationState state = v1::REGISTRATION_UNPLACED;
  std::optional<PoseFilter> filter;
  /// The readings have fitted the pose since it was given.
  bool confirmed = false;
  /// Dead reckoning has begun anew: the robot may have been carried, and the pose is a guess until
  /// the readings have fitted it.
  bool doubted = false;
  /// The readings at a standstill have changed as if it was carried; nothing has confirmed the pose
  /// since.
  bool carried = false;
  std::optional<Pose> start;  ///< the alternative pose
  /// Another map was loaded, and since then no reading has confirmed the pose, and nobody has set
  /// it.
  bool other_map = false;

  // Dead reckoning.
  std::uint64_t cycle = 0;
  std::optional<std::uint64_t> odom;
  Pose pose_in_odom;
  Pose moved;                                          ///< in the newest cycle
  double way = 0.0;                                    ///< [m] in total
  double turned = 0.0;                                 ///< [rad] in total, either way
  std::deque<std::pair<std::uint64_t, double>> turns;  ///< the same by cycle, recent

  // Corrections of the pose.
  std::vector<Done> done;
  std::set<std::pair<std::uint64_t, int>> used;  ///< readings of accepted percepts
  double since_readings = 0.0;                   ///< [m] of way since readings corrected it

  // The cloud beside the filter.
  double trial;                   ///< [m] of the cloud's lead before the filter is tried again
  std::map<int, double> weighed;  ///< [m] of way at a sonar's newest weighing
  double lead = 0.0;              ///< score of the cloud minus that of the filter
  double cloud_score = 0.0;
  bool leads = false;  ///< the cloud leads, and sets the filter
  double led = 0.0;    ///< [m]
  ParticleCloud cloud;

  SearchState search;
  Standing standing;
  Presence presence;
  std::set<std::uint32_t> sure_closed;  ///< doors that were closed when the pose was last sure
  int agreed = 0;  ///< openings of the map seen since one was not where the map has it
  ObjectFinder objects;
  Output output;  ///< of the newest step
};

}  // namespace saphira::registration
