#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace saphira::story {

/// People of a story (config/people): where each is, what they have and know, and what they say to
/// the robot. They answer what the robot asks people (config/activities/people.act).
class Cast {
 public:
  /// Where the robot has to stand.
  struct Spot {
    std::string place;      ///< of the map: in it, or before its door
    double distance = 0.0;  ///< [m] from the door, at most
  };
  struct Line {
    std::string speaker;
    std::string text;
    std::optional<Spot> near;  ///< said when the robot stands there, whatever it is still about
  };

  /// FileError where the text is wrong.
  Cast(std::string_view text, const std::string& file);

  /// The sentences that people say to the robot of themselves, in order.
  const std::vector<Line>& lines() const { return lines_; }
  /// How the story has to end: with what the robot says last, from its first letter on.
  bool ends_well(const std::string& last) const { return last.starts_with(end_); }
  const std::string& end() const { return end_; }
  /// The deployment that the robot runs by.
  const std::string& deployment() const { return deployment_; }
  /// A file for the simulator, with whom of them sensors can see; empty: nobody.
  const std::string& things() const { return things_; }
  /// The answer of somebody at that place of the map to a sentence of the robot; nothing: nobody
  /// hears it, or nobody has an answer. What is handed over changes hands.
  std::optional<Line> answer(const std::string& said, const std::string& place);
  /// True where somebody has it.
  bool has(const std::string& person, const std::string& object) const;

 private:
  struct Person {
    std::string name;
    std::string place;
    std::set<std::string> has;
    std::map<std::string, std::string> knows;
  };
  std::vector<Person> people_;
  std::vector<Line> lines_;
  std::string end_ = "done: ";
  std::string deployment_ = "office";
  std::string things_;
};

}  // namespace saphira::story
