// What of a packet is handed to the library.
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

}  // namespace
}  // namespace saphira::bus::internal
