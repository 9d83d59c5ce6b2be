#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace saphira::console {

/// Which of the people at the browsers drives, and what they want. Times are seconds of any clock
/// that does not jump.
///
/// One operator holds control. The operator's page says at least ten times a second what is wanted,
/// also that nothing is: samples that stay out, come late or twice mean a link that is gone, and
/// the robot stands. After a short gap it stands until the stick has been let go; after a long one
/// the operator watches, and has to take control again.
class Control {
 public:
  struct Settings {
    double hold = 0.4;  ///< [s] the newest sample counts for so long after it came
    double lose = 1.0;  ///< [s] after such a silence control is gone
    double late = 0.4;  ///< [s] a sample that took so much longer than the quickest is refused
  };

  /// One word of the operator's page.
  struct Sample {
    std::uint64_t number = 0;  ///< counts the page's samples
    double device_time = 0.0;  ///< [s] by the operator's device, any origin
    bool active = false;       ///< the dead-man: somebody holds a stick or a key
    double velocity = 0.0;     ///< [m/s]
    double rotation = 0.0;     ///< [rad/s]
    std::uint64_t cycle = 0;   ///< of the robot state that the operator sees
  };

  /// The command for the robot now.
  struct Order {
    bool active = false;
    double velocity = 0.0;
    double rotation = 0.0;
    std::uint64_t cycle = 0;
    std::string source;  ///< who drives, for people
  };

  using OperatorId = std::uint64_t;
  /// Why a sample is refused that a newer one has overtaken, or that came before.
  static constexpr const char* kRepeated = "a repeated sample";

  Control() = default;
  explicit Control(Settings settings) : settings_(settings) {}

  void join(OperatorId id, const std::string& name);
  void leave(OperatorId id);
  /// Takes control; `force` also where somebody else has it. Why not, in words; empty where it did.
  std::string take(OperatorId id, bool force, double now);
  /// Asks the holder for it. Why not, in words.
  std::string ask(OperatorId id);
  void release(OperatorId id);
  /// Why the sample is refused, in words; empty where it counts.
  std::string drive(OperatorId id, const Sample& sample, double now);

  /// The present order. Call it at least ten times a second: it notices what stays out.
  Order order(double now);

  OperatorId holder() const { return holder_; }
  /// The present state for the pages, as JSON: holder, name, asked (names), note, driving.
  std::string json() const;

 private:
  void drop(const std::string& note);
  void lose_silent(double now);
  std::string name_of(OperatorId id) const;

  Settings settings_;
  std::map<OperatorId, std::string> operators_;
  OperatorId holder_ = 0;
  std::vector<OperatorId> asked_;
  std::string note_;
  Sample newest_;
  double came_ = 0.0;          ///< [s] of the newest sample
  double quickest_ = 0.0;      ///< [s] the smallest difference of the two clocks
  bool any_ = false;           ///< a sample has come since control was taken
  bool let_go_first_ = false;  ///< after a gap
};

}  // namespace saphira::console
