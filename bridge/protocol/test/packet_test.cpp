#include "saphira/protocol/packet.hpp"

#include <gtest/gtest.h>

#include <set>

#include "saphira/base/random.hpp"
#include "saphira/protocol/command.hpp"
#include "saphira/protocol/information.hpp"

namespace saphira::protocol {
namespace {

std::vector<Bytes> all(PacketParser& parser) {
  std::vector<Bytes> out;
  while (auto body = parser.next())
    out.push_back(*body);
  return out;
}

void append(Bytes& to, const Bytes& bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

// The C fragment of manual 5.1.2, with `n -= 2`. ptr is the array of bytes, first is data count.
int calc_chksum(const unsigned char* ptr) {
  int n = 0;
  int c = 0;
  n = *(ptr++);
  n -= 2;
  while (n > 1) {
    c += (*(ptr) << 8) | *(ptr + 1);
    c = c & 0xffff;
    n -= 2;
    ptr += 2;
  }
  if (n > 0)
    c = c ^ static_cast<int>(*(ptr++));
  return c;
}

TEST(Checksum, IsTheManuals) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    Bytes body(1 + random.next() % kMaxBody);
    for (auto& byte : body)
      byte = static_cast<std::uint8_t>(random.next());
    const Bytes packet = frame(body);
    ASSERT_EQ(checksum(body), calc_chksum(packet.data() + 2));
    const std::size_t n = packet.size();
    ASSERT_EQ(packet[n - 2] << 8 | packet[n - 1], checksum(body));
    ASSERT_EQ(packet[2], body.size() + 2);
  }
}

// Seen on the wire between real programs: Player's SETO.
TEST(Checksum, OfARealPacket) {
  const Bytes body{0x07, 0x3B};
  EXPECT_EQ(frame(body), (Bytes{0xFA, 0xFB, 0x04, 0x07, 0x3B, 0x07, 0x3B}));
}

TEST(Frame, RefusesWhatNoPacketHolds) {
  EXPECT_THROW(frame({}), std::length_error);
  EXPECT_THROW(frame(Bytes(kMaxBody + 1)), std::length_error);
  EXPECT_EQ(frame(Bytes(kMaxBody)).size(), kMaxCount + 3);
}

TEST(PacketParser, TakesBytesInPiecesOfAnySize) {
  Bytes stream;
  std::vector<Bytes> sent;
  for (std::size_t i = 1; i < 40; ++i) {
    sent.emplace_back(i, static_cast<std::uint8_t>(i));
    append(stream, frame(sent.back()));
  }
  for (std::size_t piece = 1; piece < 50; ++piece) {
    PacketParser parser;
    std::vector<Bytes> got;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      parser.feed(ByteView(stream).subspan(at, std::min(piece, stream.size() - at)));
      for (auto& body : all(parser))
        got.push_back(body);
    }
    EXPECT_EQ(got, sent);
    EXPECT_EQ(parser.counters(), (ParserCounters{39, 0, 0, 0, 0}));
    EXPECT_FALSE(parser.pending());
  }
}

TEST(PacketParser, SkipsJunkBeforeTheHeader) {
  Bytes stream{'W', 'M', 'S', '2', '\r', 0xFA, 0xFA};
  append(stream, encode_sync(0));
  PacketParser parser;
  parser.feed(stream);
  EXPECT_EQ(all(parser), std::vector<Bytes>{Bytes{0}});
  EXPECT_EQ(parser.counters().skipped_bytes, 7U);
  EXPECT_EQ(parser.counters().bad_packets(), 0U);
}

TEST(PacketParser, FindsThePacketInsideABadOne) {
  // A damaged count swallows the next packet; the parser must still find it.
  Bytes stream = encode(Velocity{0.1});
  const std::size_t own_size = stream.size();
  stream[2] = static_cast<std::uint8_t>(own_size - 3 + 7);
  append(stream, encode(SetOrigin{}));
  append(stream, encode(Pulse{}));
  PacketParser parser;
  parser.feed(stream);
  EXPECT_EQ(all(parser), (std::vector<Bytes>{Bytes{7}, Bytes{0}}));
  EXPECT_EQ(parser.counters().bad_checksums, 1U);
  EXPECT_EQ(parser.counters().skipped_bytes, own_size);
}

TEST(PacketParser, RefusesCountsThatNoPacketHas) {
  for (const int count : {0, 1, 2, 201, 255}) {
    Bytes stream{0xFA, 0xFB, static_cast<std::uint8_t>(count)};
    append(stream, encode(Pulse{}));
    PacketParser parser;
    parser.feed(stream);
    EXPECT_EQ(all(parser).size(), 1U) << count;
    EXPECT_EQ(parser.counters().bad_counts, 1U) << count;
  }
}

TEST(PacketParser, AGapEndsAPacketThatIsNotComplete) {
  Bytes stream{0xFA, 0xFB, 190};
  append(stream, encode(SetOrigin{}));
  PacketParser parser;
  parser.feed(stream);
  EXPECT_TRUE(all(parser).empty());
  EXPECT_TRUE(parser.pending());
  parser.gap();
  EXPECT_EQ(all(parser), std::vector<Bytes>{Bytes{7}});
  EXPECT_EQ(parser.counters().abandoned, 1U);
  EXPECT_FALSE(parser.pending());
  // Bytes after the gap are waited for again.
  const Bytes next = encode(Velocity{0.3});
  parser.feed(ByteView(next).first(4));
  EXPECT_FALSE(parser.next());
  parser.feed(ByteView(next).subspan(4));
  EXPECT_TRUE(parser.next());
}

TEST(PacketParser, ResetForgetsTheBytesAndKeepsTheCounters) {
  PacketParser parser;
  parser.feed(encode(Pulse{}));
  all(parser);
  parser.feed(Bytes{0xFA, 0xFB, 9, 1});
  EXPECT_FALSE(parser.next());
  parser.reset();
  parser.feed(encode(SetOrigin{}));
  EXPECT_EQ(all(parser), std::vector<Bytes>{Bytes{7}});
  EXPECT_EQ(parser.counters().packets, 2U);
}

// A noisy line: bytes are changed, dropped or doubled. The parser may return only packets that were
// sent, except for a collision of the 16-bit checksum.
class NoisyLine : public ::testing::TestWithParam<std::tuple<double, int>> {};

TEST_P(NoisyLine, YieldsNoPacketThatWasNotSent) {
  const auto [rate, kind] = GetParam();
  Random random(static_cast<std::uint64_t>(kind) * 1000 + 7);
  PacketParser parser;
  std::set<Bytes> sent;
  int good = 0;
  int wrong = 0;
  constexpr int kPackets = 20000;
  for (int i = 0; i < kPackets; ++i) {
    Bytes body;
    if (i % 2 == 0) {
      const Bytes whole = encode(Velocity{random.uniform(-0.4, 0.4)});
      body.assign(whole.begin() + 3, whole.end() - 2);
    } else {
      body.resize(1 + random.next() % 50);
      for (auto& byte : body)
        byte = static_cast<std::uint8_t>(random.next());
    }
    sent.insert(body);
    Bytes noisy;
    for (std::uint8_t byte : frame(body)) {
      const bool hit = random.chance(rate);
      if (hit && kind == 1)
        continue;
      if (hit && kind == 0)
        byte = static_cast<std::uint8_t>(random.next());
      noisy.push_back(byte);
      if (hit && kind == 2)
        noisy.push_back(byte);
    }
    parser.feed(noisy);
    if (i % 10 == 0)
      parser.gap();
    while (auto got = parser.next())
      (sent.contains(*got) ? good : wrong)++;
  }
  // The additive checksum misses two changes that cancel, and zero bytes that move by a pair.
  // Random errors pass at least one candidate in 65536. The bound is some ten times that.
  EXPECT_LE(wrong, rate < 0.05 ? 3 : 8) << "of " << kPackets;
  EXPECT_GT(good, kPackets * (rate < 0.05 ? 0.7 : 0.1));
  EXPECT_GT(parser.counters().bad_packets(), 0U);
  EXPECT_EQ(parser.counters().packets, static_cast<std::uint64_t>(good + wrong));
}

INSTANTIATE_TEST_SUITE_P(Noise, NoisyLine,
                         ::testing::Combine(::testing::Values(0.01, 0.1),
                                            ::testing::Values(0, 1, 2)));

}  // namespace
}  // namespace saphira::protocol
