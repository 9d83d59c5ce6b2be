#include "saphira/recorder/recording.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>

#include "trouble.hpp"

namespace saphira::recorder {
namespace {

/// Two topics; the second one begins in the second chunk.
std::string two_topics(bool with_end = true) {
  std::ostringstream out;
  Writer writer(out);
  const std::uint16_t state = writer.add_channel({"robot/state", "State", "flakey"}, "{}");
  const std::uint16_t log = writer.add_channel({"system/log", "Line", "flakey"}, "{}");
  writer.add_channel({"map", "Map", "flakey"}, "{}");  // nothing comes
  writer.add({state, 1000, R"({"x":1.5})"});
  writer.add({state, 2000, R"({"x":null})"});
  EXPECT_TRUE(writer.flush());
  writer.add({log, 2500, R"({"text":"a \"word\""})"});
  writer.add({state, 3000, R"({"x":2})"});
  EXPECT_TRUE(writer.flush());
  if (with_end) {
    EXPECT_TRUE(writer.close());
    EXPECT_EQ(writer.bytes(), out.str().size());
  }
  EXPECT_EQ(writer.samples(), 4U);
  return out.str();
}

struct Read {
  std::string text;  ///< a line for each sample
  bool cut_off = false;
};

Read read(const std::string& file) {
  std::istringstream in(file);
  Reader reader(in);
  Read all;
  while (const auto sample = reader.next())
    all.text += reader.channel(sample->channel).robot + " " +
                reader.channel(sample->channel).topic + " " + std::to_string(sample->time_ns) +
                " " + sample->json + "\n";
  all.cut_off = reader.is_cut_off();
  return all;
}

constexpr const char* kAll =
    "flakey robot/state 1000 {\"x\":1.5}\n"
    "flakey robot/state 2000 {\"x\":null}\n"
    "flakey system/log 2500 {\"text\":\"a \\\"word\\\"\"}\n"
    "flakey robot/state 3000 {\"x\":2}\n";

TEST(Recording, IsReadAsItWasWritten) {
  EXPECT_EQ(read(two_topics()).text, kAll);
  EXPECT_FALSE(read(two_topics()).cut_off);
}

TEST(Recording, WithoutItsEndHasEveryChunk) {
  const Read all = read(two_topics(false));
  EXPECT_EQ(all.text, kAll);
  EXPECT_TRUE(all.cut_off);
  const std::string file = two_topics();
  for (std::size_t size = 8; size < file.size(); ++size)
    EXPECT_TRUE(std::string(kAll).starts_with(read(file.substr(0, size)).text)) << size;
}

TEST(Recording, SaysWhatIsWrongAndWhere) {
  const auto error = [](const std::string& file) {
    return test::trouble_of<std::invalid_argument>([&] { read(file); });
  };
  EXPECT_EQ(error("P5 640 480"),
            "not an MCAP file: this is a picture (PGM), such as occupancy grids are kept in");
  EXPECT_EQ(error("SQLite format 3"),
            "not an MCAP file: this is a database (SQLite), such as recordings of ROS 2 (.db3)");
  EXPECT_EQ(error("\x89MCAP1\r\n"), "not an MCAP file: its first bytes are others");
  EXPECT_EQ(error(""), "not an MCAP file: its first bytes are others");
  const std::string file = two_topics();
  const std::size_t packed = file.find("\x28\xB5\x2F\xFD");
  ASSERT_NE(packed, std::string::npos);
  for (const std::size_t place : {packed, packed + 20}) {
    std::string damaged = file;
    damaged.at(place) = static_cast<char>(damaged.at(place) ^ 0x55);
    EXPECT_NE(error(damaged).find("byte 32: damaged"), std::string::npos) << error(damaged);
  }
  std::string other = file;
  other.replace(other.find("zstd"), 4, "lzma");
  EXPECT_NE(error(other).find("byte 32: compressed with lzma"), std::string::npos) << error(other);
}

TEST(Recording, RepetitionCostsLittle) {
  std::ostringstream out;
  Writer writer(out);
  const std::uint16_t state = writer.add_channel({"robot/state", "State", "flakey"}, "{}");
  const std::string json = R"({"pose":{"x":1.5,"y":2.25,"th":0.125},"battery":12.5})";
  for (int i = 0; i < 100; ++i)
    writer.add({state, i, json});
  EXPECT_TRUE(writer.flush());
  std::istringstream in(out.str());
  Reader reader(in);
  int samples = 0;
  while (const auto sample = reader.next()) {
    EXPECT_EQ(sample->json, json);
    ++samples;
  }
  EXPECT_EQ(samples, 100);
  // The index alone has 16 bytes a sample.
  EXPECT_LT(writer.bytes(), 100 * json.size() / 2);
}

TEST(Recording, AFullDiskIsNoticed) {
  std::ostringstream out;
  Writer writer(out);
  writer.add({writer.add_channel({"map", "Map", "flakey"}, "{}"), 1, "{}"});
  out.setstate(std::ios::badbit);
  EXPECT_FALSE(writer.flush());
}

// The format by its published tables (mcap.dev/spec), read without Reader.
TEST(Recording, EndsWithASummaryOfTheFormat) {
  const std::string file = two_topics();
  const std::string magic("\x89MCAP0\r\n", 8);
  ASSERT_TRUE(file.starts_with(magic));
  ASSERT_TRUE(file.ends_with(magic));
  const auto number = [&](std::size_t at, int bytes) {
    std::uint64_t value = 0;
    for (int i = bytes; i-- > 0;)
      value = value << 8U | static_cast<unsigned char>(file.at(at + static_cast<std::size_t>(i)));
    return value;
  };
  const std::size_t footer = file.size() - 8 - 20 - 9;
  EXPECT_EQ(number(footer, 1), 2U);
  EXPECT_EQ(number(footer + 1, 8), 20U);
  std::string codes;
  std::uint64_t samples = 0;
  std::uint64_t chunks = 0;
  std::size_t at = number(footer + 9, 8);
  for (; at < footer; at += 9 + number(at + 1, 8)) {
    codes += std::to_string(number(at, 1)) + " ";
    if (number(at, 1) == 11) {
      samples = number(at + 9, 8);
      chunks = number(at + 9 + 22, 4);
    }
    if (number(at, 1) == 8) {
      EXPECT_EQ(number(number(at + 9 + 16, 8), 1), 6U) << "the place of a chunk";
    }
  }
  EXPECT_EQ(at, footer);
  EXPECT_EQ(codes, "3 3 4 4 11 8 8 14 14 14 14 ");
  EXPECT_EQ(samples, 4U);
  EXPECT_EQ(chunks, 2U);
}

}  // namespace
}  // namespace saphira::recorder
