// The parts of a packet that are handed to the library.
#include "sieve.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace saphira::bus::internal {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes header() {
  Bytes bytes(20);
  bytes[0] = 'R';
  bytes[1] = 'T';
  bytes[2] = 'P';
  bytes[3] = 'S';
  return bytes;
}

void add(Bytes& bytes, std::uint8_t id, std::size_t length, bool little = true) {
  const auto low = static_cast<std::uint8_t>(length & 0xffU);
  const auto high = static_cast<std::uint8_t>(length >> 8U);
  bytes.insert(bytes.end(), {id, static_cast<std::uint8_t>(little ? 1 : 0), little ? low : high,
                             little ? high : low});
  bytes.resize(bytes.size() + length);
}

std::size_t sound(const Bytes& bytes) {
  return sound_length(bytes.data(), bytes.size());
}

TEST(Sieve, AFarewellIsASoundAnnouncement) {
  const std::array<std::uint8_t, 12> prefix{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const auto message = farewell(prefix.data());
  ASSERT_EQ(sound_length(message.data(), message.size()), message.size());
  EXPECT_TRUE(std::equal(prefix.begin(), prefix.end(), sender_of(message.data())));
  EXPECT_TRUE(is_announcement(message.data(), message.size()));
}

TEST(Sieve, WholeMessagesPass) {
  Bytes bytes = header();
  add(bytes, 0x09, 8);
  add(bytes, 0x15, 300);
  add(bytes, 0x07, 28, false);
  EXPECT_EQ(sound(bytes), bytes.size());
  add(bytes, 0x09, 0);  // an invalidated time
  add(bytes, 0x15, 0);  // up to the end
  bytes.resize(bytes.size() + 40);
  EXPECT_EQ(sound(bytes), bytes.size());
}

TEST(Sieve, StatisticsAreCutOffWhereverTheyAre) {
  Bytes bytes = header();
  add(bytes, 0x15, 40);
  const std::size_t before = bytes.size();
  add(bytes, 0x80, 56);
  EXPECT_EQ(sound(bytes), before);
  bytes.resize(bytes.size() + 7);
  EXPECT_EQ(sound(bytes), before);
  bytes.resize(before + 10);
  EXPECT_EQ(sound(bytes), before);
  Bytes alone = header();
  add(alone, 0x80, 56);
  EXPECT_EQ(sound(alone), 0U);
}

TEST(Sieve, WhatDoesNotHoldTogetherIsDropped) {
  EXPECT_EQ(sound({}), 0U);
  EXPECT_EQ(sound(header()), 0U);
  Bytes bytes = header();
  add(bytes, 0x15, 40);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_EQ(sound_length(bytes.data(), size), 0U) << size;
  Bytes longer = bytes;
  longer.resize(longer.size() + 3);
  EXPECT_EQ(sound(longer), 0U);
  Bytes other = bytes;
  other[1] = 'X';
  EXPECT_EQ(sound(other), 0U);
}

TEST(Sieve, AnnouncementIsTold) {
  Bytes bytes = header();
  add(bytes, 0x09, 8);
  EXPECT_FALSE(is_announcement(bytes.data(), bytes.size()));
  add(bytes, 0x15, 40);
  EXPECT_FALSE(is_announcement(bytes.data(), bytes.size()));
  bytes[bytes.size() - 40 + 9] = 0x01;
  bytes[bytes.size() - 40 + 11] = 0xc2;
  EXPECT_TRUE(is_announcement(bytes.data(), bytes.size()));
}

/// A heartbeat of the writer 1 of a participant, up to that sample.
Bytes heartbeat(std::uint8_t participant, std::uint32_t high, std::uint32_t low) {
  Bytes bytes = header();
  bytes[8] = participant;
  add(bytes, 0x07, 28);
  bytes[24 + 7] = 1;
  for (unsigned i = 0; i < 4; ++i) {
    bytes[24 + 16 + i] = static_cast<std::uint8_t>(high >> (8U * i));
    bytes[24 + 20 + i] = static_cast<std::uint8_t>(low >> (8U * i));
  }
  return bytes;
}

// Some time at which a program has been awake for long.
const Sequences::Time kAwake = Sequences::Time{} + std::chrono::hours(1);

/// Heartbeats until kAwake, so that the program is known to be awake.
void wake(Sequences& sequences) {
  const Bytes bytes = heartbeat(99, 0, 1);
  for (auto time = kAwake - std::chrono::seconds(3); time < kAwake;
       time += std::chrono::milliseconds(100))
    sequences.plausible(bytes.data(), bytes.size(), time);
}

TEST(Sequences, LeapIsBelievedWhenItIsSaidThreeTimes) {
  Sequences sequences;
  const auto ask = [&](const Bytes& bytes) {
    return sequences.plausible(bytes.data(), bytes.size(), kAwake);
  };
  wake(sequences);
  EXPECT_TRUE(ask(heartbeat(1, 0, 5000)));  // a late reader begins at any number
  EXPECT_TRUE(ask(heartbeat(1, 0, 5001)));
  EXPECT_TRUE(ask(heartbeat(1, 0, 10)));  // a repeated heartbeat is behind
  EXPECT_FALSE(ask(heartbeat(1, 7, 5002)));
  EXPECT_FALSE(ask(heartbeat(1, 0x7fffffff, 5002)));
  EXPECT_TRUE(ask(heartbeat(1, 0, 5002)));
  EXPECT_TRUE(ask(heartbeat(2, 0, 900000)));  // another writer
  EXPECT_FALSE(ask(heartbeat(3, 7, 5002)));   // a third one, whose first number is absurd
  EXPECT_TRUE(ask(heartbeat(3, 0, 7)));
  // It was away for long.
  EXPECT_FALSE(ask(heartbeat(1, 0, 90000)));
  EXPECT_FALSE(ask(heartbeat(1, 0, 90001)));
  EXPECT_TRUE(ask(heartbeat(1, 0, 90002)));
  EXPECT_TRUE(ask(heartbeat(1, 0, 90003)));
}

TEST(Sequences, LeapMayBeAsLongAsTheSilenceExplains) {
  using std::chrono::milliseconds;
  Sequences sequences;
  wake(sequences);
  const auto ask = [&](std::uint8_t participant, std::uint32_t number, milliseconds time) {
    const Bytes bytes = heartbeat(participant, 0, number);
    return sequences.plausible(bytes.data(), bytes.size(), kAwake + time);
  };
  EXPECT_TRUE(ask(1, 5000, milliseconds(0)));
  EXPECT_FALSE(ask(1, 5100, milliseconds(100)));
  EXPECT_FALSE(ask(1, 5900, milliseconds(100)));
  EXPECT_TRUE(ask(1, 5010, milliseconds(200)));
  // The writer was not heard for some seconds, while others were.
  for (auto time = milliseconds(200); time < milliseconds(4000); time += milliseconds(100))
    EXPECT_TRUE(ask(2, 1, time));
  EXPECT_FALSE(ask(1, 5910, milliseconds(4000)));
  EXPECT_TRUE(ask(1, 5050, milliseconds(4000)));
}

TEST(Sequences, ProgramThatSleptBelievesTheLeapsOfAll) {
  using std::chrono::milliseconds;
  Sequences sequences;
  wake(sequences);
  const auto ask = [&](std::uint32_t number, milliseconds time) {
    const Bytes bytes = heartbeat(1, 0, number);
    return sequences.plausible(bytes.data(), bytes.size(), kAwake + time);
  };
  EXPECT_TRUE(ask(5000, milliseconds(0)));
  // The samples from before the sockets were full come first, and present ones right behind them.
  EXPECT_TRUE(ask(5001, milliseconds(30000)));
  EXPECT_TRUE(ask(5002, milliseconds(30000)));
  EXPECT_TRUE(ask(5300, milliseconds(30001)));
  EXPECT_FALSE(ask(6500, milliseconds(30002)));
}

TEST(Sequences, HeartbeatThatBeginsBehindItsEndIsRefused) {
  Sequences sequences;
  Bytes bytes = heartbeat(1, 0, 20);
  bytes[24 + 12] = 21;
  EXPECT_TRUE(sequences.plausible(bytes.data(), bytes.size(), kAwake));  // nothing is left
  bytes[24 + 12] = 22;
  EXPECT_FALSE(sequences.plausible(bytes.data(), bytes.size(), kAwake));
}

TEST(Sequences, EveryKindOfSubmessageIsRead) {
  for (const int id : {0x06, 0x07, 0x08, 0x15, 0x16}) {
    Sequences sequences;
    Bytes bytes = header();
    add(bytes, static_cast<std::uint8_t>(id), 40);
    EXPECT_TRUE(sequences.plausible(bytes.data(), bytes.size(), kAwake));
    const std::size_t number = id == 0x07 ? 16 : id >= 0x15 ? 12 : 8;
    bytes[24 + number] = 1;  // 2^32
    EXPECT_FALSE(sequences.plausible(bytes.data(), bytes.size(), kAwake)) << id;
  }
}

TEST(Sequences, ShortSubmessagesAreNotReadBeyondTheirEnd) {
  for (int id = 0; id < 256; ++id)
    for (std::size_t length = 0; length < 30; ++length) {
      Sequences sequences;
      Bytes bytes = header();
      add(bytes, static_cast<std::uint8_t>(id), length);
      EXPECT_TRUE(sequences.plausible(bytes.data(), bytes.size(), kAwake));
    }
}

}  // namespace
}  // namespace saphira::bus::internal
