// Input and output of the command line: the lines of words.txt.
#include "saphira/cli/words.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>
#include <tuple>

#include "asked.hpp"
#include "lines.hpp"
#include "sample.hpp"
#include "saphira/cli/device_words.hpp"
#include "saphira/cli/displays.hpp"
#include "saphira/cli/done.hpp"
#include "saphira/cli/goal_words.hpp"
#include "saphira/cli/map_words.hpp"
#include "saphira/cli/talk_words.hpp"
#include "saphira/geometry/pose.hpp"
#include "trouble.hpp"

namespace saphira::cli {
namespace {

using Json = nlohmann::json;
using test::sample;
using test::samples;

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream in(text);
  for (std::string word; in >> std::quoted(word);)
    all.push_back(word);
  return all;
}

maps::Map a_map() {
  return maps::parse_map(
      "CORRIDOR (1) 0, 0, 0, 10000, 2000 \"hall\"\nPOS (9) 1000, 2000, 90 \"start\"\n"
      "DOOR (3) 2000, 1000, -90, 900\n",
      "a.map");
}

/// The object of that name in a JSON; nothing: it has none.
template <class T>
std::optional<T> part(const Json& json, const char* name) {
  return json.contains(name) ? std::optional(sample<T>(json[name])) : std::nullopt;
}
template <class T>
const T* address(const std::optional<T>& known) {
  return known ? &*known : nullptr;
}

SeenProcess program(const Json& json) {
  return {.status = sample<v1::ServiceStatus>(json.value("status", Json::object())),
          .age = json.value("age", 0.0),
          .namesake = json.value("namesake", false)};
}
std::vector<SeenProcess> programs(const Json& json) {
  std::vector<SeenProcess> all;
  std::ranges::transform(json, std::back_inserter(all), program);
  return all;
}

std::string text_of(const DeviceCommand& command) {
  return std::string(command.topic->name) + ": " + saphira::describe(command.request);
}

Move move_of(const Json& json) {
  static const std::map<std::string, Move::Kind> kinds{
      {"move", Move::Kind::move}, {"turn", Move::Kind::turn}, {"speed", Move::Kind::speed}};
  const double value = json.at("value");
  const std::string name = json.at("move");
  return {kinds.at(name), name, name == "turn" ? radians(value) : value, json.value("speed", 0.0)};
}

/// The report about a way: done or not, and the rest of it.
std::string progress(const Json& json) {
  const Move move = move_of(json);
  auto grant = part<v1::Grant>(json, "grant").value_or(v1::Grant());
  grant.stamp.epoch = 1;
  const auto robot = part<v1::RobotState>(json, "robot").value_or(v1::RobotState());
  Course course(move);
  const Course::State state = course.update(true, grant, robot);
  return (state == Course::State::done ? "done" : "not done") + course.rest();
}

using In = const std::string&;
using Words = std::vector<std::string>;

template <class T>
T of(In input) {
  return sample<T>(Json::parse(input));
}
/// The first word, and the others.
std::pair<std::string, Words> headed(In input) {
  Words words = words_of(input);
  const std::string first = words.at(0);
  words.erase(words.begin());
  return {first, words};
}

std::string devices_of(const Json& json) {
  const auto devices = part<v1::Devices>(json, "devices");
  return table(device_rows(sample<v1::RobotState>(json.at("robot")), address(devices)));
}
std::string intentions_of(const Json& json) {
  const auto behaviors = part<v1::BehaviorSet>(json, "behaviors");
  return intentions_display(sample<v1::Intentions>(json.at("intentions")), address(behaviors));
}
std::string behavior_of(const Json& json) {
  const auto intended = part<v1::IntendedBehavior>(json, "intended");
  const auto schema = part<v1::BehaviorSchema>(json, "schema");
  return behavior_display(sample<v1::BehaviorState>(json.at("state")), address(intended),
                          address(schema));
}
std::string order_of(const std::vector<v1::GoalStatus>& statuses) {
  std::map<std::pair<std::uint64_t, std::uint64_t>, v1::GoalStatus> goals;
  for (const v1::GoalStatus& status : statuses)
    goals[{status.id.writer, status.id.number}] = status;
  std::string text;
  for (const v1::GoalStatus& status : by_acceptance(goals))
    text += (text.empty() ? "" : " ") + status.functor;
  return text;
}
std::string question_of(const v1::Request& request) {
  std::string text = request.functor;
  for (const v1::Argument& argument : request.arguments)
    text += " " + argument.name + "=" + value_text(argument) +
            (argument.kind == v1::ARGUMENT_UNBOUND ? argument.text : "");
  return text;
}

const std::map<std::string, std::string (*)(In)>& answers() {
  static const std::map<std::string, std::string (*)(In)> all{
      {"argument", [](In s) { return test::json_of(parse_argument(s)); }},
      {"goal", [](In s) { return describe(parse_request(words_of(s))); }},
      {"goal-of", [](In s) { return describe(std::apply(parse_goal, headed(s))); }},
      {"order", [](In s) { return order_of(samples<v1::GoalStatus>(Json::parse(s))); }},
      {"advice", [](In s) { return advice_after_failure(parse_request(words_of(s))); }},
      {"device", [](In s) { return text_of(parse_device(words_of(s))); }},
      {"devices", [](In s) { return devices_of(Json::parse(s)); }},
      {"map", [](In s) { return saphira::describe(parse_map_request(words_of(s), a_map())); }},
      {"check-map", [](In s) { return check_map_words(words_of(s)), std::string("well"); }},
      {"where", [](In s) { return describe(of<v1::Registration>(s), a_map()); }},
      {"answer", [](In s) { return to_json(of<v1::Answer>(s)); }},
      {"agents", [](In s) { return describe(samples<v1::Agent>(Json::parse(s))); }},
      {"question", [](In s) { return question_of(parse_question(words_of(s))); }},
      {"trigger", [](In s) { return describe(of<v1::Trigger>(s), "1f3a:2", true); }},
      {"waiting-trigger",
       [](In s) {
         return describe(of<v1::Trigger>(s), "1f3a:2", true, "no agent can do \"pong\"");
       }},
      {"dead-trigger", [](In s) { return describe(of<v1::Trigger>(s), "1f3a:2", false); }},
      {"intentions", [](In s) { return intentions_of(Json::parse(s)); }},
      {"instance", [](In s) { return without_instance(s) + "; " + instance_words(s); }},
      {"behaviors", [](In s) { return behaviors_display(of<v1::BehaviorSet>(s)); }},
      {"behavior", [](In s) { return behavior_of(Json::parse(s)); }},
      {"unknown-behavior", [](In s) { return std::apply(unknown_behavior, headed(s)); }},
      {"schema", [](In s) { return schema_display(of<v1::BehaviorSchema>(s)); }},
      {"beliefs",
       [](In s) {
         const Json json = Json::parse(s);
         return beliefs_table(sample<v1::BeliefSet>(json.at("set")), json.value("part", ""));
       }},
      {"processes", [](In s) { return processes_table(samples<v1::ProcessSet>(Json::parse(s))); }},
      {"table", [](In s) { return table(Json::parse(s).get<std::vector<Words>>()); }},
      {"two-lines",
       [](In s) {
         const Words words = words_of(s);
         const auto lines = two_lines(words.at(1), std::stoul(words.at(0)));
         return lines[0] + "\n" + lines[1];
       }},
      {"status",
       [](In s) {
         const Json json = Json::parse(s);
         return status_table(programs(json.at("programs")), json.value("unheard", Words()));
       }},
      {"second", [](In s) { return second_deployment(programs(Json::parse(s))); }},
      {"command", [](In s) { return test::json_of(command_of(move_of(Json::parse(s)))); }},
      {"progress", [](In s) { return progress(Json::parse(s)); }},
      {"trouble", [](In s) { return trouble_of(move_of(Json::parse(s))); }}};
  return all;
}

struct Asked {
  static std::string answer(const std::string& verb, const std::string& input) {
    return answers().at(verb)(input);
  }
  /// Of a sample the members that are not 0, false or empty are written.
  static std::string canonical(const std::string& verb, const std::string& wanted) {
    if (verb == "argument")
      return test::json_of(sample<v1::Argument>(Json::parse(wanted)));
    return verb == "command" ? test::json_of(sample<v1::MotorCommand>(Json::parse(wanted)))
                             : wanted;
  }
};

TEST(Words, AreAsWritten) {
  EXPECT_EQ(test::play<test::Questions<Asked>>("agents/cli/test/words.txt"), 38);
}

TEST(Words, AMapFileThatWasCutOffIsRefused) {
  const test::TempDir folder;
  const auto loaded = [&](const std::string& text) {
    std::ofstream(folder.path("a.map")) << text;
    return test::trouble([&] { parse_map_request({"load", folder.path("a.map")}, a_map()); });
  };
  EXPECT_EQ(loaded("DOOR (2) 1000, 2000, 90, 900\n"), "");
  const std::string said = loaded("DOOR (2) 1000, 2000, 90, 90");
  EXPECT_TRUE(test::has(said, ".map:1:") && test::has(said, "cut off")) << said;
}

TEST(Words, ALongValueIsRefused) {
  EXPECT_THROW(parse_argument("a=" + std::string(256, 'x')), std::invalid_argument);
}

TEST(Words, EqualValuesOfTwoAgentsAreTwoAnswers) {
  v1::Answer answer{.service = "calendar", .text = "on its way"};
  EXPECT_TRUE(repeats(answer, answer)) << "it says again that it is at work";
  EXPECT_FALSE(repeats(answer, v1::Answer()));
  answer.results.resize(1);
  EXPECT_FALSE(repeats(answer, answer));
}

TEST(Words, SentencesOfBeforeAreNotForAListener) {
  const v1::Utterance said{.answers = {.writer = 7}};
  EXPECT_TRUE(is_for(said, 9.0, 7, 2.0)) << "its answer";
  EXPECT_TRUE(is_for(said, 1.9, 8, 2.0));
  EXPECT_FALSE(is_for(said, 2.1, 8, 2.0));
}

TEST(Words, ATriggerIsAmongOthersByItsWholeId) {
  EXPECT_TRUE(is_among("1f3a:2", "1:4 1f3a:2"));
  EXPECT_FALSE(is_among("1f3a:2", "1:4 1f3a:22"));
  EXPECT_FALSE(is_among("1f3a:2", ""));
}

TEST(Words, TheEndingIsThatOfTheContent) {
  EXPECT_NO_THROW(expect_ending("floor.svg", ".svg"));
  EXPECT_EQ(test::trouble_of<std::invalid_argument>([] { expect_ending("floor.txt", ".svg"); }),
            "floor.txt: expected a name that ends with .svg, the kind of file that this writes");
}

SeenProcess process(const std::string& name, std::uint32_t pid, bool namesake) {
  SeenProcess seen;
  seen.status.name = name;
  seen.status.pid = pid;
  seen.status.host = "attic";
  seen.namesake = namesake;
  return seen;
}

const std::vector<SeenProcess> kOne{process("bridge", 1, false), process("intentions", 2, false)};
const std::vector<SeenProcess> kTwo{process("bridge", 1, false), process("bridge", 8, true),
                                    process("intentions", 2, false),
                                    process("intentions", 9, true)};

TEST(SecondDeployment, IsToldOnceWhenItIsCertain) {
  SecondDeployment second;
  EXPECT_FALSE(second.news(kOne, 0.0));
  EXPECT_FALSE(second.doubtful());
  EXPECT_FALSE(second.news(kTwo, 1.0));
  EXPECT_TRUE(second.doubtful());
  EXPECT_FALSE(second.news(kTwo, 2.9));
  EXPECT_EQ(second.news(kTwo, 3.0), second_deployment(kTwo));
  EXPECT_FALSE(second.news(kTwo, 9.0));
  EXPECT_FALSE(second.doubtful());
  EXPECT_FALSE(second.news(kOne, 10.0));
  ASSERT_TRUE(second.news(kOne, 12.0));
  EXPECT_FALSE(second.news(kOne, 20.0));
}

TEST(SecondDeployment, AProgramThatIsStartedAgainIsNone) {
  SecondDeployment second;
  EXPECT_FALSE(second.news(kTwo, 1.0));
  EXPECT_FALSE(second.news(kOne, 2.0));
  EXPECT_FALSE(second.doubtful());
  EXPECT_FALSE(second.news(kTwo, 10.0));
  EXPECT_FALSE(second.news(kOne, 11.9));
  EXPECT_FALSE(second.news(kOne, 99.0));
}

TEST(Course, AnInterruptedMoveIsNotDone) {
  const Move move{Move::Kind::move, "move", 1.0};
  v1::RobotState robot;
  const auto grant = [](double left, std::uint64_t epoch = 7) {
    return v1::Grant{.stamp = {.epoch = epoch}, .distance_left = left};
  };
  Course stopped(move);
  EXPECT_EQ(stopped.update(false, grant(0.0), robot), Course::State::waits);
  EXPECT_EQ(stopped.update(true, grant(0.4), robot), Course::State::drives);
  EXPECT_EQ(stopped.update(false, grant(0.0), robot), Course::State::interrupted);
  EXPECT_EQ(stopped.update(true, grant(0.0), robot), Course::State::interrupted)
      << "the bridge does not begin it again";
  EXPECT_EQ(stopped.rest(), ", 0.40 m left");
  Course restarted(move);
  restarted.update(true, grant(0.4), robot);
  EXPECT_EQ(restarted.update(true, grant(1.0, 8), robot), Course::State::interrupted);
  EXPECT_EQ(restarted.left(), 0.4);
}

TEST(Course, NothingGoesOnAfterACut) {
  const auto grant = [](std::uint64_t cycle) {
    return v1::Grant{.stamp = {.epoch = 7, .cycle = cycle}, .distance_left = 1.0};
  };
  for (const Move::Kind kind : {Move::Kind::move, Move::Kind::speed})
    for (const std::uint64_t gap : {5, 6}) {
      Course course({kind, "", 1.0});
      course.update(true, grant(10), {});
      const Course::State after = course.update(true, grant(10 + gap), {});
      EXPECT_EQ(after, gap > 5 ? Course::State::interrupted : Course::State::drives) << gap;
    }
  Course speed({Move::Kind::speed, "speed", 0.3});
  EXPECT_EQ(speed.update(false, grant(9), {}), Course::State::waits);
  EXPECT_EQ(speed.update(true, grant(10), {}), Course::State::drives);
  EXPECT_EQ(speed.update(false, grant(14), {}), Course::State::drives);
  EXPECT_EQ(speed.update(true, grant(15), {}), Course::State::drives);
  EXPECT_EQ(speed.update(false, grant(21), {}), Course::State::interrupted)
      << "somebody else drives";
  EXPECT_EQ(speed.update(true, grant(22), {}), Course::State::interrupted);
}

TEST(Course, AnInterruptedTurnKeepsItsTarget) {
  Course course({Move::Kind::turn, "turn", 1.0});
  v1::RobotState robot;
  robot.pose_in_odom.th = 0.3;
  course.update(true, {.stamp = {.epoch = 7}, .rotation = v1::ROTATION_HEADING, .heading = 1.0},
                robot);
  robot.pose_in_odom.th = 0.5;
  EXPECT_EQ(course.update(false, {.stamp = {.epoch = 7}}, robot), Course::State::interrupted);
  EXPECT_DOUBLE_EQ(course.left(), 0.5);
}

}  // namespace
}  // namespace saphira::cli
