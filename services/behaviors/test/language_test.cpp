#include "saphira/behaviors/language.hpp"

#include <gtest/gtest.h>

#include "../src/language/program.hpp"
#include "lines.hpp"
#include "process.hpp"
#include "saphira/behaviors/executive.hpp"

namespace saphira::behaviors {
namespace {

std::string all(const std::vector<FileError>& messages) {
  std::string out;
  for (const FileError& message : messages)
    out += std::string(message.what()) + "\n";
  return out;
}

/// A behavior around an update.
std::string with_update(const std::string& update, const std::string& rules = "If x Then Speed v",
                        const std::string& init = "") {
  return "BeginBehavior Test\nParams\n  sfFLOAT p = 3\n  sfPTR a optional\n"
         "  sfTEXT side = \"auto\" | \"left\"\nRules\n  " +
         rules + "\n" + (init.empty() ? "" : "Init\n" + init + "\n") + "Update\n" + update +
         "\nActivity\n  Speed x\nEndBehavior\n";
}

/// Runs one behavior over consecutive cycles.
class Runner {
 public:
  explicit Runner(const std::string& text, std::vector<Argument> arguments = {}) {
    Compiled compiled = compile(text, "test.beh");
    EXPECT_EQ(all(compiled.errors), "");
    if (compiled.schemas.empty())
      return;
    schema_ = compiled.schemas.front();
    std::string trouble;
    const auto checked =
        Parameters::check(schema_.parameters, arguments, robot_.pose_in_odom, trouble);
    EXPECT_EQ(trouble, "");
    if (!checked)
      return;
    parameters_ = *checked;
    behavior_ = schema_.make();
  }

  Evaluation update() {
    ++cycle_;
    shared_ = {};
    const Context context{model_, robot_, lps_, cycle_, shared_};
    if (behavior_ == nullptr)
      return {};
    if (cycle_ == 1)
      behavior_->init(parameters_, context);
    return behavior_->update(parameters_, context);
  }

  void touch(const Vec2& at_in_robot) { lps_.touch(at_in_robot); }

  RobotNow robot_;
  Schema schema_;
  Shared shared_;

 private:
  RobotModel model_;
  lps::LocalPerceptualSpace lps_;
  Parameters parameters_;
  std::unique_ptr<Behavior> behavior_;
  std::uint64_t cycle_ = 0;
};

/// The value of an expression, by way of a rule's speed [mm/s].
double value_of(const std::string& expression, const std::string& before = "") {
  Runner runner(with_update(before + "x = 1; float v = " + expression + ";"));
  const Evaluation evaluation = runner.update();
  EXPECT_EQ(evaluation.trouble, "");
  return evaluation.rules.empty() ? -1e9 : evaluation.rules[0].value * 1000.0;
}

TEST(Language, ComputesAsCDoes) {
  EXPECT_DOUBLE_EQ(value_of("1 + 2 * 3"), 7);
  EXPECT_DOUBLE_EQ(value_of("(1 + 2) * 3 - -4"), 13);
  EXPECT_DOUBLE_EQ(value_of("10 - 4 - 3"), 3);
  EXPECT_DOUBLE_EQ(value_of("7 / 2"), 3);
  EXPECT_DOUBLE_EQ(value_of("7.0 / 2"), 3.5);
  EXPECT_DOUBLE_EQ(value_of("7 % 4"), 3);
  EXPECT_DOUBLE_EQ(value_of("(int) 2.7 + (float) 7 / 2"), 5.5);
  EXPECT_DOUBLE_EQ(value_of("1 < 2 && 2 <= 2 && !(3 > 4)"), 1);
  EXPECT_DOUBLE_EQ(value_of("0 || 2 == 2"), 1);
  EXPECT_DOUBLE_EQ(value_of("p > 2 ? p * 10 : 1"), 30);
  EXPECT_DOUBLE_EQ(value_of("i", "int i = 3.9;"), 3);
  EXPECT_DOUBLE_EQ(value_of("i", "int i = 3; i += 2; i *= i;"), 25);
  EXPECT_DOUBLE_EQ(value_of("1e2 + .5f"), 100.5);
  EXPECT_DOUBLE_EQ(
      value_of("y", "float y; if (p < 1) y = 1; else if (p < 4) { y = 2; } else y = 3;"), 2);
  EXPECT_DOUBLE_EQ(value_of("sfNorm2Angle(3 * PI) / PI"), 1);
  EXPECT_DOUBLE_EQ(value_of("side == \"auto\""), 1);
  EXPECT_DOUBLE_EQ(value_of("side != \"left\" ? 5 : 6"), 5);
  EXPECT_DOUBLE_EQ(
      value_of("b.x + b.y + sfPointDist(b)", "point b = sfPointMove(sfPoint(3, 0, PI / 2), 4, 0);"),
      12);
  EXPECT_DOUBLE_EQ(value_of("sfGiven(a)"), 0);
}

TEST(Language, DoesNotLookAtWhatIsDecided) {
  EXPECT_DOUBLE_EQ(value_of("sfGiven(a) && sfPointDist(a) > 1"), 0);
  EXPECT_DOUBLE_EQ(value_of("sfGiven(a) ? sfPointDist(a) : 7"), 7);
}

TEST(Language, FuzzyFunctionsAreThoseOfTheLibrary) {
  for (const double x : {-1.0, 0.1, 0.35, 0.5, 2.0}) {
    const std::string t = std::to_string(x);
    EXPECT_DOUBLE_EQ(value_of("straight_up(" + t + ", 0.1, 0.6)"), straight_up(x, 0.1, 0.6));
    EXPECT_DOUBLE_EQ(value_of("up_straight(" + t + ", 0.1, 0.6)"), straight_up(x, 0.1, 0.6));
    EXPECT_DOUBLE_EQ(value_of("down_straight(" + t + ", 0.1, 0.6)"), down_straight(x, 0.1, 0.6));
    EXPECT_DOUBLE_EQ(value_of("straight_down(" + t + ", 0.1, 0.6)"), down_straight(x, 0.1, 0.6));
    EXPECT_DOUBLE_EQ(value_of("f_greater(" + t + ", 0.3, 0.4)"), f_greater(x, 0.3, 0.4));
    EXPECT_NEAR(value_of("f_smaller(" + t + ", 0.3, 0.4)"), f_smaller(x, 0.3, 0.4), 1e-12);
    EXPECT_DOUBLE_EQ(value_of("f_eq(" + t + ", 0.3, 0.4)"), f_eq(x, 0.3, 0.4));
  }
  EXPECT_DOUBLE_EQ(value_of("f_and(f_not(0.3), f_or(0.2, 0.6))"), 0.6);
}

// Manual 7.6.3: Init sets the behavior's memory.
TEST(Language, VariablesOfInitPersistAndThoseOfUpdateDoNot) {
  Runner runner(
      with_update("n += 1; k = k + 10; if (n == 1) { once = 5; float inside = 7; } x = 1;"
                  "float v = 100 * n + k + once;",
                  "If x Then Speed v", "int n = 0; k = 3;"));
  EXPECT_NEAR(runner.update().rules[0].value, 0.118, 1e-12);
  EXPECT_NEAR(runner.update().rules[0].value, 0.223, 1e-12);
  EXPECT_NEAR(runner.update().rules[0].value, 0.333, 1e-12);
}

TEST(Language, WhereSomethingWasFoundIsShown) {
  Runner runner(with_update(
      "float left = sfFreePathLeft(200, 1000); float right = sfFreePathRight(200, 1000);"
      "x = 1; float v = left;"));
  EXPECT_TRUE(runner.update().areas.empty());
  runner.touch({0.6, 0.1});
  const Evaluation found = runner.update();
  ASSERT_EQ(found.areas.size(), 1u);
  EXPECT_DOUBLE_EQ(found.areas[0].x_to, 1.2);
  EXPECT_DOUBLE_EQ(found.areas[0].y_from, 0.0);
  EXPECT_DOUBLE_EQ(found.areas[0].y_to, 0.2);
}

TEST(Language, RulesHaveNamesModifiersAndBothActions) {
  Runner runner(with_update("x = 0.5; w = -0.3; float v = 250;",
                            "If x Then Turn Left\n"
                            "hard If x And Not 0.8 Then Turn Right Very Sharply\n"
                            "If x Or 0.7 Then Turn w Slowly\n"
                            "\"both of them\" If x Then Turn Left v2 Speed 100\n"
                            "If x Then Accel 50 quick If x Then Decel v",
                            "float v2 = 0.2;"));
  const Evaluation evaluation = runner.update();
  ASSERT_EQ(evaluation.rules.size(), 7U);
  const std::vector<Rule>& r = evaluation.rules;
  EXPECT_EQ(r[0].name, "rule_1");
  EXPECT_EQ(r[0].action, Action::turn_left);
  EXPECT_DOUBLE_EQ(r[0].value, radians(10));
  EXPECT_EQ(r[1].name, "hard");
  EXPECT_EQ(r[1].action, Action::turn_right);
  EXPECT_DOUBLE_EQ(r[1].value, radians(40));
  EXPECT_NEAR(r[1].strength, 0.2, 1e-12);
  EXPECT_EQ(r[2].action, Action::turn_right);
  EXPECT_DOUBLE_EQ(r[2].value, radians(5));
  EXPECT_DOUBLE_EQ(r[2].strength, 0.7);
  EXPECT_EQ(r[3].name, "both of them");
  EXPECT_DOUBLE_EQ(r[3].value, 0.2);
  EXPECT_EQ(r[4].action, Action::speed);
  EXPECT_DOUBLE_EQ(r[4].value, 0.1);
  EXPECT_EQ(r[5].action, Action::accelerate);
  EXPECT_DOUBLE_EQ(r[5].value, 0.05);
  EXPECT_EQ(r[6].action, Action::decelerate);
  ASSERT_EQ(evaluation.variables.size(), 1U);
  EXPECT_EQ(evaluation.variables[0], (std::pair<std::string, double>{"x", 0.5}));
  ASSERT_EQ(runner.schema_.rules.size(), 7U);
  EXPECT_EQ(runner.schema_.rules[1].antecedent, "x And Not 0.8");
  EXPECT_EQ(runner.schema_.rules[1].action, "Turn Right Very Sharply");
}

TEST(Language, ParametersHaveUnitsLimitsAndDefaults) {
  const Compiled compiled = compile(
      "BeginBehavior P \"says it\"\nParams\n sfFLOAT speed = 300 from 0 to 2000 mm/s \"how fast\"\n"
      " sfFLOAT raw\n sfINT n = 2\n sfPTR goal \"where to\"\n sfPTR lane optional\n"
      " sfTEXT side = \"in\" | \"out\"\n sfFLOAT cone = 90 from 0 to 180 deg\n"
      "Rules\n If n Then Speed speed\nUpdate\nActivity\nEndBehavior\n",
      "p.beh");
  ASSERT_EQ(all(compiled.errors), "");
  const Schema& schema = compiled.schemas.front();
  EXPECT_EQ(schema.name, "P");
  EXPECT_EQ(schema.summary, "says it");
  EXPECT_EQ(schema.source, "p.beh");
  ASSERT_EQ(schema.parameters.size(), 7U);
  EXPECT_DOUBLE_EQ(schema.parameters[0].usual, 0.3);
  EXPECT_DOUBLE_EQ(schema.parameters[0].high, 2.0);
  EXPECT_EQ(schema.parameters[0].meaning, "m/s, how fast");
  EXPECT_TRUE(schema.parameters[1].required);
  EXPECT_FALSE(schema.parameters[2].required);
  EXPECT_TRUE(schema.parameters[3].required);
  EXPECT_FALSE(schema.parameters[4].required);
  EXPECT_EQ(schema.parameters[5].choices, (std::vector<std::string>{"in", "out"}));
  EXPECT_DOUBLE_EQ(schema.parameters[6].usual, kPi / 2);
}

TEST(Language, TheManualsExampleRunsAsItIsPrinted) {
  const std::string text = read_file(test::source("config/behaviors/manual-example.beh"));
  const Compiled compiled = compile(text, "manual-example.beh");
  ASSERT_EQ(all(compiled.errors), "");
  // Three underscores lost in print.
  EXPECT_EQ(compiled.warnings.size(), 3U) << all(compiled.warnings);
  ASSERT_EQ(compiled.schemas.size(), 1U);
  EXPECT_EQ(compiled.schemas[0].name, "myGoto");
  EXPECT_EQ(compiled.schemas[0].parameters[0].name, "goal_pt");
  EXPECT_EQ(compiled.schemas[0].rules[2].antecedent, "Not (near_goal Or too_left Or too_right)");

  Runner runner(text, {{"goal_pt", PlacedPoint{{3.0, 0.0, 0.0}, Frame::odom}}, {"radius", 300.0}});
  Evaluation ahead = runner.update();
  ASSERT_EQ(ahead.rules.size(), 4U);
  EXPECT_EQ(ahead.rules[2].strength, 1.0);
  EXPECT_DOUBLE_EQ(ahead.rules[2].value, 0.2);
  EXPECT_EQ(ahead.activity.turn, 1.0);
  EXPECT_EQ(ahead.activity.goal, 0.0);
  runner.robot_.pose_in_odom = {2.55, 0.0, 0.0};  // half way between radius and twice of it
  EXPECT_NEAR(runner.update().activity.goal, 0.5, 1e-9);
  runner.robot_.pose_in_odom = {0.0, 0.0, -0.35};
  Evaluation beside = runner.update();
  EXPECT_NEAR(beside.rules[0].strength, 0.5, 1e-9);
  EXPECT_EQ(beside.rules[0].action, Action::turn_right);
}

TEST(Language, TellsWhatIsNotANumberAndDoesNotDriveByIt) {
  Runner runner(with_update("x = 1; float zero = 0; float v = 100 / zero;"));
  const Evaluation evaluation = runner.update();
  EXPECT_EQ(evaluation.trouble, "rule \"rule_1\" is not a number");
  EXPECT_EQ(evaluation.rules[0].strength, 0.0);
  EXPECT_EQ(evaluation.rules[0].value, 0.0);
}

TEST(Language, MistakesAreShownWhereTheyAre) {
  const auto parse = [](const std::string& text) {
    const std::string good = with_update("x = 1; v = 1;");
    const Compiled compiled =
        compile(text.starts_with("rule ")     ? with_update("x = 1; v = 1;", text.substr(5))
                : text.starts_with("update ") ? with_update("x = 1; v = 1;\n" + text.substr(7))
                : text == "twice"             ? good + "BeginBehavior Test"
                                              : text,
                "m.beh");
    EXPECT_TRUE(compiled.schemas.empty());
    if (!compiled.errors.empty())
      throw compiled.errors.front();
  };
  EXPECT_EQ(test::each_mistake("services/behaviors/test/mistakes.txt", parse), 38);
}

TEST(Language, AFileOfAnotherKindGivesOneMessage) {
  const Compiled compiled = compile(std::string("\xff\xfe"
                                                "B\0e\0g\0i\0n\0\n\0",
                                                14),
                                    "m.beh");
  ASSERT_EQ(compiled.errors.size(), 1u) << all(compiled.errors);
  EXPECT_EQ(compile("# a comment\nBeginBehavior Own\n", "m.beh").errors.size(), 1u);
}

TEST(Language, SeveralMistakesAreToldAtOnceWithTheLineAndACaret) {
  const Compiled compiled = compile(with_update("x = foo;\nv = bar(1);\nfloat y = ;\nfloat z = 1;",
                                                "If x Then Fly\nIf x Then Speed v"),
                                    "many.beh");
  ASSERT_EQ(compiled.errors.size(), 4U) << all(compiled.errors);
  EXPECT_STREQ(
      compiled.errors[0].what(),
      "many.beh:7:13: expected \"Turn\", \"Speed\", \"Accel\" or \"Decel\", found \"Fly\"\n"
      "      If x Then Fly\n"
      "                ^");
  EXPECT_EQ(compiled.errors[3].line(), 12);
  ASSERT_EQ(compiled.warnings.size(), 1U) << all(compiled.warnings);
  EXPECT_NE(std::string(compiled.warnings[0].what()).find("\"z\" is set and never used"),
            std::string::npos);
}

TEST(Language, BottomlessTextsAreTold) {
  const std::string deep(5000, '(');
  const std::string minus(5000, '-');
  std::string sum = "1";
  std::string fuzzy = "x";
  for (int i = 0; i < 3000; ++i) {
    sum += "+1";
    fuzzy += " And x";
  }
  for (const std::string& text :
       {with_update("x = " + deep + ";"), with_update("x = " + minus + "1;"),
        with_update("x = " + sum + ";"),
        with_update("x = 1; v = 1;", "If " + deep + "x Then Speed v"),
        with_update("x = 1; v = 1;", "If " + fuzzy + " Then Speed v"),
        with_update(std::string(5000, '{')), std::string(100000, '$')})
    EXPECT_FALSE(compile(text, "deep.beh").errors.empty());
}

TEST(Language, EveryFunctionIsDescribed) {
  const std::string description = read_file(test::source("services/behaviors/LANGUAGE.md"));
  EXPECT_GT(language::functions().size(), 20U);
  for (const language::Function& function : language::functions()) {
    const std::string name = function.name;
    // The fields of sfRobot stand there as ".rv".
    const std::size_t point = name.find('.');
    EXPECT_NE(description.find(point == std::string::npos ? name : name.substr(point)),
              std::string::npos)
        << name;
  }
}

}  // namespace
}  // namespace saphira::behaviors
