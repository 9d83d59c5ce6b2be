#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/fnv1a.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/story/cast.hpp"

namespace saphira::story {

struct StoryOptions {
  std::vector<std::string> services;  ///< required before the first line
  double time_limit = 1200.0;         ///< [s] of robot time
  /// Gets each utterance as it comes: the robot's time, its place, and "alice: Flakey, ...".
  std::function<void(double time, const std::string& place, const std::string& line)> show;
};

/// "   12.3 s  EJ-247           alice: Flakey, ...": an utterance for people and programs.
std::string story_line(double time, const std::string& place, const std::string& line);
bool is_story_line(std::string_view line);
/// Of a story line: "alice: Flakey, ...".
std::string_view said_in(std::string_view story_line);

/// Plays the people of a cast on the bus: they say their lines, and answer the robot's questions at
/// their places. They use the same topics as everybody who speaks to the robot. The robot's cycles
/// are their only clock. For the node's own thread.
class Story {
 public:
  Story(bus::Node& node, Cast cast, StoryOptions options);

  /// Takes the input, and says due lines. now: [s] since 1970; 0: unknown, in lockstep. True when
  /// the story has come to its end.
  bool step(double now = 0.0);

  /// True where the robot has its place on the map, and the services run.
  bool ready() const { return waiting_for_.empty() && !place_.empty(); }
  /// The robot's words and the holders of the objects are those that the cast expects.
  bool well() const { return ended_ && cast_.ends_well(outcome_) && cast_.all_got(); }
  /// The objects that people received, by their own word: "alice has the report"; empty: none.
  std::string handed_over() const { return cast_.handed_over(); }
  /// The robot's last answer to the newest line; empty: none.
  const std::string& outcome() const { return outcome_; }
  double time() const { return time_; }  ///< [s] of the robot
  std::size_t utterances() const { return utterances_; }
  /// Hash of all utterances, in order.
  std::string hash() const { return hash_.text(); }

 private:
  void take();
  void say_next();
  bool stands_at(const Cast::Spot& spot) const;
  std::uint64_t say(const Cast::Line& line);
  void listen(const v1::Utterance& said);
  void show(const std::string& line);

  bus::Node& node_;
  Cast cast_;
  StoryOptions options_;
  bus::Reader<v1::RobotState> robots_ = node_.reader(bus::topics::kRobotState);
  bus::Reader<v1::Registration> registrations_ = node_.reader(bus::topics::kRegistration);
  bus::Reader<v1::FloorMap> maps_ = node_.reader(bus::topics::kMap);
  bus::Reader<v1::ServiceStatus> statuses_ = node_.reader(bus::topics::kStatus);
  bus::Reader<v1::Utterance> said_ = node_.reader(bus::topics::kSaid);
  bus::Writer<v1::Utterance> heard_ = node_.writer(bus::topics::kHeard);
  std::set<std::string> waiting_for_;  ///< services
  maps::Map map_;
  std::string place_;  ///< of the robot
  std::string outcome_;
  v1::Stamp stamp_;  ///< of the robot
  double time_ = 0.0;
  double now_ = 0.0;
  bool waits_ = false;  ///< for the last answer to the newest line
  bool ended_ = false;
  std::optional<Cast::Line> answer_;
  double answer_time_ = 0.0;  ///< [s] robot time of that answer
  std::size_t next_ = 0;      ///< line of the cast
  std::uint64_t number_ = 0;  ///< of the newest utterance
  std::uint64_t line_ = 0;    ///< number of the newest line of the cast
  /// The robot's task during further lines, such as to follow a person. If it gives up too soon,
  /// the line is repeated.
  struct Errand {
    Cast::Line line;
    std::uint64_t number = 0;
    bool over = false;
  };
  std::optional<Errand> errand_;
  Pose pose_in_map_;
  double stands_since_ = 0.0;  ///< [s] of the robot
  std::size_t utterances_ = 0;
  Fnv1a hash_;
};

}  // namespace saphira::story
