// The conversations of check.txt.
#include "saphira/protocol/check.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "lines.hpp"

namespace saphira::protocol {
namespace {

RobotParameters robot(Protocol protocol) {
  RobotParameters p{.protocol = protocol};
  p.sonars.resize(7);
  p.encoder_unit = 1e-5;
  return p;
}

/// One case.
class Conversation : public test::LinePlayer {
 public:
  Conversation() {
    events_ = {
      ON("psos", begin(Protocol::kPsos)),
      ON("anew", begin(Protocol::kArcos)),
      ON("time", time_ = read<double>(in)),
      ON("synchronize", synchronize()),
      ON("open", synchronize(); say(Side::kClient, encode(Open{}))),
      ON("client", say(Side::kClient, frame(bytes(in)))),
      ON("server", say(Side::kServer, frame(bytes(in)))),
      ON("client-bytes", say(Side::kClient, bytes(in))),
      ON("server-bytes", say(Side::kServer, bytes(in))),
      ON("information", information(in)),
      ON("config", say(Side::kServer, encode(config_of(robot(Protocol::kArcos), "a", "b")))),
      ON("encoder", say(Side::kServer, encode(EncoderPacket{}))),
      ON("battery", say(Side::kServer, encode(BatteryPacket{}))),
      ON("io", say(Side::kServer, encode(IoPacket{{1}, {1}, {}}))),
      ON("disconnect", checker_.disconnect()),
      ON("violation", EXPECT_EQ(checker_.violations(), 1U) << checker_.summary();
         expect_like(to_string(checker_.findings().back()), "..." + rest(in) + "...")),
      ON("first", expect_like(checker_.findings()[0].text, rest(in))),
      ON("last", expect_like(checker_.findings().back().text, rest(in))),
      ON("summary", expect_like(checker_.summary(), rest(in)))
    };
    facts_ = {IS("violations", std::to_string(checker_.violations())),
              IS("findings", std::to_string(checker_.findings().size())),
              IS("offset", std::to_string(checker_.findings().back().offset)),
              IS("information packets", std::to_string(checker_.packets().at(0x32)))};
  }

 private:
  void begin(Protocol protocol) {
    checker_ = Checker([protocol](const RobotIdentity&) { return robot(protocol); });
  }
  void say(Side side, const Bytes& bytes) { checker_.feed(side, bytes, time_); }
  void synchronize() {
    for (int i = 0; i < 3; ++i) {
      say(Side::kClient, encode_sync(i));
      say(Side::kServer, i < 2 ? encode_sync(i) : encode_sync2_reply({"Robot", "Pioneer", "43m"}));
    }
  }
  static Bytes bytes(std::istringstream& in) {
    Bytes all;
    for (std::string word; in >> word;)
      all.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
    return all;
  }
  /// "battery=0 x=10000 stall=2 sonar=7 wrong-sum=1".
  void information(std::istringstream& in) {
    InformationPacket packet{.battery = 120, .sonars = {{0, 1000}, {6, 2000}}};
    bool wrong_sum = false;
    for (std::string word; in >> word;) {
      const std::string name = word.substr(0, word.find('='));
      const int value = std::stoi(word.substr(name.size() + 1));
      if (name == "battery")
        packet.battery = static_cast<std::uint8_t>(value);
      else if (name == "x")
        packet.x = static_cast<std::uint16_t>(value);
      else if (name == "stall")
        packet.left_stall = static_cast<std::uint8_t>(value);
      else if (name == "sonar")
        packet.sonars.push_back({static_cast<std::uint8_t>(value), 1});
      else
        wrong_sum = true;
    }
    Bytes bytes = encode(packet);
    bytes.back() ^= wrong_sum ? 1U : 0U;
    say(Side::kServer, bytes);
  }

  Checker checker_{[](const RobotIdentity&) { return robot(Protocol::kArcos); }};
  std::optional<double> time_;
};

TEST(Check, FindsAsWritten) {
  EXPECT_EQ(test::play<Conversation>("bridge/protocol/test/check.txt"), 20);
}

}  // namespace
}  // namespace saphira::protocol
