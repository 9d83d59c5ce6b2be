// Samples that are none of their topic's type, from a writer outside the library.
#include "harness.hpp"
#include "raw_writer.hpp"

namespace saphira::bus::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// The bytes of a MotorCommand with a boolean of 2.
Bytes boolean_of_two() {
  Bytes bytes = bytes_of_motor_command(0.5, true);
  const Bytes other = bytes_of_motor_command(0.5, false);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    if (bytes[i] != other[i])
      bytes[i] = 2;
  return bytes;
}

std::vector<Bytes> malformed() {
  Bytes bad_encapsulation = bytes_of_motor_command(0.5, true);
  bad_encapsulation[0] = 0xff;
  bad_encapsulation[1] = 0xff;
  Bytes truncated = bytes_of_motor_command(0.5, true);
  truncated.resize(truncated.size() / 2);
  Bytes endless(40, 0xff);  // strings and sequences of 4 GB
  endless[0] = endless[2] = endless[3] = 0;
  endless[1] = 1;
  return {boolean_of_two(), bad_encapsulation, truncated, endless, Bytes{0, 1, 0, 0}};
}

class MalformedSamples : public testing::Test {
 protected:
  std::uint64_t refused() {
    node_->health();
    return node_->status().refused_samples;
  }

  const std::string robot_ = robot("m");
  const std::unique_ptr<Node> node_ = std::make_unique<Node>(node_options("test", robot_));
};

TEST_F(MalformedSamples, AreCountedAndTheNextGoodOneIsRead) {
  auto reader = node_->reader(topics::kDriveTeleop);
  RawWriter writer(robot_, topics::kDriveTeleop.name, "saphira::v1::MotorCommand", false);
  ASSERT_TRUE(eventually(*node_, [&] { return writer.matched() && reader.matched() == 1; }));
  std::uint64_t count = 0;
  for (int round = 0; round < 10; ++round) {
    // One by one: the reader is best effort and keeps the last four.
    for (const Bytes& bytes : malformed()) {
      ++count;
      ASSERT_TRUE(writer.write(bytes));
      ASSERT_TRUE(eventually(*node_,
                             [&] {
                               EXPECT_TRUE(reader.take().empty());
                               return refused() == count;
                             }))
          << refused() << " of " << count;
    }
    ASSERT_TRUE(writer.write(malformed()[0]));
    ++count;
    ASSERT_TRUE(writer.write(bytes_of_motor_command(0.25, true)));
    const auto good = take_at_least(*node_, reader, 1);
    ASSERT_EQ(good.size(), 1U);
    EXPECT_EQ(good[0].data.velocity, 0.25);
    EXPECT_EQ(refused(), count);
  }
}

TEST_F(MalformedSamples, OfAKeyedTopicHurtNobody) {
  auto reader = node_->reader(topics::kGoals);
  {
    RawWriter writer(robot_, topics::kGoals.name, "saphira::v1::Goal", true);
    ASSERT_TRUE(eventually(*node_, [&] { return writer.matched() && reader.matched() == 1; }));
    for (const Bytes& bytes : malformed())
      ASSERT_TRUE(writer.write(bytes));
    ASSERT_TRUE(eventually(*node_, [&] {
      EXPECT_TRUE(reader.take().empty());
      return refused() > 0;
    }));
  }
  Node other(node_options("other", robot_));
  auto goals = other.writer(topics::kGoals);
  goals.write(goal(7));
  const auto good = take_at_least(*node_, reader, 1);
  ASSERT_EQ(good.size(), 1U);
  EXPECT_EQ(good[0].data.id.number, 7U);
}

}  // namespace
}  // namespace saphira::bus::test
