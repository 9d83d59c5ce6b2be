#include "saphira/sim/contacts.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

namespace saphira::sim {
namespace {

protocol::RobotParameters with_front_sonar(double th = 0.0) {
  protocol::RobotParameters parameters;
  parameters.sonars.push_back({0, {0.1, 0.0, radians(th)}});
  return parameters;
}

class Contacts : public ::testing::Test {
 protected:
  void make(const std::string& things, const protocol::RobotParameters& parameters,
            const Pose& start = {2.0, 5.0, 0.0}) {
    world_ = parse_world(
        "width 10000 height 10000 0 0 10000 0 10000 0 10000 10000 10000 10000 0 10000 0 10000 0 "
        "0 " +
            things,
        "room.wld");
    scene_ = std::make_unique<Scene>(world_);
    robot_ = &scene_->add_robot(parameters, start, 1);
    watch_ = std::make_unique<ContactWatch>(*scene_, robot_->number(), parameters);
    scene_->set_watch([this] { watch_->tick(); });
  }
  void run(double seconds) {
    for (double t = 0.0; t < seconds; t += kTick)
      scene_->tick();
  }
  void drive(double velocity, double seconds) {
    robot_->set_velocity(velocity);
    run(seconds);
  }

  World world_;
  std::unique_ptr<Scene> scene_;
  Robot* robot_ = nullptr;
  std::unique_ptr<ContactWatch> watch_;
};

TEST_F(Contacts, ARobotThatDrivesIntoWhatItCouldHearIsToBlame) {
  make("person ann 5000 5100", with_front_sonar());
  drive(0.3, 15.0);
  ASSERT_EQ(watch_->contacts().size(), 1U) << "pushing on is the same contact";
  const Contact& contact = watch_->contacts()[0];
  EXPECT_EQ(contact.blame, Blame::kCaused);
  EXPECT_EQ(contact.kind, ThingKind::kPerson);
  EXPECT_EQ(contact.name, "ann");
  EXPECT_NEAR(contact.towards, 0.3, 0.02);
  EXPECT_GT(contact.heard, 3.0);
  EXPECT_GT(contact.needed, 0.6);
  EXPECT_FALSE(contact.walks);
  EXPECT_LT(watch_->closest_person(), 0.002);
  drive(-0.3, 2.0);
  drive(0.3, 4.0);
  EXPECT_EQ(watch_->contacts().size(), 2U) << "once more";
}

TEST_F(Contacts, WhatNoSonarLooksAtIsUnseen) {
  make("post can 5000 5000 50", with_front_sonar(40.0));
  drive(0.3, 15.0);
  ASSERT_EQ(watch_->contacts().size(), 1U);
  EXPECT_EQ(watch_->contacts()[0].blame, Blame::kUnseen);
  EXPECT_EQ(watch_->contacts()[0].kind, ThingKind::kPost);
  EXPECT_EQ(watch_->contacts()[0].heard, 0.0);
}

TEST_F(Contacts, WhatIsBehindAWallIsNotHeard) {
  const auto blame = [&](const std::string& wall) {
    make("person ann 5000 4000 " + wall, with_front_sonar(), {5.0, 2.5, kPi / 2.0});
    run(3.0);
    EXPECT_TRUE(robot_->place({4.4, 4.0, 0.0}));
    drive(0.3, 2.0);
    return watch_->contacts().size() == 1 ? std::optional(watch_->contacts()[0].blame)
                                          : std::nullopt;
  };
  EXPECT_EQ(blame(""), Blame::kCaused);
  EXPECT_EQ(blame("4500 3300 5500 3300"), Blame::kUnseen);
}

TEST_F(Contacts, WhoStepsBeforeARobotIsHeardTooLate) {
  make("person ann 5000 7000  wait 7  walk 5000 5000 1600 stubborn", with_front_sonar());
  drive(0.3, 15.0);
  ASSERT_EQ(watch_->contacts().size(), 1U);
  EXPECT_EQ(watch_->contacts()[0].blame, Blame::kUnseen);
  EXPECT_GT(watch_->contacts()[0].heard, 0.0);
  EXPECT_TRUE(watch_->contacts()[0].walks);
}

TEST_F(Contacts, ARobotThatCreepsIntoSomebodyHasTouchedThem) {
  const auto blame_at = [&](double speed) {
    make("person ann 5000 5000", with_front_sonar(), {4.4, 5.0, 0.0});
    drive(speed, 60.0);
    return watch_->contacts().size() == 1 ? std::optional(watch_->contacts()[0].blame)
                                          : std::nullopt;
  };
  EXPECT_EQ(blame_at(0.02), Blame::kUnseen) << "between the lobes, so near";
  EXPECT_EQ(blame_at(0.009), Blame::kWalkedInto);
}

TEST_F(Contacts, WhoRunsIntoARobotThatStandsIsToBlame) {
  make("", with_front_sonar());
  Robot& other = scene_->add_robot(with_front_sonar(), {4.0, 5.0, kPi}, 2);
  ContactWatch of_other(*scene_, other.number(), with_front_sonar());
  scene_->set_watch([&] {
    watch_->tick();
    of_other.tick();
  });
  other.set_velocity(0.3);
  run(10.0);
  ASSERT_EQ(watch_->contacts().size(), 1U);
  EXPECT_EQ(watch_->contacts()[0].blame, Blame::kWalkedInto);
  EXPECT_EQ(watch_->contacts()[0].kind, ThingKind::kRobot);
  EXPECT_EQ(watch_->contacts()[0].name, "2");
  ASSERT_EQ(of_other.contacts().size(), 1U);
  EXPECT_EQ(of_other.contacts()[0].blame, Blame::kCaused);
}

TEST_F(Contacts, WallsAreThings) {
  make("", with_front_sonar());
  robot_->set_heading(kPi);
  run(5.0);
  drive(0.3, 15.0);
  ASSERT_EQ(watch_->contacts().size(), 1U);
  EXPECT_EQ(watch_->contacts()[0].kind, ThingKind::kWall);
  EXPECT_EQ(watch_->contacts()[0].blame, Blame::kCaused);
}

TEST_F(Contacts, PassingAPersonIsNoContact) {
  // 0.05 m between the hulls.
  make("person ann 5000 5520", with_front_sonar());
  drive(0.15, 28.0);
  EXPECT_NEAR(watch_->closest_person(), 0.05, 0.02);
  EXPECT_TRUE(watch_->contacts().empty());
}

}  // namespace
}  // namespace saphira::sim
