#include "saphira/reflector/connection.hpp"

#include <gtest/gtest.h>

#include "saphira/base/random.hpp"

namespace saphira::reflector {
namespace {

using protocol::Bytes;

/// The numbers of the packets: the fourth byte.
std::vector<int> numbers(const Packets& packets) {
  std::vector<int> out;
  for (const Bytes& packet : packets)
    out.push_back(packet.at(3));
  return out;
}

/// The body of a packet that is made as a whole.
Bytes body(const Bytes& packet) {
  return {packet.begin() + 3, packet.end() - 2};
}

Bytes identity(const std::string& name, const std::string& kind, const std::string& sub) {
  return body(protocol::encode_sync2_reply({name, kind, sub}));
}

TEST(Connection, SynchronizesAndOpens) {
  Connection c;
  EXPECT_EQ(numbers(c.begin(1.0)), std::vector<int>{0});
  EXPECT_EQ(numbers(c.packet(Bytes{0}, 1.0)), std::vector<int>{1});
  EXPECT_EQ(numbers(c.packet(Bytes{0}, 1.0)), std::vector<int>{}) << "a late echo";
  EXPECT_EQ(numbers(c.packet(Bytes{1}, 1.0)), std::vector<int>{2});
  EXPECT_FALSE(c.open());
  EXPECT_EQ(numbers(c.packet(identity("Robot", "Pioneer", "PION1M"), 1.0)), std::vector<int>{1});
  EXPECT_TRUE(c.open());
  EXPECT_EQ(c.identity().subclass, "PION1M");
}

TEST(Connection, DoesNotReviveARobotBehindALine) {
  Connection c;
  EXPECT_EQ(numbers(c.begin(1.0, true)), (std::vector<int>{11, 21, 0}));
  EXPECT_EQ(numbers(c.tick(c.due())), (std::vector<int>{11, 21, 0}));
  EXPECT_EQ(numbers(c.packet(Bytes{0}, 2.0)), std::vector<int>{1});
}

TEST(Connection, RepeatsWhatIsNotAnswered) {
  Connection c;
  c.begin(1.0);
  EXPECT_TRUE(c.tick(1.1).empty());
  EXPECT_EQ(numbers(c.tick(c.due())), std::vector<int>{0});
  c.packet(Bytes{0}, 2.0);
  for (int i = 0; i < 19; ++i)
    EXPECT_EQ(numbers(c.tick(c.due())), std::vector<int>{1});
  EXPECT_EQ(numbers(c.tick(c.due())), std::vector<int>{0}) << "from the beginning";
  EXPECT_NE(c.waiting_for().find("SYNC0"), std::string::npos);
}

TEST(Connection, ALineThatEchoesIsNoRobot) {
  Connection c;
  double now = 1.0;
  Packets out = c.begin(now);
  // Everything that is sent is echoed at once.
  for (int i = 0; i < 40; ++i) {
    const Packets sent = std::exchange(out, {});
    for (const Bytes& packet : sent)
      for (Bytes& more : c.packet(body(packet), now))
        out.push_back(std::move(more));
    ASSERT_FALSE(c.open());
    if (out.empty())
      out = c.tick(now = c.due());
  }
  EXPECT_NE(c.waiting_for().find("sends back what it is sent"), std::string::npos);
  // A robot is connected to the line.
  c.begin(now);
  c.packet(Bytes{0}, now);
  c.packet(Bytes{1}, now);
  c.packet(identity("Robot", "Pioneer", "PION1M"), now);
  EXPECT_TRUE(c.open());
}

TEST(Connection, AnOldServerSaysNoName) {
  Connection c;
  c.begin(1.0);
  c.packet(Bytes{0}, 1.0);
  c.packet(Bytes{1}, 1.0);
  EXPECT_EQ(numbers(c.packet(Bytes{2}, 1.0)), (std::vector<int>{11, 21})) << "is it an echo?";
  EXPECT_FALSE(c.open());
  EXPECT_EQ(numbers(c.tick(c.due())), std::vector<int>{2});
  c.packet(Bytes{2}, 1.3);
  EXPECT_TRUE(c.open());
  EXPECT_EQ(c.identity().robot_class, "");
}

TEST(Connection, MeasuresHowSlowTheLineIs) {
  Connection c;
  c.begin(1.0);
  for (double now = 1.2; now < 1.75; now += 0.2)
    c.tick(now);
  c.packet(Bytes{0}, 1.8);
  c.tick(2.0);
  c.packet(Bytes{0}, 2.0);  // answers to the repeated packet
  c.packet(Bytes{1}, 2.6);
  EXPECT_NEAR(c.round_trip(), 0.8, 1e-9);
  c.packet(identity("Robot", "Pioneer", "PION1M"), 3.3);
  EXPECT_NEAR(c.round_trip(), 0.7, 1e-9);
}

TEST(Connection, LosesHopeWhenNothingLeadsOn) {
  Connection c;
  EXPECT_FALSE(c.is_hopeless(100.0)) << "nothing was begun";
  c.begin(1.0);
  EXPECT_FALSE(c.is_hopeless(1.0 + Connection::kPatience));
  EXPECT_TRUE(c.is_hopeless(1.1 + Connection::kPatience));
  c.packet(Bytes{0}, 5.0);
  EXPECT_FALSE(c.is_hopeless(9.0)) << "an answer came";
  c.packet(Bytes{0}, 9.5);
  EXPECT_TRUE(c.is_hopeless(10.1)) << "an echo twice leads nowhere";
  c.packet(Bytes{1}, 10.2);
  c.packet(identity("R", "Pioneer", "p3dx"), 10.3);
  EXPECT_TRUE(c.open());
  EXPECT_FALSE(c.is_hopeless(100.0));
}

TEST(Connection, ClosesAServerThatIsStillOpen) {
  Connection c;
  c.begin(1.0);
  EXPECT_EQ(numbers(c.packet(Bytes{0x32, 0, 0}, 1.05)), (std::vector<int>{11, 21, 2, 0}));
  EXPECT_TRUE(c.packet(Bytes{0x32, 0, 0}, 1.06).empty()) << "was on its way";
  EXPECT_EQ(numbers(c.packet(Bytes{0x33, 0, 0}, 1.3)), (std::vector<int>{11, 21, 2, 0}))
      << "did not hear it";
  EXPECT_EQ(numbers(c.packet(Bytes{0}, 1.4)), std::vector<int>{1});
}

// A server that follows the manual, over a line that loses a third of the packets each way.
TEST(Connection, ComesAboutOverALossyLine) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    Connection c;
    double now = 1.0;
    int expects = 0;
    bool open = false;
    std::vector<int> out = numbers(c.begin(now));
    for (int step = 0; step < 400 && !(c.open() && open); ++step) {
      std::vector<int> next;
      for (const int command : out) {
        if (random.chance(0.33))
          continue;
        if (expects == 3 && command == 1) {
          open = true;
          continue;
        }
        if (command > expects || command > 2)
          continue;
        expects = command + 1;
        const Bytes answer =
            command == 2 ? identity("R", "Pioneer", "") : Bytes{static_cast<std::uint8_t>(command)};
        if (!random.chance(0.33)) {
          const auto more = numbers(c.packet(answer, now));
          next.insert(next.end(), more.begin(), more.end());
        }
      }
      now += 0.05;
      const auto more = numbers(c.tick(now));
      next.insert(next.end(), more.begin(), more.end());
      out = next;
      if (c.open() && !open && out.empty())
        break;  // OPEN itself was lost: the listener for information packets begins anew
    }
    ASSERT_TRUE(c.open()) << seed;
  }
}

}  // namespace
}  // namespace saphira::reflector
