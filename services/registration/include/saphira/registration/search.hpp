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

/// One reading with the place of its sonar when it heard.
struct PlacedReading {
  Pose sensor_in_odom;
  double range = 0.0;
  bool echo = false;
  int sonar = 0;

  bool operator==(const PlacedReading&) const = default;
};

struct SearchSettings {
  std::size_t hypotheses = 100;  ///< the most that are followed
  double trust = 0.3;            ///< exponent of the likelihoods: readings are not independent
  double any_echo = -2.6;        ///< log likelihood of an echo by no place in particular...
  double any_silence = -0.8;     ///< ...and of silence
  double surprise = 1.5;         ///< the most that one reading speaks against a place
  std::size_t history = 60;      ///< readings that a new hypothesis is held against
  double spacing = 0.1;          ///< [m] of way between those of one sonar that count
  double memory = 6.0;           ///< [m] of way in which a score fades to a third
  double recent = 2.0;     ///< [m] the same of what the place that is believed was worth of late
  double evidence = 20.0;  ///< score from which on a hypothesis may be it...
  double margin = 10.0;    ///< ...when it is so much better than any at another place...
  double way = 2.5;        ///< [m] ...and has been followed for so long
  int matches = 3;         ///< ...and openings that it has explained, its first one included
  double hopeless = 25.0;  ///< below the best one's score: given up
};

/// Results of a search.
struct SearchState {
  /// A place that is followed.
  struct Hypothesis {
    PoseFilter filter;
    double score = 0.0;
    double way = 0.0;  ///< [m] followed
    int openings = 0;
    bool told = false;  ///< not proposed by an opening: somebody says that the robot starts there

    bool operator==(const Hypothesis&) const = default;
  };
  std::vector<Hypothesis> hypotheses;
  std::deque<PlacedReading> history;
  std::optional<Pose> odom;
  double travelled = 0.0;
  std::optional<Pose> own;
  double own_score = 0.0;   ///< what the place that is believed has been worth so far...
  double own_recent = 0.0;  ///< ...and of late

  bool operator==(const SearchState&) const = default;
};

/// Where in the whole map the robot is: places that would explain an opening that was seen are
/// followed with a filter each, matched with what is seen afterwards, and weighed by raw readings
/// (multiple hypothesis localisation, Jensfelt and Kristensen 2001). It costs little, since an
/// opening leaves only so many places as the map has openings of its width, and it needs no luck:
/// a filter of 40000 particles had too few near the truth to survive in a floor of 36 by 28 m.
class Search {
 public:
  using Hypothesis = SearchState::Hypothesis;

  /// Works on `state`. That, the map and all that is made of it outlive the search.
  Search(const maps::Map& map, const LineMap& lines, const RangeModel& model,
         const SearchSettings& settings, const MatchSettings& match_settings,
         const ReckoningErrors& reckoning, double drift_error, SearchState& state);

  void clear();
  /// One cycle. `fresh` are the percepts that are to be matched in it; `own` is the place that is
  /// believed, which is weighed with the others, and nullptr while there is none.
  void step(const Pose& pose_in_odom, const std::vector<PlacedReading>& readings,
            const std::vector<const lps::Percept*>& fresh, const PoseFilter* own);

  /// How much better than anywhere a reading fits where its sonar is, as scores count it.
  double worth(const Pose& sensor_in_map, double range, bool echo) const;
  /// Follows a place that the robot was told, beside the one that `own` of step() is.
  void suspect(const PoseFilter& filter);
  /// True where no other place is worth more than the one that is believed.
  bool own_is_best() const;
  /// Of the place that is believed and the one that was told: whether it explains what is heard,
  /// better than the other by the margin, and no place in the map does it better by that.
  bool own_leads() const;
  const Hypothesis* told_leads() const;
  /// The best one and how much better it is than any that is elsewhere; nothing: there is none.
  /// While a place is believed, `beside_own`: the best one that is not there, and how much better
  /// it is than that place, too.
  struct Best {
    const Hypothesis* hypothesis = nullptr;
    double margin = 0.0;
    bool likely = false;  ///< enough not to believe the other place any more
    bool sure = false;    ///< enough to believe this one
  };
  std::optional<Best> best(bool beside_own) const;

 private:
  bool leads(const Pose& pose, double score) const;
  void propose(const lps::Percept& percept);
  double weigh(const Pose& pose, const PlacedReading& reading) const;
  void count_own(double worth);
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
