#include "saphira/protocol/check.hpp"

#include <gtest/gtest.h>

namespace saphira::protocol {
namespace {

RobotParameters robot(Protocol protocol) {
  RobotParameters p{.protocol = protocol};
  p.sonars.resize(7);
  p.encoder_unit = 1e-5;
  return p;
}

class CheckTest : public ::testing::Test {
 protected:
  explicit CheckTest(Protocol protocol = Protocol::kArcos)
      : checker_([protocol](const RobotIdentity&) { return robot(protocol); }) {}

  void begin_anew() {
    checker_ = Checker([](const RobotIdentity&) { return robot(Protocol::kArcos); });
  }
  void client(const Bytes& bytes, std::optional<double> time = std::nullopt) {
    checker_.feed(Side::kClient, bytes, time);
  }
  void client(const Command& command) { client(encode(command)); }
  void server(const Bytes& bytes, std::optional<double> time = std::nullopt) {
    checker_.feed(Side::kServer, bytes, time);
  }
  void synchronize() {
    for (int i = 0; i < 2; ++i) {
      client(encode_sync(i));
      server(encode_sync(i));
    }
    client(encode_sync(2));
    server(encode_sync2_reply({"Robot", "Pioneer", "psos43m"}));
  }
  void open() {
    synchronize();
    client(Open{});
  }
  static InformationPacket information() {
    return InformationPacket{.battery = 120, .sonars = {{0, 1000}, {6, 2000}}};
  }
  /// The last finding, which must be the only violation.
  std::string only() {
    EXPECT_EQ(checker_.violations(), 1U) << checker_.summary();
    return checker_.findings().empty() ? "" : to_string(checker_.findings().back());
  }
  void expect(const std::string& part) {
    EXPECT_NE(only().find(part), std::string::npos) << only();
  }

  Checker checker_;
};

TEST_F(CheckTest, AGoodConversation) {
  open();
  client(Pulse{});
  server(encode(information()));
  client(Velocity{0.3});
  client(ConfigRequest{1});
  server(encode(config_of(robot(Protocol::kArcos), "a", "b")));
  client(EncoderRequest{2});
  server(encode(information()));
  server(encode(EncoderPacket{}));
  client(EncoderRequest{0});
  server(encode(EncoderPacket{}));  // was on its way
  client(Close{});
  server(encode(information()));  // likewise
  checker_.disconnect();
  EXPECT_TRUE(checker_.findings().empty()) << to_string(checker_.findings()[0]);
  EXPECT_EQ(checker_.commands().at(11), 1U);
  EXPECT_EQ(checker_.packets().at(0x32), 2U + 1U);
  EXPECT_NE(checker_.summary().find("client: 1 x VEL (11)"), std::string::npos);
}

TEST_F(CheckTest, JunkAndItsPlace) {
  client(Bytes{'W', 'M', 'S', '2', '\r'});
  open();
  EXPECT_EQ(checker_.violations(), 0U);
  EXPECT_EQ(checker_.findings().size(), 1U);
  server(Bytes{1, 2, 3});
  expect("3 bytes that belong to no packet");
  EXPECT_EQ(checker_.findings().back().offset, 6U * 2 + 6 + 6 + 8 + 8);
}

TEST_F(CheckTest, ByteCount) {
  open();
  client(Bytes{0xFA, 0xFB, 2, 0, 0});
  EXPECT_GE(checker_.violations(), 1U);
  EXPECT_NE(checker_.findings()[0].text.find("byte count of 2"), std::string::npos);
}

TEST_F(CheckTest, SynchronizationOutOfOrder) {
  client(encode_sync(1));
  expect("SYNC1 before the echo of SYNC0");
}

TEST_F(CheckTest, AnEchoThatNobodyAskedFor) {
  server(encode_sync(0));
  expect("SYNC0 that the client has not sent");
}

TEST_F(CheckTest, StringsOfTheAnswer) {
  client(encode_sync(0));
  server(encode_sync(0));
  client(encode_sync(1));
  server(encode_sync(1));
  client(encode_sync(2));
  server(frame(Bytes{2, 'a', 0, 'b', 0, 'c'}));
  expect("three strings");
}

TEST_F(CheckTest, ACommandBeforeTheSynchronization) {
  client(Velocity{0.1});
  expect("VEL (11) before the synchronization");
}

TEST_F(CheckTest, ArgumentsOfCommands) {
  const std::pair<Bytes, const char*> wrong[] = {
      {{11}, "VEL (11): expected an integer"},
      {{11, 0x3B, 1}, "expected an integer"},
      {{11, 0x3B, 1, 0, 0}, "expected an integer"},
      {{11, 0x2B, 1, 65}, "expected an integer"},
      {{12, 0x3B, 0x69, 1}, "HEAD (12): 361; expected -360 to 360 deg"},
      {{18, 0x3B, 2, 0}, "CONFIG (18): 2"},
      {{32, 0x1B, 1, 1}, "argument type 0x3B"},
      {{3, 0x3B, 1, 0}, "expected a string"},
      {{3, 0x2B, 9, 1, 2}, "ends with NUL"},
      {{3, 0x2B, 8, 0}, "sonar 7 of 7"},
      {{3, 0x2B, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0}, "at most 12"},
      {{64, 0x3B, 1, 0}, "STEP (64): expected no argument"},
      {{14, 0x3B, 1, 0}, "command 14 is in no table"},
  };
  for (const auto& [body, text] : wrong) {
    begin_anew();
    open();
    client(frame(body));
    expect(text);
  }
}

TEST_F(CheckTest, ArgumentsThatMayBeMissing) {
  open();
  for (const Bytes& body : {Bytes{7}, Bytes{7, 0x3B}, Bytes{7, 0x3B, 0, 0}, Bytes{1, 0x3B, 1, 0},
                            Bytes{29}, Bytes{3, 0x2B, 0}, Bytes{3, 0x2B, 2, 1, 2}})
    client(frame(body));
  EXPECT_EQ(checker_.violations(), 0U);
}

// As used by clients of later robots for a laser.
TEST_F(CheckTest, TheTimersCommandSwitchesAPortToo) {
  open();
  for (const Bytes& body : {Bytes{31, 0x3B, 7, 0}, Bytes{31, 0x3B, 0, 11}, Bytes{31, 0x3B, 1, 11}})
    client(frame(body));
  EXPECT_EQ(checker_.violations(), 0U);
}

TEST_F(CheckTest, InformationBeforeOpen) {
  synchronize();
  server(encode(information()));
  expect("before OPEN");
}

TEST_F(CheckTest, InformationAfterClose) {
  open();
  client(Close{});
  server(encode(information()));
  EXPECT_EQ(checker_.violations(), 0U);
  server(encode(information()));
  expect("after CLOSE");
}

TEST_F(CheckTest, PacketsOfAnOpenServer) {
  InformationPacket empty_battery = information();
  empty_battery.battery = 0;
  InformationPacket eighth_sonar = information();
  eighth_sonar.sonars.push_back({7, 1});
  Bytes wide_position{0x32, 0, 0x80};
  wide_position.resize(25);
  Bytes too_short{0x32};
  too_short.resize(24);
  wide_position[11] = too_short[11] = 120;
  Bytes wrong_sum = encode(information());
  wrong_sum.back() ^= 1U;
  const std::pair<Bytes, const char*> wrong[] = {
      {encode(empty_battery), "0 V"},
      {encode(eighth_sonar), "sonar 7 of 7"},
      {frame(wide_position), "15 bits"},
      {frame(too_short), "at least 25"},
      {wrong_sum, "checksum"},
      {encode(IoPacket{{1}, {1}, {}}), "IO packet (0xF0) that nobody has asked for"},
  };
  for (const auto& [packet, text] : wrong) {
    begin_anew();
    open();
    server(packet);
    expect(text);
  }
}

TEST_F(CheckTest, AJump) {
  open();
  server(encode(information()));
  InformationPacket packet = information();
  packet.x = 10000;  // 0.5 m
  server(encode(packet));
  expect("jumps");
  client(SetOrigin{});
  packet.x = 0;
  server(encode(packet));
  EXPECT_EQ(checker_.violations(), 1U);
}

TEST_F(CheckTest, OneForOneRequest) {
  open();
  client(BatteryRequest{1});
  server(encode(BatteryPacket{}));
  EXPECT_EQ(checker_.violations(), 0U);
  server(encode(BatteryPacket{}));
  expect("nobody has asked");
}

TEST_F(CheckTest, ACutPacket) {
  open();
  client(EncoderRequest{2});
  server(frame(Bytes{0x90, 1, 2}));
  expect("ends too early");
}

TEST_F(CheckTest, TheEndWithinAPacket) {
  open();
  client(Bytes{0xFA, 0xFB, 6, 11});
  checker_.disconnect();
  expect("ends within a packet, after 4 bytes");
}

TEST_F(CheckTest, Silence) {
  open();
  server(encode(information()), 1.0);
  client(encode(Pulse{}), 1.0);
  server(encode(information()), 2.5);
  EXPECT_EQ(checker_.violations(), 0U);
  EXPECT_NE(checker_.findings().back().text.find("packet for 1.5"), std::string::npos);
  server(encode(information()), 11.0);
  expect("no information packet for 8.5");
  client(encode(Pulse{}), 3.5);
  EXPECT_NE(checker_.findings().back().text.find("silent for 2.5"), std::string::npos);
}

class PsosCheckTest : public CheckTest {
 protected:
  PsosCheckTest() : CheckTest(Protocol::kPsos) {}
};

TEST_F(PsosCheckTest, StallBytes) {
  open();
  InformationPacket packet = information();
  packet.left_stall = 2;
  server(encode(packet));
  expect("stall bytes");
}

TEST_F(PsosCheckTest, LaterCommandsAreNoted) {
  open();
  client(Enable{true});
  EXPECT_EQ(checker_.violations(), 0U);
  EXPECT_NE(checker_.findings().back().text.find("does not know it"), std::string::npos);
}

}  // namespace
}  // namespace saphira::protocol
