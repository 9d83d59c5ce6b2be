#include "saphira/camera/frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "saphira/base/text.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/stereo.hpp"

namespace saphira::camera {
namespace {

sim::PinholeCamera lens() {
  return {.pose_in_robot = {0.1, 0.0, 0.25}, .columns = 4, .rows = 2};
}

/// A picture as the simulator sends it.
std::string sent(std::uint64_t cycle, std::uint8_t first) {
  sim::ColorImage image{4, 2, {}};
  for (std::uint8_t i = 0; i < 24; ++i)
    image.pixels.push_back(static_cast<std::uint8_t>(first + i));
  return to_ppm(image, lens(), cycle);
}

TEST(PpmStream, MakesThePictureOfTheSimulatorsBytesHoweverTheyCome) {
  const std::string bytes = sent(12, 10);
  for (const std::size_t part : {std::size_t{1}, std::size_t{7}, bytes.size()}) {
    PpmStream stream;
    std::optional<Frame> frame;
    for (std::size_t at = 0; at < bytes.size(); at += part) {
      EXPECT_FALSE(frame);
      stream.feed(std::string_view(bytes).substr(at, part));
      frame = stream.take();
    }
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->cycle, 12U);
    EXPECT_EQ(frame->columns, 4);
    EXPECT_EQ(frame->rows, 2);
    EXPECT_NEAR(frame->field_of_view, radians(60.0), 1e-8);
    EXPECT_EQ(frame->height, 1.0);
    EXPECT_EQ(frame->pose_in_robot.x, 0.1);
    EXPECT_EQ(frame->pose_in_robot.th, 0.25);
    EXPECT_EQ(frame->pixels.front(), 10);
    EXPECT_EQ(frame->pixels.back(), 33);
  }
}

TEST(PpmStream, OfSeveralPicturesTheNewestCounts) {
  PpmStream stream;
  stream.feed(sent(1, 0) + sent(2, 5) + sent(3, 7).substr(0, 60));
  EXPECT_EQ(stream.take().value().cycle, 2U);
  EXPECT_FALSE(stream.take());
}

TEST(PpmStream, AnotherStreamIsRefused) {
  const std::string good = sent(1, 0);
  std::string huge = good;
  huge.replace(huge.find("4 2"), 3, "4 9999");
  std::string broad = good;
  broad.replace(broad.find("field=1"), 7, "field=9");
  for (const std::string& bytes :
       {std::string("P5\n# saphira stereo cycle=1\n"), std::string(600, 'P'), huge, broad}) {
    PpmStream stream;
    stream.feed(bytes);
    EXPECT_THROW(stream.take(), FileError) << bytes.substr(0, 40);
  }
}

TEST(Jpeg, KeepsThePictureWithinSomeShades) {
  Frame frame;
  frame.columns = 64;
  frame.rows = 48;
  for (int row = 0; row < frame.rows; ++row)
    for (int column = 0; column < frame.columns; ++column)
      for (const int value : {4 * column, 5 * row, 128})
        frame.pixels.push_back(static_cast<std::uint8_t>(value));
  const auto fine = to_jpeg(frame, 90);
  const Frame back = from_jpeg(fine);
  ASSERT_EQ(back.columns, frame.columns);
  ASSERT_EQ(back.rows, frame.rows);
  int worst = 0;
  for (std::size_t i = 0; i < frame.pixels.size(); ++i)
    worst = std::max(worst, std::abs(back.pixels[i] - frame.pixels[i]));
  EXPECT_LT(worst, 16);
  EXPECT_LT(to_jpeg(frame, 20).size(), fine.size());
}

TEST(Jpeg, AnythingElseIsRefused) {
  Frame frame;
  frame.columns = frame.rows = 16;
  frame.pixels.assign(768, 90);
  std::vector<std::uint8_t> jpeg = to_jpeg(frame, 50);
  EXPECT_THROW(from_jpeg({}), std::runtime_error);
  EXPECT_THROW(from_jpeg({1, 2, 3}), std::runtime_error);
  jpeg.resize(30);
  EXPECT_THROW(from_jpeg(jpeg), std::runtime_error);
}

}  // namespace
}  // namespace saphira::camera
