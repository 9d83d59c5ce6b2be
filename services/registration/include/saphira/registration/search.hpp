#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "saphira/lps/percept.hpp"
#include "saphira/registration/line_map.hpp"
#include "saphira/registration/matching.hpp"
#include "saphira/registration/pose_filter.hpp"
#include "saphira/registration/range_model.hpp"

namespace saphira::registration {

/// One reading with the place of its sonar.
struct PlacedReading {
  Pose sensor_in_odom;
  double range = 0.0;
  bool echo = false;
  int sonar = 0;
};

struct SearchSettings {
  std::size_t hypotheses = 100;  ///< the maximum
  double trust = 0.3;            ///< exponent of the likelihoods: readings are not independent
  double any_echo = -2.6;        ///< log likelihood of an echo without a place...
  double any_silence = -0.8;     ///< ...and of silence
  double surprise = 1.5;         ///< the limit of one reading's evidence against a place
  std::size_t history = 60;      ///< readings that test a new hypothesis
  double spacing = 0.1;          ///< [m] of way between those of one sonar that count
  double memory = 6.0;           ///< [m] of way in which a score fades to a third
  /// [m] The same for the part of a score that is near. A robot that was carried has the good
  /// score of its old place for some metres yet.
  double near_memory = 0.8;
  double near_enough = 5.5;  ///< a part that is enough, whatever the whole score is
  double agrees = 0.2;       ///< the limit of one reading's evidence for the present place...
  double alike = 0.1;        ///< ...and its share against silent walls: others are alike elsewhere
  double strange = 3.0;      ///< the limit of the evidence of echoes that a person or box explains
  /// Evidence against the present place of a wall where the map has an open door: ln(0.75 / 0.15).
  /// People have closed 15 % of the doors; elsewhere 75 % of a corridor's side is wall. One such
  /// door is ordinary, and several in a row are not.
  double closed = 1.6;
  /// [m] of way in which the evidence of openings fades to a third. Walls take none of it away:
  /// they are the same in any other corridor.
  double openings_memory = 50.0;
  double sideways = radians(65.0);  ///< [rad] from this bearing on sonars hear no mirrored echoes
  double evidence = 20.0;           ///< score from which a hypothesis is accepted...
  double margin = 10.0;             ///< ...with this lead over any at another place...
  double way = 2.5;                 ///< [m] ...after this way
  int matches = 3;         ///< ...and with this many explained openings, including its first
  double hopeless = 25.0;  ///< below the best one's score: dropped
};

/// Results of a search.
struct SearchState {
  /// A place that is followed.
  struct Hypothesis {
    PoseFilter filter;
    double score = 0.0;
    double way = 0.0;  ///< [m] followed
    int openings = 0;
    bool told = false;  ///< not proposed by an opening: given as the robot's start
  };
  std::vector<Hypothesis> hypotheses;
  std::deque<PlacedReading> history;
  std::optional<Pose> odom;
  double travelled = 0.0;
  std::optional<Pose> own;
  double own_score = 0.0;   ///< of the present place
  double near_score = 0.0;  ///< the part of it that the last metres have given
  int own_openings = 0;     ///< seen openings that the present place has
  // Evidence against the present place, never below 0 (Page's test, 1954), so that the good
  // readings of a place before do not count.
  double against = 0.0;   ///< walls that are not heard
  double strange = 0.0;   ///< echoes where the map has nothing
  double openings = 0.0;  ///< openings that the map does not have, and doors found closed
};

/// Finds the robot in the whole map. Places that would explain a seen opening are followed with a
/// filter each, matched with later percepts, and weighed by raw readings (multiple hypothesis
/// localisation, Jensfelt and Kristensen 2001). That is cheap, since an opening has only as many
/// places as the map has openings of its width, and needs no luck: a filter of 40000 particles had
/// too few near the truth to survive in a floor of 36 by 28 m.
class Search {
 public:
  using Hypothesis = SearchState::Hypothesis;

  /// Works on `state`, which outlives the search, as do the map and all objects made from it.
  Search(const maps::Map& map, const LineMap& lines, const RangeModel& model,
         const SearchSettings& settings, const MatchSettings& match_settings,
         const ReckoningErrors& reckoning, double drift_error, SearchState& state);

  void clear();
  /// One cycle. `fresh` are the percepts to match in it; `own` is the present place, which is
  /// weighed with the others, and nullptr while there is none.
  void step(const Pose& pose_in_odom, const std::vector<PlacedReading>& readings,
            const std::vector<const lps::Percept*>& fresh, const PoseFilter* own);

  /// The score of a reading at its sonar's place, relative to an average place.
  double worth(const Vec2& sensor_in_map, const Vec2& ahead, double range, bool echo) const;
  /// Tests the present place by a reading of this worth; the bearing is in the robot.
  void test_own(double bearing, double worth);
  /// Doors have been found closed that were open before.
  void found_closed(std::size_t doors);
  /// The evidence against the present place.
  double contradiction() const { return contradiction_of_walls() + now_.openings; }
  /// The part of it that silent walls and echoes without an artifact are.
  double contradiction_of_walls() const { return now_.against + now_.strange; }
  /// True where this is the present place: the evidence against it counts for both.
  bool is_own(const Pose& pose_in_map) const;
  /// Follows a given place of the robot, beside `own` of step().
  void suspect(const PoseFilter& filter);
  /// True where no other place has a higher score than the present one.
  bool own_is_best() const;
  /// The score of the last metres at the present place, divided by its usual share of the whole
  /// score (`near_enough` at most): below 1 they fit worse than the metres before.
  double near_share() const;
  /// The present place has this score, near and far.
  void set_own_score(double score);
  /// Tests of the present place, and of the given one: its score is high enough, it leads the other
  /// by the margin, and no place in the map leads it by that.
  bool own_leads() const;
  const Hypothesis* told_leads() const;
  /// The best hypothesis and its lead over any at another place; nothing: there is none. While
  /// there is a present place, `beside_own`: the best hypothesis at another place, with its lead
  /// over the present place, too.
  struct Best {
    const Hypothesis* hypothesis = nullptr;
    double margin = 0.0;
    bool likely = false;  ///< enough to doubt the other place
    bool sure = false;    ///< enough to accept this one
  };
  std::optional<Best> best(bool beside_own) const;

 private:
  bool leads(const Pose& pose, double score) const;
  void propose(const lps::Percept& percept);
  double weigh(const Pose& pose, const PlacedReading& reading) const;
  void support_own(double evidence, double share);
  double worth(const lps::Percept& percept, const Match& match, const Pose& robot_in_map) const;
  void thin_out();

  const maps::Map* map_;
  bool maps_corridors_ = false;
  const LineMap* lines_;
  const RangeModel* model_;
  SearchSettings settings_;
  MatchSettings match_settings_;
  ReckoningErrors reckoning_;
  double drift_error_;
  SearchState& now_;
};

}  // namespace saphira::registration
