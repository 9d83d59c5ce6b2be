#include "saphira/requests/functor.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "saphira/requests/request.hpp"

namespace saphira {
namespace {

const Functor kMove{"move",
                    "moves the arm",
                    {number_parameter("height", "of the hand [m]", 0.0, 1.5),
                     optional(whole_parameter("times", "how often", 1.0, 9.0), 2.0),
                     optional(truth_parameter("slowly", "not to spill anything")),
                     optional(text_parameter("side", "of the robot", {"left", "right"})),
                     optional(point_parameter("to", "where to", Frame::map)),
                     list(whole_parameter("joint", "which are locked", 0.0, 5.0))}};

std::string wrong(Arguments arguments) {
  return complete(kMove, arguments);
}

TEST(Functors, FillInWhatIsUsual) {
  Arguments arguments{{"height", 1.0}};
  EXPECT_EQ(complete(kMove, arguments), "");
  EXPECT_EQ(number_of(arguments, "times"), 2.0);
  EXPECT_FALSE(truth_of(arguments, "slowly"));
  EXPECT_EQ(find(arguments, "side"), nullptr) << "a text has no usual value";
  EXPECT_EQ(find(arguments, "joint"), nullptr);
}

TEST(Functors, TakeWhatTheyDeclare) {
  EXPECT_EQ(wrong({{"height", 1.5},
                   {"times", 9.0},
                   {"slowly", true},
                   {"side", std::string("left")},
                   {"to", PlacedPoint{{1.0, 2.0, 0.0}, Frame::map}},
                   {"joint", 1.0},
                   {"joint", 3.0}}),
            "");
  EXPECT_EQ(numbers_of({{"joint", 1.0}, {"height", 1.0}, {"joint", 3.0}}, "joint"),
            (std::vector<double>{1.0, 3.0}));
}

TEST(Functors, SayWhichArgumentIsWrongAndWhatWasExpected) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(
      wrong({}),
      "move: argument \"height\" is missing: expected a number from 0 to 1.5 (of the hand [m])");
  EXPECT_EQ(
      wrong({{"height", 1.6}}),
      "move: argument \"height\": expected a number from 0 to 1.5 (of the hand [m]), found 1.6");
  EXPECT_EQ(
      wrong({{"height", nan}}),
      "move: argument \"height\": expected a number from 0 to 1.5 (of the hand [m]), found nan");
  EXPECT_EQ(
      wrong({{"height", true}}),
      "move: argument \"height\": expected a number from 0 to 1.5 (of the hand [m]), found yes");
  EXPECT_EQ(wrong({{"height", 1.0}, {"times", 1.5}}),
            "move: argument \"times\": expected a whole number from 1 to 9 (how often), found 1.5");
  EXPECT_EQ(wrong({{"height", 1.0}, {"side", std::string("front")}}),
            "move: argument \"side\": expected left or right (of the robot), found \"front\"");
  EXPECT_EQ(
      wrong({{"height", 1.0}, {"to", PlacedPoint{{1.0, 2.0, 0.0}, Frame::odom}}}),
      "move: argument \"to\": expected a point in the map (where to), found (1, 2, 0) in odom");
  EXPECT_EQ(wrong({{"height", 1.0}, {"to", PlacedPoint{{nan, 2.0, 0.0}, Frame::map}}}),
            "move: argument \"to\": expected a point in the map (where to), found (nan, 2, 0) in "
            "the map");
  EXPECT_EQ(wrong({{"height", 1.0}, {"height", 1.0}}), "move: argument \"height\" is given twice");
  EXPECT_EQ(
      wrong({{"height", 1.0}, {"width\n", 1.0}}),
      "move: argument \"width?\" is not known: expected height, times, slowly, side, to, joint");
  Arguments unbound{{"height", 1.0}};
  unbound[0].kind = ArgumentKind::unbound;
  EXPECT_NE(complete(kMove, unbound), "");
}

TEST(Functors, HaveAHelpText) {
  const std::string text = help({kMove});
  EXPECT_NE(text.find("move(height, [times], [slowly], [side], [to], [joint ...]): moves the arm\n"
                      "  height: a number from 0 to 1.5 (of the hand [m])\n"),
            std::string::npos)
      << text;
}

TEST(Requests, AreRefusedWithACode) {
  Request request{"dance"};
  EXPECT_EQ(refusal({kMove}, request), (Answer{AnswerCode::unknown_functor,
                                               "functor \"dance\" is not known here: expected move",
                                               {}}));
  request.functor = "move";
  EXPECT_EQ(refusal({kMove}, request)->code, AnswerCode::bad_argument);
  request.arguments = {{"height", 1.0}};
  EXPECT_FALSE(refusal({kMove}, request));
  EXPECT_EQ(describe(request), "move height=1 times=2 slowly=no");
}

TEST(Requests, OfAServiceAreDueTwoCyclesLater) {
  Request request{"move"};
  EXPECT_TRUE(is_due(request, {5, 1})) << "somebody without cycles";
  request.stamp = {5, 10};
  EXPECT_FALSE(is_due(request, {5, 10}));
  EXPECT_FALSE(is_due(request, {5, 11}));
  EXPECT_TRUE(is_due(request, {5, 12}));
  EXPECT_TRUE(is_due(request, {6, 1})) << "its epoch is over";
  EXPECT_FALSE(is_due(request, {0, 0})) << "its epoch has not begun here";
  EXPECT_FALSE(is_due(request, {4, 100}));
}

}  // namespace
}  // namespace saphira
