// The registration service without a bus: its answers, decisions, memory and outputs, by core.txt.
#include "saphira/registration/core.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "arguments.hpp"
#include "lines.hpp"
#include "process.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/random.hpp"
#include "saphira/base/text.hpp"
#include "saphira/idl/members.hpp"

namespace saphira::registration {
namespace {

using test::pose_of;

constexpr int kSonars = 16;
constexpr const char* kHall =
    "CORRIDOR (1) 10000, 0, 0, 20000, 2000 \"hall\"\n"
    "DOOR (2) 3000, 1000, -90, 900\n"
    "DOOR (3) 6000, 1000, -90, 900\n"
    "POS (6) 3500, 0, 0 \"start\"\n";

std::vector<lps::SonarMount> mounts() {
  std::vector<lps::SonarMount> result;
  for (int i = 0; i < kSonars; ++i)
    result.push_back({i, {0.0, 0.0, norm2_angle(2.0 * kPi * i / kSonars)}});
  return result;
}

/// A corridor of 2 m, whose walls the robot hears as it drives to and fro. Requests and lost links
/// come with a step.
class Robot {
 public:
  explicit Robot(std::uint64_t seed = 1) : random_(seed) {}

  Core::Outputs step(Core& core) {
    ++cycle_;
    if (std::exchange(drives_, true)) {
      truth_ = compose(truth_, {0.03, 0.0, 0.0});
      odom_ = compose(odom_, {0.03 * random_.normal(1.0, 0.03), 0.0, random_.normal(0.0, 0.001)});
    }
    Core::Inputs inputs;
    inputs.cycle = cycle_;
    if (std::exchange(is_new_, false))
      inputs.new_robot = &mounts_;
    inputs.odom = frame_;
    inputs.pose_in_odom = odom_;
    for (int sonar = 0; sonar < kSonars; ++sonar)
      inputs.readings.push_back(hear(sonar));
    if (cycle_ % 5 == 0)
      for (const double side : {1.0, -1.0})
        inputs.percepts.push_back(wall(side));
    core.processes().step(cycle_);
    return core.step(inputs);
  }
  /// A step without a way.
  Core::Outputs stand(Core& core) {
    drives_ = false;
    return step(core);
  }
  /// The link was lost and is there again.
  void reconnect() {
    is_new_ = true;
    cycle_ = 0;
  }
  /// Dead reckoning begins anew.
  void new_frame() {
    ++frame_;
    odom_ = {};
  }
  const Pose& truth() const { return truth_; }
  std::uint64_t frame() const { return frame_; }
  const Pose& pose_in_odom() const { return odom_; }

 private:
  lps::SonarReading hear(int sonar) {
    const double across = std::sin(truth_.th + 2.0 * kPi * sonar / kSonars);
    lps::SonarReading reading;
    reading.sonar = sonar;
    reading.echo = std::abs(across) > 0.95;
    reading.range = reading.echo ? random_.normal(1.0, 0.01) / std::abs(across) : 5.0;
    return reading;
  }
  lps::Percept wall(double side) {
    return lps::Percept{.id = ++last_id_,
                        .type = lps::PointType::wall,
                        .pose_in_odom = compose(odom_, {0.0, side, side > 0.0 ? kPi : 0.0}),
                        .length = 1.5,
                        .sigma_along = 0.03,
                        .sigma_across = 0.03,
                        .sigma_heading = radians(1.0),
                        .confidence = 1.0,
                        .seen = cycle_,
                        .readings = {{cycle_, side > 0.0 ? 4 : 12}}};
  }

  Random random_;
  const std::vector<lps::SonarMount> mounts_ = mounts();
  bool is_new_ = true;
  bool drives_ = true;
  std::uint64_t cycle_ = 0;
  std::uint64_t frame_ = 1;
  std::uint32_t last_id_ = 0;
  Pose truth_{3.5, 0.0, 0.0};
  Pose odom_;
};

Core::Settings settings(const std::string& text = kHall) {
  Core::Settings made;
  made.map = maps::parse_map(text, "hall.map");
  made.source = text.empty() ? "" : "hall.map";
  made.start = start_pose("start", made.map);
  return made;
}

Request request(const std::string& functor) {
  return {functor};
}

Answer act(Core& core, const Request& request) {
  return core.between({&request, 1}).front();
}

Request request(const std::string& functor, bool on) {
  return {functor, {{"on", on}}};
}

Request load(const std::string& text, const std::string& name = "other.map") {
  return {"load", {{"text", text}, {"name", name}}};
}

Request place(const Pose& pose_in_map) {
  return {"place", {{"position", PlacedPoint{pose_in_map, Frame::map}}}};
}

Request put(const std::string& type, const Pose& pose_in_map, std::uint32_t id = 0) {
  return {"put",
          {{"id", static_cast<double>(id)},
           {"type", type},
           {"position", PlacedPoint{pose_in_map, Frame::map}},
           {"length", 1.0},
           {"width", 1.0}}};
}

Request remove(std::uint32_t id) {
  return {"remove", {{"id", static_cast<double>(id)}}};
}

std::uint32_t id_of(const Answer& answer) {
  return static_cast<std::uint32_t>(number_of(answer.results, "id"));
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// One case of core.txt: a robot in the hall, whose map is loaded.
class Hall : public test::LinePlayer {
 public:
  Hall() {
    events_ = {ON("no-map", settings_ = settings("")),
               ON("start-unknown", settings_.start.reset()),
               ON("stand", now_ = robot_.stand(core())),
               ON("step", step(read<int>(in))),
               ON("reconnect", robot_.reconnect()),
               ON("new-frame", robot_.new_frame()),
               ON("restart", restart(rest(in))),
               ON("suspend", ask_process(rest(in), ProcessAction::suspend)),
               ON("resume", ask_process(rest(in), ProcessAction::resume)),
               ON("ask", ask(in)),
               ON("asker", asker_ = {"planner", rest(in)}),
               ON("load", load_map(in)),
               ON("put", put_artifact(in)),
               ON("answers", answers(rest(in))),
               ON("reason", expect_like(now_.reason, rest(in))),
               ON("says", expect_like(said(), rest(in))),
               ON("near", near(now_.pose_in_map, pose_of(rest(in)), 0.1)),
               ON("keep", keep()),
               ON("as-kept", near(now_.pose_in_map, kept_, read<double>(in))),
               ON("place-ahead", place_ahead(read<double>(in))),
               ON("map-starts-near", map_starts_near(pose_of(rest(in)))),
               ON("has", EXPECT_TRUE(artifact(in))),
               ON("has-not", EXPECT_FALSE(artifact(in))),
               ON("has-at", EXPECT_TRUE(has_at(pose_of(rest(in)))))};
    facts_ = {IS("state", lowered(std::string(v1::name_of(now_.state)).substr(13))),
              IS("environment", std::to_string(now_.environment)),
              IS("trust", trust()),
              IS("less sure", yes(now_.covariance(0, 0) > kept_variance_)),
              IS("id", std::to_string(id_)),
              IS("rule", rule()),
              IS("source", core().map_source()),
              IS("changed", yes(core().map_changed())),
              IS("revised", yes(core().map_revision() > kept_revision_)),
              IS("artifacts", std::to_string(core().map().features.size())),
              IS("some artifacts", yes(!core().map().features.empty())),
              IS("adds", yes(core().adds_features())),
              IS("snaps", yes(core().snaps())),
              IS("remembers", remembers())};
  }

 private:
  Core& core() {
    if (!core_)
      core_.emplace(settings_);
    return *core_;
  }
  void step(int steps) {
    for (; steps > 0; --steps)
      now_ = robot_.step(core());
  }
  /// With a map of another file, perhaps.
  void restart(const std::string& source) {
    const auto remembered = restored<Remembered>(saved(*core().remembered()));
    if (!source.empty())
      settings_.source = source;
    core_.emplace(settings_, remembered);
  }
  void ask_process(const std::string& process, ProcessAction action) {
    EXPECT_EQ(core().processes().request(process, action), "");
  }
  void act(Request request) {
    request.person = asker_;
    answer_ = registration::act(core(), request);
    if (answer_.code == AnswerCode::done && answer_.results.size() == 1)
      id_ = id_of(answer_);
  }
  /// "true" and "false" are truths.
  void ask(std::istringstream& in) {
    Request request{read<std::string>(in)};
    request.arguments = test::arguments_of(rest(in));
    for (Argument& one : request.arguments)
      if (one.text == "true" || one.text == "false")
        one = {one.name, one.text == "true"};
    act(request);
  }
  void load_map(std::istringstream& in) {
    std::string name;
    in >> std::quoted(name);
    const std::string text = rest(in);
    act(load(text == "hall" ? kHall : text + "\n", name));
  }
  void put_artifact(std::istringstream& in) {
    const auto type = read<std::string>(in);
    const double x = read<double>(in);
    const double y = read<double>(in);
    std::uint32_t id = 0;
    in >> id;
    act(put(type, {x, y, 0.0}, id));
  }
  /// Nothing: it is done.
  void answers(const std::string& text) {
    expect_like(answer_.text, text);
    EXPECT_EQ(answer_.code == AnswerCode::done, text.empty());
  }
  std::string said() const {
    return joined(now_.notes.lines(), ", ", [](const Note& note) { return note.text; });
  }
  static void near(const Pose& is, const Pose& expected, double within) {
    EXPECT_NEAR(is.x, expected.x, within);
    EXPECT_NEAR(is.y, expected.y, within);
  }
  void keep() {
    kept_ = now_.pose_in_map;
    kept_variance_ = now_.covariance(0, 0);
    kept_revision_ = core().map_revision();
  }
  void place_ahead(double way) {
    kept_.x += way;
    act(place(kept_));
  }
  void map_starts_near(const Pose& expected) {
    const std::optional<Pose> start = start_pose("start", core().map());
    ASSERT_TRUE(start);
    near(*start, expected, 0.1);
  }
  const maps::Feature* artifact(std::istringstream& in) {
    return maps::find(core().map(), read<std::uint32_t>(in));
  }
  bool has_at(const Pose& pose) {
    return std::ranges::any_of(core().map().features,
                               [&](const auto& one) { return one.pose_in_map == pose; });
  }
  std::string trust() const {
    const double is = now_.confidence;
    return is == 0.0 ? "none" : is <= 0.5 ? "at most half" : is > 0.9 ? "full" : decimal(is, 2);
  }
  std::string rule() {
    const maps::Feature* const zone = maps::find(core().map(), id_);
    return zone == nullptr ? "none"
                           : std::string(maps::word(zone->rule)) + " " + decimal(zone->speed, 2);
  }
  std::string remembers() {
    const std::optional<Remembered> all = core().remembered();
    if (!all)
      return "nothing";
    EXPECT_EQ(all->map, core().map());
    if (!all->memory.filter)
      return "no place";
    if (all->memory.odom != robot_.frame())
      return "the place of another frame";
    const bool same = all->memory.filter->pose() == now_.pose_in_map &&
                      all->memory.pose_in_odom == robot_.pose_in_odom();
    return same ? "the place" : "another place";
  }

  Core::Settings settings_ = settings();
  std::optional<Core> core_;
  Robot robot_;
  Core::Outputs now_;
  Checked asker_;
  Answer answer_;
  std::uint32_t id_ = 0;  ///< of the newest answer with one
  Pose kept_;
  double kept_variance_ = 0.0;
  std::uint64_t kept_revision_ = 0;
};

TEST(RegistrationCore, DoesAsWritten) {
  EXPECT_EQ(test::play<Hall>("services/registration/test/core.txt"), 31);
}

TEST(RegistrationCore, AMapOnWhichNoRobotCanBeRegisteredIsRefused) {
  EXPECT_THROW(Core(settings("OFFICE (1) 0, 0, 0, 2000000, 2000000\n")), std::invalid_argument);
}

TEST(RegistrationCore, PlacesTheRobotAtNumbersAlone) {
  Core core(settings());
  Robot().stand(core);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Pose& wrong : {Pose{nan, 0.0, 0.0}, Pose{5.0, 0.0, nan}})
    EXPECT_TRUE(contains(act(core, place(wrong)).text, "within 10 km"));
}

TEST(RegistrationCore, WhatItCanBeAskedForIsDeclared) {
  for (Request one : {load(kHall), request("delete"), put("DOOR", {5.0, 0.0, 0.0}), remove(4),
                      place({5.0, 0.0, 0.0}), request("find"), request("switch", true),
                      request("add_features", false), request("snap", true)})
    EXPECT_FALSE(refusal(Core::functors(), one)) << describe(one);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (Request one : {request("sing"), request("switch"), remove(0), place({nan, 0.0, 0.0}),
                      put("", {5.0, 0.0, 0.0})})
    EXPECT_TRUE(refusal(Core::functors(), one)) << describe(one);
}

TEST(RegistrationCore, WhatItCanBeAskedForIsDocumented) {
  EXPECT_TRUE(contains(read_file(test::source("docs/requests.md")), help(Core::functors())))
      << help(Core::functors());
}

/// The events of a core on its way, by cycle.
void happen(int cycle, Core& core, Robot& robot) {
  switch (cycle) {
    case 40:
      act(core, put("POS", {5.0, 0.0, 0.0}));
      break;
    case 80:
      robot.new_frame();
      break;
    case 120:
      core.processes().request("test-match", ProcessAction::suspend, 15);
      break;
    case 160:
      act(core, request("add_features", true));
      break;
    case 200:
      robot.reconnect();
      break;
    case 240:
      act(core, request("add_features", false));
      break;
    case 280:
      act(core, request("find"));
      break;
    default:
      break;
  }
}

TEST(RegistrationCore, TheSameInputsGiveTheSameOutputs) {
  for (const char* map : {kHall, ""}) {
    Core a(settings(map));
    Core b(settings(map));
    Robot robot_a(3);
    Robot robot_b(3);
    for (int i = 0; i < 320; ++i) {
      happen(i, a, robot_a);
      happen(i, b, robot_b);
      ASSERT_EQ(robot_a.step(a), robot_b.step(b)) << i;
      ASSERT_EQ(a.map(), b.map()) << i;
      ASSERT_EQ(a.map_revision(), b.map_revision()) << i;
    }
    EXPECT_EQ(saved(a), saved(b));
  }
}

TEST(RegistrationCore, BuildingThatNobodyAsksForAgainEnds) {
  Core core(settings(""));
  Core unlimited(settings(""));
  Robot robot;
  Robot other;
  Request lease = request("add_features", true);
  lease.arguments.push_back(saphira::number("lease", 1.0));
  robot.step(core);
  other.step(unlimited);
  act(unlimited, request("add_features", true));
  for (int i = 0; i < 300; ++i) {
    if (i % 5 == 0) {
      EXPECT_EQ(act(core, lease).text, "");
    }
    EXPECT_EQ(robot.step(core).reason, "builds the map");
    other.step(unlimited);
  }
  EXPECT_FALSE(core.map().features.empty());
  EXPECT_EQ(core.map(), unlimited.map()) << "it was built in one piece";
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(core.adds_features());
    EXPECT_EQ(robot.step(core).reason, "builds the map");
  }
  EXPECT_FALSE(core.adds_features());
  EXPECT_EQ(robot.step(core).reason.find("builds"), std::string::npos);
  EXPECT_FALSE(maps::named(core.map(), lps::PointType::position, "start").empty());
}

}  // namespace
}  // namespace saphira::registration
