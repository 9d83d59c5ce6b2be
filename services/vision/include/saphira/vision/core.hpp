#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/base/notes.hpp"
#include "saphira/base/process.hpp"
#include "saphira/vision/vision.hpp"

namespace saphira::vision {

/// The vision service without the bus: one step a cycle, from pictures and channels to the people
/// and colors around the robot.
class Core {
 public:
  explicit Core(const ColorCamera& camera = {}) : vision_(camera) {}

  /// A result of the camera's own system, with the pose of the robot at that time.
  struct Seen {
    std::uint64_t cycle = 0;
    std::uint64_t odom = 0;
    Pose pose_in_odom = {};
    Channels channels = {};
  };
  struct Inputs {
    std::uint64_t cycle = 0;
    bool new_robot = false;  ///< the first step of an epoch
    bool new_frame = false;  ///< the odom frame has another origin since the last step
    std::uint64_t odom = 0;
    Pose pose_in_odom;
    unsigned channels_per_s = 0;           ///< from the robot's state
    std::optional<StereoPicture> picture;  ///< the newest of no later cycle
    std::vector<Seen> seen;                ///< new ones of this epoch, in order; of any cycle
    std::string no_pictures;               ///< the reason for missing pictures; empty: they come
  };
  struct Outputs {
    std::vector<lps::SeenThing> things;
    std::uint64_t picture = 0;  ///< cycle of the newest processed one; 0: none
    bool sees_people = false;   ///< pictures come
    bool sees_colors = false;   ///< channels come
    Notes notes;
  };

  Outputs step(const Inputs& inputs);

  /// True where all channels for the step of `cycle` have come, by their number in the robot's
  /// state: all before that cycle. Also true for a service that joined too late to count.
  bool has_channels(std::uint64_t cycle, unsigned channels_per_s,
                    const std::vector<Seen>& waiting) const;

  ProcessTable& processes() { return processes_; }

  SAPHIRA_ARCHIVE(processes_, vision_, places_, newer_, counted_, joined_, picture_, color_,
                  no_pictures_)

 private:
  /// The robot's pose in a cycle.
  struct Place {
    std::uint64_t cycle = 0;
    Pose pose_in_odom;
  };

  void begin(const Inputs& inputs);
  void look_at(const StereoPicture& picture);
  void look_at_channels(const Inputs& inputs);

  ProcessTable processes_;
  Process& stereo_ = processes_.add("find-people", "looks for people in the stereo pictures");
  Process& colors_ = processes_.add("find-colors", "places the blobs of the camera's channels");
  Vision vision_;
  std::deque<Place> places_;           ///< of the last cycles
  std::deque<Seen> newer_;             ///< of later cycles
  std::deque<std::uint64_t> counted_;  ///< cycles of the channels of the last second
  std::uint64_t joined_ = 0;           ///< the first cycle of this epoch that was stepped
  std::uint64_t picture_ = 0;          ///< cycle of the newest processed one
  std::uint64_t color_ = 0;            ///< cycle of the newest channels
  std::string no_pictures_;
};

}  // namespace saphira::vision
