#include "story/shell/story.hpp"

#include <gtest/gtest.h>

#include "node_options.hpp"

namespace saphira::story {
namespace {

/// A robot in the hall at cycle 50, and Alice, who says one sentence to it.
struct AStory : testing::Test {
  explicit AStory(const std::string& has = "")
      : cast("PERSON alice hall\n" + has + "SAYS alice Flakey, stop\n") {
    v1::MapArtifact hall{.id = 1, .type = v1::ARTIFACT_CORRIDOR};
    hall.name = "hall";
    hall.length = 10.0;
    hall.width = 2.0;
    maps.write({.artifacts = {hall}});
    robots.write({.stamp = {7, 50}});
    registrations.write(v1::Registration());
  }

  /// The robot's last answer to the newest sentence.
  void answers(const std::string& text) {
    for (const auto& sample : heard.take()) {
      answers_.write({.answers = sample.data.id, .text = text, .end = true});
    }
  }

  std::string cast;
  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node robot{test::memory_options("robot"), memory};
  bus::Writer<v1::FloorMap> maps = robot.writer(bus::topics::kMap);
  bus::Writer<v1::RobotState> robots = robot.writer(bus::topics::kRobotState);
  bus::Writer<v1::Registration> registrations = robot.writer(bus::topics::kRegistration);
  bus::Reader<v1::Utterance> heard = robot.reader(bus::topics::kHeard);
  bus::Node people{test::memory_options("people"), memory};
  bus::Writer<v1::Utterance> answers_ = robot.writer(bus::topics::kSaid);
  Story story{people, Cast(cast, "test.people"), {}};
};

struct WhoeverHasIt : AStory {
  WhoeverHasIt() : AStory("HAS report\nGETS report\n") {}
};
struct WhoeverHasItNot : AStory {
  WhoeverHasItNot() : AStory("GETS report\n") {}
};

TEST_F(AStory, InLockstepTheTimeOfAnUtteranceIsTheCycle) {
  story.step();
  const auto said = heard.take();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].data.text, "Flakey, stop");
  EXPECT_EQ(said[0].data.stamp.epoch, 7U);
  EXPECT_EQ(said[0].data.stamp.cycle, 50U);
  EXPECT_EQ(said[0].data.time, 0.0);
}

TEST_F(AStory, LiveItIsAlsoTheGivenTime) {
  story.step(1e9);
  const auto said = heard.take();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].data.stamp.cycle, 50U);
  EXPECT_EQ(said[0].data.time, 1e9);
}

TEST_F(WhoeverHasIt, EndsWell) {
  story.step();
  answers("done: the report was brought");
  story.step();
  EXPECT_TRUE(story.step());
  EXPECT_EQ(story.outcome(), "done: the report was brought");
  EXPECT_TRUE(story.well());
}

// The robot's own report does not count.
TEST_F(WhoeverHasItNot, DoesNotEndWell) {
  story.step();
  answers("done: the report was brought");
  story.step();
  EXPECT_TRUE(story.step());
  EXPECT_EQ(story.outcome(), "done: the report was brought");
  EXPECT_FALSE(story.well());
  EXPECT_EQ(story.handed_over(), "");
}

}  // namespace
}  // namespace saphira::story
