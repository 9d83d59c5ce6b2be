// The answers of saphira about a running robot in situations that this test brings about
// (docs/situations.md has those that are constructed from samples).

#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>

#include "process.hpp"

namespace saphira {
namespace {

using std::chrono::seconds;
using test::has;

class Situations : public testing::Test {
 protected:
  Situations()
      : environment_{{"SAPHIRA_ROBOT", test::unique_robot()}, {"SAPHIRA_DOMAIN", test::domain()}},
        up_(started({"up", "demo"}, "up")) {}

  test::Process started(const std::vector<std::string>& words, const std::string& name) {
    std::vector<std::string> command{"saphira"};
    command.insert(command.end(), words.begin(), words.end());
    return {command, folder_.path(name), environment_};
  }
  std::string said(const std::vector<std::string>& words) {
    return test::saphira(words, environment_).text;
  }
  /// Asks until the answer has all of these parts; returns the last answer.
  std::string until(const std::vector<std::string>& words, const std::vector<std::string>& parts) {
    std::string answer;
    EXPECT_TRUE(test::wait_until(
        [&] {
          answer = said(words);
          for (const std::string& part : parts)
            if (answer.find(part) == std::string::npos)
              return false;
          return true;
        },
        seconds(90)))
        << testing::PrintToString(parts) << "\n"
        << answer << up_.output();
    return answer;
  }
  pid_t pid_of(const std::string& program) {
    pid_t pid = 0;
    EXPECT_TRUE(test::wait_until([&] {
      const auto status = nlohmann::json::parse(said({"status", "--json"}), nullptr, false);
      if (status.is_object())
        for (const auto& one : status.at("programs"))
          if (one.at("name") == program && one.at("state") != "lost")
            pid = one.at("pid");
      return pid != 0;
    }));
    return pid;
  }
  test::TempDir folder_;
  std::map<std::string, std::string> environment_;
  test::Process up_;
};

TEST_F(Situations, APersonTurnsTheRobotAndLetsGo) {
  EXPECT_FALSE(has(until({"why"}, {"The robot stands", "no goal is underway"}), "drives it"));
  test::Process person =
      started({"write", "drive/teleop", R"({"rotation_velocity": 0.5})"}, "person");
  const std::string turns =
      until({"why"}, {"turn on the spot", "degrees/s to the left", "(teleop)"});
  EXPECT_FALSE(has(turns, "0.00 m/s")) << turns;
  until({"why", "not", "turn", "left"}, {"It does turn left"});
  person.signal(SIGINT);
  EXPECT_EQ(person.wait(), 0) << person.output();
  const std::string waits = until({"why"}, {"The robot stands", "saphira drive hand-back"});
  EXPECT_FALSE(has(waits.substr(0, waits.find('\n')), "saphira write")) << waits;
  EXPECT_TRUE(has(said({"drive", "hand-back"}), "handed back"));
  EXPECT_FALSE(has(until({"why"}, {"no goal is underway"}), "saphira write"));
}

TEST_F(Situations, AServiceHangsWhileAGoalIsUnderway) {
  until({"why"}, {"no goal is underway"});
  test::Process goal = started({"goal", "go", "9", "0"}, "goal");
  until({"why"}, {"drive ahead", "go_to"});
  const pid_t intentions = pid_of("intentions");
  ASSERT_GT(intentions, 0);
  kill(intentions, SIGSTOP);
  const std::string hangs = until({"why"}, {"The robot stands", "intentions"});
  EXPECT_FALSE(has(hangs, "nobody has asked")) << hangs;
  EXPECT_FALSE(has(hangs, "no goal")) << hangs;
  until({"status"}, {"trouble: intentions"});
  kill(intentions, SIGCONT);
  // A service that hangs for long is restarted by the supervisor.
  goal.signal(SIGINT);
  goal.wait();
  until({"why"}, {"The robot stands", "canceled"});
  // The answer about a past cycle describes that cycle, not the present.
  const std::string past = said({"why", "--cycle", "-20"});
  EXPECT_FALSE(has(past, "nobody has asked")) << past;
}

}  // namespace
}  // namespace saphira
