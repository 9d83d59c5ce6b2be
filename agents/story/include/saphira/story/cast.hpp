#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace saphira::story {

/// People of a story (config/people): their places, their belongings and knowledge, and their lines
/// to the robot. They answer the robot's questions to people (config/activities/people.act).
class Cast {
 public:
  /// A place where the robot has to stand.
  struct Spot {
    std::string place;      ///< of the map: in it, or before its door
    double distance = 0.0;  ///< [m] from the door, at most
  };
  struct Line {
    std::string speaker;
    std::string text;
    std::optional<Spot> near;  ///< said when the robot stands there, whatever its present task
  };

  /// FileError where the text is wrong.
  Cast(std::string_view text, const std::string& file);

  /// FileError where nobody says anything, or at the first place for which `is_place` is false.
  void check(const std::function<bool(const std::string& place)>& is_place) const;

  /// The sentences that people say to the robot unasked, in order.
  const std::vector<Line>& lines() const { return lines_; }
  /// The required end of the story: the beginning of the robot's last utterance.
  bool ends_well(const std::string& last) const { return last.starts_with(end_); }
  const std::string& end() const { return end_; }
  /// The robot's deployment.
  const std::string& deployment() const { return deployment_; }
  /// A file for the simulator, with the people that sensors can see; empty: none.
  const std::string& things() const { return things_; }
  /// The answer of a person at that place of the map to a sentence of the robot; nothing: no
  /// hearer, or no answer. An object that is handed over changes its owner.
  std::optional<Line> answer(const std::string& said, const std::string& place);
  /// True where that person has it.
  bool has(const std::string& person, const std::string& object) const;
  /// True where everybody has what they are to have at the end.
  bool all_got() const;
  /// The objects with another owner than at the beginning: "alice has the report"; empty: none.
  std::string handed_over() const;

 private:
  struct Person {
    std::string name;
    std::string place;
    std::set<std::string> has;
    std::set<std::string> gets;  ///< to have at the end
    std::map<std::string, std::string> knows;
  };
  struct Named {
    std::string place;
    std::string text;  ///< of its line
    int line = 1;
    int column = 1;
  };
  std::string file_;
  std::vector<Named> places_;
  std::vector<Person> people_;
  std::map<std::string, std::string> owners_;  ///< of objects at the beginning
  std::vector<Line> lines_;
  std::string end_ = "done: ";
  std::string deployment_ = "office";
  std::string things_;
};

}  // namespace saphira::story
