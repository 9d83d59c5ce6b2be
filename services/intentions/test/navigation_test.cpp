// The functions of navigation.txt; and the activities that use them.
#include "saphira/intentions/navigation.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "language_bench.hpp"
#include "lines.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::intentions {
namespace {

// A corridor along x with a room on each side, and a second corridor that crosses its east end.
const char* const kMap = R"(
CORRIDOR (1) 5000, 0, 0, 10000, 2000 "hall"
CORRIDOR (2) 10000, 0, 90, 12000, 2000 "cross"
OFFICE (11) 3000, 3000, 90, 4000, 4000 "north"
DOOR (111) 3000, 1000, -90, 900 "north"
OFFICE (12) 3000, -3000, 90, 4000, 4000 "south"
DOOR (112) 3000, -1000, 90, 900 "south"
DOOR (113) 4500, -1000, 90, 900 "south"
POS (20) 8000, 0, 0 "corner"
)";

/// A robot on the map, of which odom is the frame here.
class Site {
 public:
  Site() {
    add_navigation(functions);
    know_map("");
    around.topology = std::make_shared<const maps::Topology>(*around.map);
    around.map_revision = 1;
    around.registration.state = v1::REGISTRATION_TRACKING;
    robot.connected = true;
    be_at({1.0, 0.0, 0.0});
  }
  void know_map(const std::string& more) {
    around.map = std::make_shared<const maps::Map>(maps::parse_map(kMap + more, "test.map"));
  }
  void be_at(const Pose& pose) {
    robot.pose_in_odom = pose;
    robot.odom_in_map = Pose{};
    around.registration.pose_in_map = pose;
  }
  World world() { return {robot, around, beliefs, now}; }
  Value call(const std::string& name, const std::vector<Value>& arguments) {
    const Function* const function = functions.function(name);
    EXPECT_NE(function, nullptr) << name;
    return function->call(world(), arguments);
  }
  Value condition(const std::string& name) { return functions.condition(name)->value(world()); }

  Functions functions = core_functions();
  Beliefs beliefs{&functions};
  Robot robot;
  Surroundings around;
  Ticks now = 1000;
};

/// One case: "function argument ... => value". An argument is a value, a "*condition*",
/// "path:PLACE", or "$name" with a kept value, of whose list "$name.1" is a part.
class Calls : public test::LinePlayer {
 public:
  Calls() {
    events_ = {
      ON("at", s_.be_at(pose(in))),
      ON("place-unknown", s_.robot.odom_in_map.reset()),
      ON("hull", s_.around.robot_radius = read<double>(in)),
      ON("ticks", s_.now += read<Ticks>(in)),
      ON("cycle", s_.around.cycle = read<std::uint64_t>(in)),
      ON("revision", s_.around.map_revision = read<std::uint64_t>(in)),
      {"zones",
       [this](auto& in) {
         std::string lines = rest(in);
         for (std::size_t at = 0; (at = lines.find(" / ")) != std::string::npos;)
           lines.replace(at, 3, "\n");
         s_.know_map(lines);
       }},
      ON("hear", hear(in)),
      ON("believe", const auto name = read<std::string>(in);
         s_.beliefs.set(name, value_of(rest(in)), "test", s_.now)),
      ON("forget", s_.beliefs.unset(rest(in))),
      ON("keep", const auto name = read<std::string>(in); kept_[name] = value_of(rest(in))),
      ON("things", look_around()),
      ON("no-things", things_.clear()),
      ON("nobody-looks", s_.around.things = nullptr),
      {"stands",
       [this](auto& in) {
         things_.resize(1);
         things_[0].pose_in_odom = pose(in);
         s_.around.things = &things_;
       }}
    };
    facts_ = {IS("limit ahead", limit(false)), IS("limit back", limit(true))};
  }
  void take(const std::string& line) {
    const std::size_t arrow = line.find(" => ");
    if (arrow == std::string::npos)
      return LinePlayer::take(line);
    std::string is;
    try {
      is = told(value_of(line.substr(0, arrow)));
    } catch (const ActivityError&) {
      is = "error";
    }
    expect_like(is, line.substr(arrow + 4));
  }

 private:
  static Pose pose(std::istringstream& in) {
    Pose made{read<double>(in), read<double>(in), 0.0};
    double heading = 0.0;
    in >> heading;
    made.th = radians(heading);
    return made;
  }
  static std::string told(const Value& value) {
    if (value.nil())
      return "nil";
    if (const double* const number = value.number())
      return decimal(*number, 3);
    if (const Point* const point = value.point())
      return to_text(value).substr(0, 7) +
             format("%.2f %.2f %.0f ", point->pose.x, point->pose.y, degrees(point->pose.th)) +
             (point->frame == Frame::odom ? "odom" : "map");
    return value.text() != nullptr ? *value.text() : spoken(value);
  }
  /// A call, or the only argument.
  Value value_of(const std::string& line) {
    const std::vector<std::string> words = parts(line);
    if (words.size() == 1 && s_.functions.function(words[0]) == nullptr)
      return argument(words[0]);
    std::vector<Value> arguments;
    for (std::size_t i = 1; i < words.size(); ++i)
      arguments.push_back(argument(words[i]));
    return s_.call(words[0], arguments);
  }
  Value argument(const std::string& word) {
    if (word.starts_with("path:"))
      return s_.call("find-path", {s_.condition("*cur-region*"), word.substr(5)});
    if (s_.functions.condition(word) != nullptr)
      return s_.condition(word);
    if (word[0] != '$')
      return parse_value(word);
    const std::size_t dot = word.find('.');
    const Value& kept = kept_.at(word.substr(1, dot - 1));
    return dot == std::string::npos ? kept : kept.list().at(std::stoul(word.substr(dot + 1)));
  }
  /// The words of a line; brackets and quotation marks hold theirs together.
  static std::vector<std::string> parts(const std::string& line) {
    std::vector<std::string> all;
    std::string part;
    int depth = 0;
    bool quoted = false;
    for (const char c : line + " ") {
      quoted = quoted != (c == '"');
      depth += c == '(' ? 1 : c == ')' ? -1 : 0;
      if (c != ' ' || quoted || depth > 0)
        part += c;
      else if (!part.empty())
        all.push_back(std::exchange(part, {}));
    }
    return all;
  }
  /// Nothing but these echoes [m] of three sonars ahead.
  void hear(std::istringstream& in) {
    lps::LpsSettings settings;
    settings.sonars = {{0, {0.1, 0.1, 0.2}}, {1, {0.1, 0.0, 0.0}}, {2, {0.1, -0.1, -0.2}}};
    heard_ = std::make_unique<lps::LocalPerceptualSpace>(settings);
    s_.around.lps = heard_.get();
    std::vector<lps::SonarReading> readings;
    for (int sonar = 0; sonar < 3; ++sonar)
      readings.push_back({sonar, read<double>(in), true});
    for (std::uint64_t cycle = 1; cycle < 10; ++cycle)
      heard_->update(s_.robot.pose_in_odom, readings, cycle);
  }
  /// Two persons and a blob, of which only the direction is known.
  void look_around() {
    s_.around.cycle = 100;
    s_.around.things = &things_;
    things_ = {{.id = 7, .pose_in_odom = {4.0, 0.0, kPi}, .seen = 90},
               {.id = 8, .pose_in_odom = {1.0, 2.0, -kPi / 2}, .seen = 100},
               {.id = 9,
                .kind = lps::SeenThing::Kind::blob,
                .channel = 1,
                .pose_in_odom = {3.0, -2.0, 0.0},
                .range_known = false,
                .area = 0.02,
                .seen = 100}};
    for (int person = 0; person < 2; ++person) {
      things_[person].velocity_in_odom = {0.3, 0.4};
      things_[person].confidence = 0.9;
    }
  }
  std::string limit(bool back) {
    const SpeedLimit limit = speed_limit(s_.world(), back);
    return decimal(limit.speed, 3) + (limit.reason.empty() ? "" : " " + limit.reason);
  }

  Site s_;
  std::map<std::string, Value> kept_;
  std::unique_ptr<lps::LocalPerceptualSpace> heard_;
  std::vector<lps::SeenThing> things_;
};

TEST(Navigation, IsAsWritten) {
  EXPECT_EQ(test::play<Calls>("services/intentions/test/navigation.txt"), 22);
}

class Exploring : public testing::Test, protected Site {};

TEST_F(Exploring, NobodyIsAskedToOpenAWayThatIsOpen) {
  const auto reason_after = [&](const std::string& ending, double confidence, int messages) {
    Stage stage(read_file(std::getenv("SAPHIRA_SOURCE_DIR") +
                          std::string("/config/activities/navigation.act")) +
                    "(defintention :plan-and-execute :params (dest)"
                    " :goals '((EXECUTE (say \"I try\")) " +
                    ending + "))",
                functions);
    stage.inputs.around = around;
    stage.inputs.around.registration.confidence = confidence;
    stage.inputs.robot = robot;
    stage.inputs.robot.odom = 1;
    stage.ask(1, "go_to_place", {text("place", "north"), number("patience", 1.0)});
    stage.step(120);
    EXPECT_EQ(std::count(stage.messages.begin(), stage.messages.end(), "I try"), messages);
    EXPECT_EQ(stage.status(1).state, v1::GOAL_FAILED);
    return stage.status(1).reason;
  };
  EXPECT_EQ(reason_after("(FAIL \"a behavior is missing\")", 1.0, 4),
            "it has not come to north, though it knows a way: a behavior is missing");
  EXPECT_EQ(reason_after("(SUCCEED \"at the end of the path\")", 1.0, 4),
            "it has not come to north, though it knows a way: its path ended elsewhere");
  // Only the evidence for its place makes the difference.
  const std::string closed =
      "(EXECUTE (setq *closed-ways* (closed-ways-with (first (find-path *cur-region* dest)))))"
      " (FAIL \"x\")";
  const std::string sure = reason_after(closed, 1.0, 2);
  EXPECT_TRUE(reason_after(closed, 0.8, 2).starts_with(sure + ", if the robot is where")) << sure;
}

TEST_F(Exploring, ExploringGoesToTheNearestEndFirstAndComesToAnEnd) {
  Value visited;
  double last = 0.0;
  int places = 0;
  for (; places < 20; ++places) {
    const Value next = call("next-to-explore", {visited});
    if (next.nil())
      break;
    const Pose at = next.point()->pose;
    if (places == 0)
      last = (at.position() - robot.pose_in_odom.position()).norm();
    visited = functions.function("cons")->call(world(), std::vector<Value>{next, visited});
  }
  // The robot is at the west end.
  EXPECT_EQ(places, 3);
  EXPECT_NEAR(last, 8.0, 0.1);
}

}  // namespace
}  // namespace saphira::intentions
