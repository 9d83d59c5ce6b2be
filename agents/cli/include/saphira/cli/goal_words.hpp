#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "saphira/idl/intention.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::cli {

using situation::describe;

/// One argument of a goal as a person types it, name=value:
///
///   speed=0.3                  a number, in SI units
///   heading=90deg              an angle in degrees
///   position=3,1               a point x,y [m] in odom
///   position=3,1,1.57@robot    with a heading [rad] (or 90deg), and the frame: odom, robot or map
///   door=kitchen               text
///   speed=30cm/s               text, which the activity's declared unit makes a number
///
/// std::invalid_argument with the expected form for any other word.
v1::Argument parse_argument(const std::string& word);

/// A goal from its functor and the words of its arguments. std::invalid_argument as above, and for
/// a repeated name.
v1::Goal parse_goal(const std::string& functor, const std::vector<std::string>& words);

/// A goal as a person types it: a functor and its arguments, or in short
///
///   go X Y           go_to position=X,Y          [m] in odom
///   go PLACE         go-to-place place=PLACE     one or more words
///   drive SPEED      drive speed=SPEED           [m/s]
///   turn to DEGREES  turn_to heading=DEGREESdeg  in odom
///
/// The numbers may have a unit behind them (30cm, 0.3m/s, 1.57rad). Each with further name=value
/// words behind it. std::invalid_argument as above.
v1::Goal parse_request(const std::vector<std::string>& words);

/// The goals in the order of their acceptance, as far as their statuses tell it.
std::vector<v1::GoalStatus> by_acceptance(
    const std::map<std::pair<std::uint64_t, std::uint64_t>, v1::GoalStatus>& goals);

/// Advice where this goal has failed; empty: none.
std::string advice_after_failure(const v1::Goal& goal);

}  // namespace saphira::cli
