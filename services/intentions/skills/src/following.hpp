#pragma once

#include <cstddef>
#include <deque>

#include "saphira/base/archived.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// The way that a person has walked, from a robot that follows to the person. All in odom.
class Trail {
 public:
  /// The person was seen there.
  void add(const Vec2& place);
  /// The robot is there: forgets the part of the way up to its nearest point.
  void reach(const Vec2& robot);
  /// [m] From the robot along the way to its end.
  double length() const;
  /// The point this far [m] along the way; at most its end.
  Vec2 at(double distance) const;
  std::size_t places() const { return places_.size(); }

  SAPHIRA_ARCHIVE(robot_, places_)

 private:
  Vec2 robot_{0.0, 0.0};
  std::deque<Vec2> places_;  ///< the oldest first
};

/// follow-trail: walks behind the nearest visible person, around the same corners.
Schema follow_trail();

}  // namespace saphira::intentions
