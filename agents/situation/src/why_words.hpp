#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/base/cycle.hpp"
#include "saphira/base/format.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/idl/behavior.hpp"
#include "saphira/idl/intention.hpp"

// The words and simple predicates of explanations.
namespace saphira::situation {

inline constexpr double kNoSpeed = 0.005;         // [m/s] below it stands
inline constexpr double kNoTurn = radians(1.0);   // below it goes straight on
inline constexpr double kNoSay = 0.005;           // [0..1] smaller parts of a rule are ignored
inline constexpr double kMentioned = 0.1;         // [0..1] a share worth mentioning in the sentence
inline constexpr double kFarFromTold = 0.05;      // [m/s] from the setpoint: mentioned
inline constexpr double kTurning = radians(3.0);  // [rad/s] a visible turn
inline constexpr std::size_t kMostMentioned = 3;  // behaviors in the sentence

std::string speed_text(double speed);
/// Such as "12 degrees"; invisibly small angles with a decimal.
std::string angle_text(double angle);
/// `rate`: [rad/s] instead of [rad].
std::string turn_text(double turn, bool rate = false);
bool has_word(const std::string& text, const std::string& word);
double clamp01(double x);

enum class Channel { speed, turn };

Channel channel_of(const v1::RuleState& rule);
double weight_of(const v1::BehaviorState& behavior, Channel channel);
double activity_of(const v1::BehaviorState& behavior, Channel channel);
bool recommends(const v1::BehaviorState& behavior, Channel channel);
/// The setpoints of a behavior alone.
std::string wish_of(const v1::BehaviorState& behavior, Channel channel);

std::string control_text(const v1::RuleState& rule);
/// A name without its unique number: follow of follow#8.
std::string without_number(const std::string& name);
std::string plain(const std::string& name);
/// True where an instance is named after its schema: KeepOff#3, keep-off.
bool nameless(const std::string& name, const std::string& schema);
std::string intention_name(const v1::IntentionNode& node);
/// True where the belief concerns an argument of an intention with that schema: "place-of-karen"
/// concerns "name=karen, patience=15".
bool concerns(const v1::Belief& belief, const std::string& schema, const std::string& arguments);
std::string with_arguments(const v1::IntentionNode& node);

}  // namespace saphira::situation
