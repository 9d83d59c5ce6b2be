#include "saphira/sim/server.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "process.hpp"
#include "saphira/base/text.hpp"

namespace saphira::sim {
namespace {

using protocol::Command;
using protocol::encode;

using test::source;

// A server in the office, and a client of it without a line between them.
class ServerTest : public ::testing::Test {
 protected:
  std::unique_ptr<Server> opened(Scene& scene, bool single_step) const {
    ServerOptions options;
    options.trace = true;
    options.single_step = single_step;
    auto server = std::make_unique<Server>(scene, parameters_, *world_.start, options);
    for (int i = 0; i < 3; ++i)
      server->receive(protocol::encode_sync(i));
    server->receive(encode(protocol::Open{}));
    return server;
  }

  const World world_ = load_world(source("config/worlds/office.wld"));
  const protocol::RobotParameters parameters_ =
      protocol::load_parameters(source("config/robots/pioneer.p"));
  Scene scene_{world_};
};

TEST_F(ServerTest, StepsAreTheSamePhysicsAsLive) {
  Scene scene(world_);
  const auto server = opened(scene_, false);
  const auto stepped = opened(scene, true);
  for (int i = 0; i < 300; ++i) {
    const Command command = i % 7 == 0
                                ? Command{protocol::RotationVelocity{radians(i % 5 * 10.0 - 20.0)}}
                                : Command{protocol::Velocity{0.1 * (i % 4)}};
    server->receive(encode(command));
    server->advance(kTicksPerPacket);
    stepped->receive(encode(command));
    stepped->advance(1000);  // time alone moves nothing
    stepped->receive(encode(protocol::Step{}));
  }
  const auto live = server->take_trace();
  const auto step = stepped->take_trace();
  ASSERT_EQ(live.size(), 300U);
  ASSERT_EQ(step.size(), 300U);
  for (std::size_t i = 0; i < live.size(); ++i)
    ASSERT_EQ(to_csv(live[i]), to_csv(step[i])) << i;
  EXPECT_EQ(server->take_output(), stepped->take_output());
}

TEST_F(ServerTest, RefusesToStandInAWall) {
  EXPECT_THROW(Server(scene_, parameters_, {1.5, 6.1, 0.0}, {}), std::invalid_argument);
}

TEST(Trace, SurvivesTheFile) {
  const TraceRow row{true, 7, {1.0 / 3.0, -2.0, 0.1}, 0.3, -0.2, 0.4, std::nan(""), 0.0, 0.25, 2};
  const std::string text = trace_header() + to_csv(row) + to_csv(row) + "9,1,2";
  const auto rows = parse_trace(text, "t.csv");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_TRUE(rows[0].first);
  EXPECT_FALSE(rows[1].first);
  EXPECT_EQ(to_csv(rows[0]), to_csv(row));
  EXPECT_THROW(parse_trace("1,2,3\n", "t.csv"), FileError);
  EXPECT_THROW(parse_trace(trace_header() + "1,2,3\n", "t.csv"), FileError);
  EXPECT_THROW(parse_trace(trace_header() + "1,2,3,4,5,6,7,8,9,10,x\n", "t.csv"), FileError);
}

TEST_F(ServerTest, ThePictureHasTheWorldAndTheWay) {
  const auto server = opened(scene_, false);
  server->receive(encode(protocol::Velocity{0.3}));
  server->advance(190);
  const auto rows = server->take_trace();
  const std::string svg = plot_svg(world_, rows, parameters_.radius);
  EXPECT_TRUE(svg.starts_with("<svg "));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_NE(svg.find("M0 14000L24000 14000"), std::string::npos);  // a wall, y turned over
  EXPECT_TRUE(plot_svg(world_, {}, 0.22).ends_with("</svg>\n"));
}

}  // namespace
}  // namespace saphira::sim
