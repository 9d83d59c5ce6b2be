// The courses of robots, people, doors and boxes: scenes.txt.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "lines.hpp"
#include "saphira/sim/contacts.hpp"
#include "world_scene.hpp"

namespace saphira::sim {
namespace {

using protocol::RobotParameters;

/// The things of a world, tick by tick. Lengths in m, angles in degrees, except for those of a
/// world file.
///
/// Before the robots: `world TEXT`, a room of 10 m with these things; `bare TEXT`, the world file
/// alone; `parameter NAME VALUE` and `sonar DEGREES`, of the robots that are added next.
///
/// `robot X Y DEGREES` adds a robot, and the next lines are of it; `of N`: of that one again;
/// `refused X Y DEGREES`: no robot can be there. Its commands are `VERB [NUMBER]` with the kVerbs,
/// `place X Y DEGREES` and, where there is no room, `displaced X Y DEGREES`. `open DOOR`.
///
/// `run SECONDS`; `always FACT` holds after each later tick. A fact is `NAME == VALUE`, likewise <,
/// >, <= and >=, or `NAME ~ VALUE +- TOLERANCE`. `contact BLAME KIND [NAME] [walks]` is the robot's
/// first contact.
///
/// `ear X DEGREES` is a sonar without noise, on no robot; `model rough | weak` and `strict` are its
/// surfaces. `hears X Y DEGREES RANGE TOLERANCE` and `deaf X Y DEGREES`: in a frame that is there.
class Play {
 public:
  void take(const std::string& line) {
    std::istringstream in(line);
    std::string word;
    std::string sign;
    in >> word >> sign;
    if (const auto verb = kVerbs().find(word); verb != kVerbs().end() && !test::is_sign(sign))
      return verb->second(*robot_, number(line));
    if (test::is_sign(sign))
      return check(line);
    const std::string rest = line.substr(std::min(word.size() + 1, line.size()));
    if (word == "world")
      text_ += " " + rest;
    else if (word == "bare")
      text_ = rest;
    else if (word == "parameter")
      parameters_.*kParameters().at(sign) = number(rest);
    else if (word == "sonar")
      parameters_.sonars = {{0, {0.1, 0.0, radians(number(line))}}};
    else if (word == "ear")
      parameters_.sonars = {{0, {std::stod(sign), 0.0, radians(number(line))}}};
    else if (word == "model")
      (sign == "rough" ? model_.roughness : model_.strength) = sign == "rough" ? 1.0 : 0.0;
    else if (word == "strict")
      model_.lost_angle = model_.critical_angle;
    else if (word == "hears")
      hear(line, rest);
    else if (word == "deaf")
      EXPECT_FALSE(range_at(pose(rest))) << line;
    else if (word == "robot")
      add(pose(rest));
    else if (word == "refused")
      EXPECT_THROW(scene().add_robot(parameters_, pose(rest), 1), std::invalid_argument) << line;
    else if (word == "of")
      robot_ = &scene().robot(static_cast<RobotNumber>(number(line)) - 1);
    else if (word == "open")
      EXPECT_TRUE(scene().set_door(rest, true)) << line;
    else if (word == "place")
      EXPECT_TRUE(robot_->place(pose(rest))) << line;
    else if (word == "displaced")
      EXPECT_FALSE(robot_->place(pose(rest))) << line;
    else if (word == "always")
      always_.push_back(rest);
    else if (word == "run")
      run(std::lround(number(line) / kTick));
    else if (word == "contact")
      EXPECT_EQ(first_contact(), rest);
    else
      throw std::invalid_argument("not understood");
  }

 private:
  using Verbs = std::map<std::string, void (*)(Robot&, double)>;
  static const Verbs& kVerbs() {
    static const Verbs all{
        {"velocity", [](Robot& r, double v) { r.set_velocity(v); }},
        {"rotation", [](Robot& r, double v) { r.set_rotation_velocity(v); }},
        {"heading", [](Robot& r, double v) { r.set_heading(radians(v)); }},
        {"hold", [](Robot& r, double) { r.set_heading(r.pose_in_odom().th); }},
        {"turn", [](Robot& r, double v) { r.turn_by(radians(v)); }},
        {"wheels", [](Robot& r, double v) { r.set_wheel_velocities(v / 2.0, v); }},
        {"move", [](Robot& r, double v) { r.move_by(v); }},
        {"stop", [](Robot& r, double) { r.stop(); }},
        {"emergency", [](Robot& r, double) { r.emergency_stop(); }},
        {"brake", [](Robot& r, double v) { r.brake(v != 0.0); }},
        {"enable", [](Robot& r, double v) { r.enable(v != 0.0); }},
        {"origin", [](Robot& r, double) { r.set_origin(); }},
        {"clear", [](Robot& r, double) { r.clear_stalls(); }},
        {"limit", [](Robot& r, double v) { r.set_max_velocity(v); }},
        {"accelerate", [](Robot& r, double v) { r.set_acceleration(v); }},
        {"decelerate", [](Robot& r, double v) { r.set_deceleration(v); }},
        {"charge", [](Robot& r, double v) { r.set_battery(v); }}};
    return all;
  }
  using Facts = std::map<std::string, double (*)(Robot&)>;
  static const Facts& kFacts() {
    static const Facts all{
        {"x", [](Robot& r) { return r.pose_in_world().x; }},
        {"y", [](Robot& r) { return r.pose_in_world().y; }},
        {"th", [](Robot& r) { return degrees(r.pose_in_world().th); }},
        {"odom.x", [](Robot& r) { return r.pose_in_odom().x; }},
        {"odom.y", [](Robot& r) { return r.pose_in_odom().y; }},
        {"odom.th", [](Robot& r) { return degrees(r.pose_in_odom().th); }},
        {"velocity", [](Robot& r) { return r.velocity(); }},
        {"rotation", [](Robot& r) { return r.rotation_velocity(); }},
        {"left", [](Robot& r) { return r.left_velocity(); }},
        {"right", [](Robot& r) { return r.right_velocity(); }},
        {"target", [](Robot& r) { return r.target_velocity(); }},
        {"moving", [](Robot& r) { return r.moving() ? 1.0 : 0.0; }},
        {"clearance", [](Robot& r) { return r.clearance(); }},
        {"contacts", [](Robot& r) { return 1.0 * r.contacts(); }},
        {"left_stalled", [](Robot& r) { return r.left_stalled() ? 1.0 : 0.0; }},
        {"right_stalled", [](Robot& r) { return r.right_stalled() ? 1.0 : 0.0; }},
        {"front", [](Robot& r) { return 1.0 * r.bumpers(5, false); }},
        {"rear", [](Robot& r) { return 1.0 * r.bumpers(5, true); }},
        {"no_bumper", [](Robot& r) { return 1.0 * r.bumpers(0, false); }},
        {"battery", [](Robot& r) { return r.battery(); }}};
    return all;
  }
  static const std::map<std::string, double RobotParameters::*>& kParameters() {
    static const std::map<std::string, double RobotParameters::*> all{
        {"max_velocity", &RobotParameters::max_velocity},
        {"deceleration", &RobotParameters::deceleration},
        {"max_acceleration", &RobotParameters::max_acceleration},
        {"sonar_min_range", &RobotParameters::sonar_min_range}};
    return all;
  }
  /// The last number of a line.
  static double number(const std::string& line) {
    const std::string last = line.substr(line.rfind(' ') + 1);
    return std::isalpha(static_cast<unsigned char>(last[0])) != 0 ? 0.0 : std::stod(last);
  }
  static Pose pose(const std::string& text) {
    std::istringstream in(text);
    Pose pose;
    in >> pose.x >> pose.y >> pose.th;
    return {pose.x, pose.y, radians(pose.th)};
  }

  Scene& scene() {
    if (!scene_) {
      world_ = parse_world(text_, "scene.wld");
      scene_ = std::make_unique<Scene>(world_);
    }
    return *scene_;
  }
  void add(const Pose& start) {
    robot_ = &scene().add_robot(parameters_, start, watches_.size() + 1);
    start_ = start;
    watches_.push_back(std::make_unique<ContactWatch>(scene(), robot_->number(), parameters_));
  }
  void run(long ticks) {
    for (; ticks > 0 && testing::Test::HasFailure() == failed_; --ticks) {
      scene().tick();
      for (const auto& watch : watches_)
        watch->tick();
      for (const std::string& fact : always_)
        check(fact);
    }
  }

  std::optional<double> range_at(const Pose& at) {
    return Sonars(scene(), kNobody, parameters_, model_, 1).fire(0, at).range;
  }
  void hear(const std::string& line, const std::string& rest) {
    std::istringstream in(rest);
    double range = 0.0;
    double tolerance = 0.0;
    in >> range >> range >> range >> range >> tolerance;
    EXPECT_NEAR(range_at(pose(rest)).value_or(0.0), range, tolerance) << line;
  }

  void check(const std::string& line) {
    SCOPED_TRACE("tick " + std::to_string(scene().ticks()));
    test::expect_compared(line, fact(line.substr(0, line.find(' '))));
  }
  double fact(const std::string& name) {
    if (const auto known = kFacts().find(name); known != kFacts().end())
      return known->second(*robot_);
    if (name == "drift") {
      const Pose counted = compose(start_, robot_->pose_in_odom());
      return (counted.position() - robot_->pose_in_world().position()).norm();
    }
    if (name == "touched")
      return static_cast<double>(watch().contacts().size());
    if (name == "closest_person")
      return watch().closest_person();
    if (name == "heard" || name == "needed" || name == "towards") {
      const Contact& first = watch().contacts().at(0);
      return name == "heard" ? first.heard : name == "needed" ? first.needed : first.towards;
    }
    const std::size_t dot = name.find('.');
    return of(name.substr(0, dot), name.substr(dot + 1));
  }
  /// A member of a person, a door or a box of that name.
  double of(const std::string& name, const std::string& member) {
    for (const Person& person : scene().persons())
      if (person.plan->look.name == name)
        return member == "x" ? person.at.x() : member == "y" ? person.at.y() : gap(person, member);
    for (const Door& door : scene().doors())
      if (door.plan->look.name == name) {
        const Segment leaf = scene().leaf(door);
        return member == "angle"  ? degrees(door.angle)
               : member == "open" ? (door.opens ? 1.0 : 0.0)
               : member == "wide" ? (leaf.to - leaf.from).norm()
               : member == "x"    ? leaf.to.x()
               : member == "y"    ? leaf.to.y()
                                  : throw std::invalid_argument("no " + member);
      }
    for (const Box& box : scene().boxes())
      if (box.plan->look.name == name)
        return member == "x"      ? box.pose_in_world.x
               : member == "y"    ? box.pose_in_world.y
               : member == "rear" ? box.pose_in_world.x - robot_->pose_in_world().x
               : member == "th"   ? degrees(box.pose_in_world.th)
                                  : throw std::invalid_argument("no " + member);
    throw std::invalid_argument("no " + name);
  }
  /// Between a person and the nearest wall, robot or other person [m].
  double gap(const Person& person, const std::string& what) {
    double least = std::numeric_limits<double>::infinity();
    if (what != "wall" && what != "robot" && what != "other")
      throw std::invalid_argument("no " + what);
    if (what == "wall")
      least = distance(scene().world().segments, person.at);
    for (RobotNumber i = 0; what == "robot" && i < scene().robots(); ++i) {
      const Robot& robot = scene().robot(i);
      least =
          std::min(least, (robot.pose_in_world().position() - person.at).norm() - robot.radius());
    }
    for (const Person& other : scene().persons())
      if (what == "other" && &other != &person)
        least = std::min(least, (other.at - person.at).norm() - other.plan->radius);
    return least - person.plan->radius;
  }

  const ContactWatch& watch() const { return *watches_.at(robot_->number()); }
  std::string first_contact() const {
    constexpr const char* kBlames[]{"caused", "walked-into", "unseen"};
    constexpr const char* kKinds[]{"person", "post", "box", "door", "robot", "wall"};
    const Contact& first = watch().contacts().at(0);
    return std::string(kBlames[static_cast<int>(first.blame)]) + " " +
           kKinds[static_cast<int>(first.kind)] + (first.name.empty() ? "" : " " + first.name) +
           (first.walks ? " walks" : "");
  }

  std::string text_ =
      "width 10000 height 10000 0 0 10000 0 10000 0 10000 10000 "
      "10000 10000 0 10000 0 10000 0 0";
  World world_;
  std::unique_ptr<Scene> scene_;
  RobotParameters parameters_;
  SonarModel model_ = exact();
  Pose start_;
  Robot* robot_ = nullptr;
  std::vector<std::unique_ptr<ContactWatch>> watches_;
  std::vector<std::string> always_;
  const bool failed_ = testing::Test::HasFailure();  ///< an earlier case has
};

TEST(Scenes, GoOnAsWritten) {
  EXPECT_EQ(test::play<Play>("sim/test/scenes.txt"), 65);
}

}  // namespace
}  // namespace saphira::sim
