// The cases of connection.txt, and a line that echoes or loses packets.
#include "saphira/reflector/connection.hpp"

#include <gtest/gtest.h>

#include "lines.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/random.hpp"
#include "saphira/base/text.hpp"

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

/// One case, at 1 s of its clock.
class Session : public saphira::test::LinePlayer {
 public:
  Session() {
    events_ = {ON("at", now_ = read<double>(in)),
               ON("begin", sent_ = c_.begin(now_, rest(in) == "in a session")),
               ON("tick", sent_ = c_.tick(now_)),
               ON("due", sent_ = c_.tick(now_ = c_.due())),
               {"packet",
                [this](auto& in) {
                  Bytes bytes;
                  for (int byte = 0; in >> byte;)
                    bytes.push_back(static_cast<std::uint8_t>(byte));
                  sent_ = c_.packet(bytes, now_);
                }},
               {"name", [this](auto& in) {
                  const auto name = read<std::string>(in);
                  const auto kind = read<std::string>(in);
                  sent_ = c_.packet(identity(name, kind, rest(in)), now_);
                }}};
    facts_ = {IS("sent", joined(numbers(sent_), " ", [](int n) { return std::to_string(n); })),
              IS("open", yes(c_.open())),
              IS("hopeless", yes(c_.is_hopeless(now_))),
              IS("kind", c_.identity().robot_class),
              IS("subclass", c_.identity().subclass),
              IS("waits for", c_.waiting_for()),
              IS("round trip", decimal(c_.round_trip(), 6))};
  }

 private:
  Connection c_;
  Packets sent_;
  double now_ = 1.0;
};

TEST(Connection, OpensAsWritten) {
  EXPECT_EQ(saphira::test::play<Session>("bridge/reflector/test/connection.txt"), 7);
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
  EXPECT_NE(c.waiting_for().find("the line echoes every byte"), std::string::npos);
  // A robot is connected to the line.
  c.begin(now);
  c.packet(Bytes{0}, now);
  c.packet(Bytes{1}, now);
  c.packet(identity("Robot", "Pioneer", "PION1M"), now);
  EXPECT_TRUE(c.open());
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
