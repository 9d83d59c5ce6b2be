#include "saphira/maps/drawing.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "saphira/base/places.hpp"

namespace saphira::maps {
namespace {

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
    ++n;
  return n;
}

TEST(Drawing, ShowsEveryRoomDoorAndCorridor) {
  Drawing drawing;
  drawing.map = load_map(config_folder() + "/maps/office-floor.map");
  drawing.title = "office floor <1>";
  drawing.trajectories = {{"driven", {{17.5, 14.0}, {17.5, 7.0}, {30.0, 7.0}}}};
  drawing.matches = {{{16.5, 13.0}, {16.5, 13.1}, true}, {{18.5, 13.0}, {18.5, 14.1}, false}};
  drawing.robot = DrawnRobot{{30.0, 7.0, 0.3}, 0.22, 0.2, 0.05, 0.05};
  Raster raster{.lower_left_in_map = {28.0, 6.0, 0.0},
                .width = 4,
                .height = 2,
                .occupied = {-1.0F, 0.0F, 0.0F, 1.0F, 0.5F, 0.5F, 0.5F, 0.5F}};
  drawing.raster = raster;
  const std::string svg = to_svg(drawing);
  for (const Feature& feature : drawing.map.features) {
    if (!feature.name.empty()) {
      EXPECT_NE(svg.find(feature.name), std::string::npos) << feature.name;
    }
  }
  EXPECT_EQ(count(svg, "height=\"1\" fill=\"rgb("), 3U) << "runs of cells";
  EXPECT_EQ(count(svg, "<ellipse"), 1U);
  EXPECT_NE(svg.find("office floor &lt;1&gt;"), std::string::npos);
  EXPECT_EQ(svg, to_svg(drawing));
  if (const char* file = std::getenv("SAPHIRA_DRAW_TO"))
    std::ofstream(file) << svg;
}

TEST(Drawing, ShowsWhatProgramsHaveDrawnAndWritten) {
  Drawing drawing;
  drawing.map = parse_map("DOOR (3) 0, 0, 0, 900\n", "test.map");
  drawing.strokes = {{"planner", "#ff0000", 0.05, {{0.0, 0.0}, {1.0, 1.0}}}};
  drawing.words = {{{2.0, 3.0}, "here <b>", "#00ff00"}};
  const std::string svg = to_svg(drawing);
  EXPECT_NE(svg.find("stroke=\"#ff0000\""), std::string::npos);
  EXPECT_NE(svg.find(">here &lt;b&gt;</text>"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">planner</text>"), std::string::npos) << "in the legend";
}

TEST(Drawing, ShowsWhichDoorsAreClosedAndWhatTheRobotHasPutDown) {
  Drawing drawing;
  drawing.map = parse_map(
      "DOOR (3) 0, 0, 0, 900\nDOOR (4) 0, 2000, 0, 900\n"
      "OBJECT (5) 2000, 0, 0, 500, 400\n",
      "test.map");
  const std::string before = to_svg(drawing);
  drawing.closed_doors = {4};
  const std::string closed = to_svg(drawing);
  EXPECT_EQ(count(before, "stroke=\"#d55e00\""), count(closed, "stroke=\"#d55e00\"") + 2);
  drawing.map.features.back().learned = true;
  EXPECT_EQ(count(to_svg(drawing), "#e69f00"), count(closed, "#e69f00") + 1);
}

TEST(Drawing, AnEmptyMapIsAPictureToo) {
  const std::string svg = to_svg({});
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace saphira::maps
