#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/interpretation/tangent.hpp"
#include "saphira/lps/percept.hpp"

namespace saphira::interpretation {

/// Limits for walls, and for openings in them.
struct SideSettings {
  double aperture = 5.0;       ///< [m] of travel over which readings are combined
  double turn_cost = 0.3;      ///< [m/rad] travel for a turn, which costs dead reckoning too
  double max_range = 3.0;      ///< [m] of echoes that make walls
  double step = 0.03;          ///< [m] a sonar that has moved less, and...
  double turn = radians(5.0);  ///< ...turned less, has no new information

  double gate = 0.03;            ///< [m] largest distance of an echo from its line...
  double relative_gate = 0.012;  ///< ...plus this share of its range
  EchoError error;
  double max_rms = 0.03;             ///< [m] of a wall
  double incidence = radians(25.0);  ///< off the beam's axis up to which a wall has an echo
  int min_echoes = 8;                ///< of a wall
  double min_length = 0.7;           ///< [m] of a wall, plus the apparent length of one corner
  double run_gap = 0.35;             ///< [m] between echoes of one stretch
  /// [m] Largest offset of a stretch's echoes to one side of its line: beyond it the wall, or dead
  /// reckoning, is bent.
  double max_bend = 0.03;

  /// Half the width of the cone in which a corner is heard. A wall seems that much longer.
  double corner_cone = radians(9.5);
  double corner_doubt = radians(3.0);  ///< one sigma of it
  double post_cone = radians(12.0);    ///< in which other sonars may hear a corner
  double sure = radians(18.0);         ///< off the axis up to which a wall surely has an echo
  double through = 0.45;               ///< [m] an echo this far behind a line has gone through it
  double max_step = 0.05;              ///< [m] offset between the walls on both sides of an opening
  int min_through = 3;                 ///< readings through an opening
  double min_door = 0.6;               ///< [m]
  double max_door = 1.4;               ///< [m] wider ones are junctions
  double max_junction = 4.5;           ///< [m]
  double end_run = 0.6;                ///< [m] length of the wall at a single end
  /// [m] Setback of a closed door from its wall (reveals of DIN 18040, ADA 404): a smaller one is a
  /// frame, a larger one an open door.
  double min_back = 0.14;
  double max_back = 0.4;
  double back_agree = 0.04;  ///< [m] spread of its echoes
  int min_back_echoes = 5;
};

/// One end of a stretch of wall.
struct End {
  double u = 0.0;
  double sigma = 0.0;
  bool open = false;  ///< observed to end here, not merely unseen beyond
  std::vector<const Return*> through;
  std::vector<const Return*> posts;  ///< echoes of its corner from other bearings
};

/// A stretch of a line without a gap.
struct Stretch {
  std::vector<const Return*> echoes;  ///< in order along the line
  End from;
  End to;
  /// Most of its echoes fit no other line better, such as one from before a turn.
  bool own = true;
};

/// Its straight part, from its newest echo on.
Stretch straight_part(const Line& line, const Stretch& stretch, const SideSettings& settings);

/// A gap between two stretches: an open one, or a closed door that stands back from the wall.
struct Opening {
  std::size_t before = 0;  ///< the stretches
  std::size_t after = 0;
  End from;                            ///< the ends of the wall: of the stretch before it,
  End to;                              ///< and of the one after it
  std::vector<const Return*> through;  ///< readings through it, or from the closed door
  double depth = 0.0;                  ///< [m] of the closed door; 0: open
};

/// A wall as seen from one side: a line and its place.
struct Wall {
  std::uint32_t line = 0;  ///< stays for the same line
  LineFit fit;
  std::vector<Stretch> stretches;
  std::vector<Opening> openings;
};

/// The extended aperture of one side (paper 3.2.1): the readings of its sonars over the last
/// metres, and the walls in them.
class SideView {
 public:
  explicit SideView(SideSettings settings)
      : settings_(settings), incidence_(std::cos(settings.incidence)) {}

  /// A firing of one of the side's sonars. False where it has no new information.
  bool add(const Return& firing);
  /// Forgets readings beyond the aperture, then combines the rest. `others` are the echoes of the
  /// sonars in other directions, which hear the posts of doors.
  void interpret(double travelled, const std::deque<Return>& others);
  void clear();

  const std::vector<Wall>& walls() const { return walls_; }

  /// The walls are found again by the next interpret().
  template <class Archive>
  void archive(Archive& a) {
    a("returns", returns_)("lines", lines_)("last_line", last_line_);
    if (a.restores())
      walls_.clear();
  }

 private:
  struct Candidate {
    std::uint32_t id = 0;
    LineFit fit;
    double newest = 0.0;  // travelled and turned at its newest echo
    double turned = 0.0;
    std::vector<const Return*> echoes;

    SAPHIRA_ARCHIVE(id, fit, newest, turned)
  };
  // The distance of an echo from the line that was heard last there, if it belongs to it.
  std::optional<double> misses(const Return& firing, const Line& line, double newest,
                               double turned) const;
  bool is_wall(const Candidate& candidate) const;
  void assign();
  void seek();
  void describe(const Candidate& candidate, const std::deque<Return>& others);
  bool find_way_in(const Line& line, const Stretch& before, const Stretch& after,
                   const std::vector<const Return*>& back, std::size_t other,
                   const std::deque<Return>& others, Opening& opening) const;
  bool has_door_in(const Line& line, Opening& opening, std::size_t others) const;
  void place_end(const Line& line, const Stretch& stretch, bool upper,
                 const std::vector<const Return*>& beyond, const std::deque<Return>& others,
                 End& end) const;

  SideSettings settings_;
  double incidence_;  // cosine
  std::deque<Return> returns_;
  std::vector<Candidate> lines_;
  std::vector<Wall> walls_;
  std::uint32_t last_line_ = 0;
};

}  // namespace saphira::interpretation
