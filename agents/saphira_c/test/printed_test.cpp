#include "printed.hpp"

#include <regex>

#include "programs.hpp"

namespace saphira {
namespace {

using test::kBrace;
using test::kMain;
using test::kSmallBrace;
using test::kStartup;
using test::printed;
using test::Process;

class Printed : public test::Programs {
 protected:
  void SetUp() override {
    if (test::manual().empty())
      GTEST_SKIP() << "the manual is not there (SAPHIRA_MANUAL, ../shared/seeds)";
  }

  std::string built(const std::string& code) {
    const std::string path = dir_.path("printed.c");
    std::ofstream(path) << code;
    return build(path);
  }
};

TEST_F(Printed, Direct) {
  simulate();
  Process program = start(built(
      printed("4.3.1. The Direct", "4.3.2.",
              {kMain,
               kBrace,
               kSmallBrace,
               {"/* start up the Saphira window */", "/* start up the Saphira window */ }"}})));
  EXPECT_TRUE(test::wait_until([this] { return farthest() > 1.85; }, std::chrono::seconds(60)))
      << program.output();
}

// It pauses by its own clock for two minutes, while examples/async.c does for seconds: that one
// runs.
TEST_F(Printed, Async) {
  built(printed("4.3.2. The Async", "4.3.3.",
                {kMain, kStartup, kBrace, {"char **argv)\n", "char **argv)\n{"}, {"</pre>", ""}}));
}

// Its behaviors and its intention wait until they are switched on from outside.
TEST_F(Printed, Saphira) {
  simulate();
  Process program = start(built(test::printed_saphira()));
  EXPECT_TRUE(test::wait_until([this] { return truth().size() > 30; }, std::chrono::seconds(60)))
      << program.output();
  EXPECT_FALSE(program.wait(std::chrono::milliseconds(0)).has_value()) << program.output();
  EXPECT_LT(farthest(), 0.01);
  EXPECT_EQ(program.output().find("saphira:"), std::string::npos) << program.output();
}

TEST_F(Printed, Nowin) {
  simulate();
  Process program = start(
      built(printed("4.3.3. The Nowin", "4.3.4.",
                    {kMain,
                     kStartup,
                     kBrace,
                     kSmallBrace,
                     {"</pre>", ""},
                     {"[ omitted callback definitions ]",
                      "void myConnectFn(void) { sfInitBasicProcs(); }\nvoid myStartupFn(void) {}"},
                     {"char **argv)\n", "char **argv)\n{"},
                     {" else\n", " } else\n"},
                     {"printf(\"Can't connect!!\\n\");", "printf(\"Can't connect!!\\n\"); }"}})));
  ASSERT_EQ(program.wait(std::chrono::minutes(2)), std::optional<int>(0)) << program.output();
  const std::string said = program.output();
  int positions = 0;
  for (std::size_t at = said.find("X: "); at != std::string::npos; at = said.find("X: ", at + 1))
    ++positions;
  EXPECT_EQ(positions, 10) << said;
  EXPECT_GT(farthest(), 1.0) << said;
}

TEST_F(Printed, Packet) {
  simulate("19000 19000 0", "simple", "", "4", "--pty");
  Process program = start(built(printed(
      "4.3.5. The Packet", "5. Saphira Servers",
      {kMain, kSmallBrace, {"sfDisconnectFromRobot();", "sfDisconnectFromRobot(); return 0; }"}})));
  ASSERT_EQ(program.wait(), std::optional<int>(0)) << program.output();
  EXPECT_NE(program.output().find("100 packets received"), std::string::npos) << program.output();
  EXPECT_NEAR(farthest(), 3.0, 0.5);
}

// 6.6.2 prints calls within its text; sfOccBox has one argument more there than in its signature.
TEST_F(Printed, OccupancyCallsOfTheText) {
  const std::string text = test::manual();
  const std::size_t begin = text.rfind("\n6.6.2. Occupancy");
  const std::string section = text.substr(begin, text.find("\n6.6.3. Artifacts", begin) - begin);
  const std::regex call(R"(sfOcc\w+\((sf[A-Z]+,[^()]*)\))");
  std::string code = "#include \"saphira.h\"\nint main(void) {\n";
  int calls = 0;
  for (auto it = std::sregex_iterator(section.begin(), section.end(), call);
       it != std::sregex_iterator(); ++it, ++calls)
    code += "  printf(\"%d\\n\", " + it->str() + ");\n";
  EXPECT_EQ(calls, 3) << section;
  Process program = start(built(code + "  return 0;\n}\n"));
  EXPECT_EQ(program.wait(), std::optional<int>(0)) << program.output();
  EXPECT_EQ(program.output(), "5000\n5000\n5000\n") << "no robot, no reading";
}

}  // namespace
}  // namespace saphira
