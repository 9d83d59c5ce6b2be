#include "chunks.hpp"

#include <gtest/gtest.h>

#include <string>

namespace saphira::web {
namespace {

constexpr std::string_view kWhole =
    "5\r\nhello\r\n1;name=\"value\"\r\n,\r\n6\r\n world\r\n0\r\nTrailer: x\r\n\r\n";

TEST(Chunks, ABodyIsTheSameHoweverItsBytesCome) {
  for (std::size_t size = 1; size <= kWhole.size(); ++size) {
    Chunks chunks;
    std::string body;
    for (std::size_t at = 0; at < kWhole.size(); at += size) {
      EXPECT_FALSE(chunks.ended());
      ASSERT_TRUE(chunks.take(kWhole.substr(at, size), body)) << size;
    }
    EXPECT_EQ(body, "hello, world") << size;
    EXPECT_TRUE(chunks.ended()) << size;
    EXPECT_TRUE(chunks.take("GET", body));
    EXPECT_EQ(body, "hello, world") << "what comes behind it is no part of it";
  }
}

TEST(Chunks, OtherBytesAreRefused) {
  for (const char* text : {"hello\r\n", "-1\r\n", "5\nhello\r\n", "5x\r\n", "\r\n",
                           "2\r\nhello\r\n", "11111111111111111\r\n"}) {
    Chunks chunks;
    std::string body;
    EXPECT_FALSE(chunks.take(text, body)) << text;
  }
  Chunks chunks;
  std::string body;
  EXPECT_FALSE(chunks.take(std::string(2000, '0'), body)) << "a line without an end";
}

}  // namespace
}  // namespace saphira::web
