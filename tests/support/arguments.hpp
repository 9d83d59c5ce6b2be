#pragma once

#include <gtest/gtest.h>

#include <regex>
#include <sstream>
#include <string>

#include "saphira/requests/argument.hpp"

namespace saphira::test {

/// Of "x y" or "x y degrees".
inline Pose pose_of(const std::string& text) {
  std::istringstream in(text);
  double x = 0.0;
  double y = 0.0;
  double degrees = 0.0;
  in >> x >> y >> degrees;
  return {x, y, radians(degrees)};
}

/// Of 'place=EJ-231 speed=0.3 object="the report" position=(17.5 8) place=ahead(2 0)'; "place=?" is
/// open, and "place=?P" a variable. frame: of points without one; others are "ahead(2 0)" of the
/// robot or on the "map(2 0)".
inline Arguments arguments_of(const std::string& text, Frame frame = Frame::map) {
  static const std::regex one(
      R"re(\s*(@?[-\w]+)=(?:"([^"]*)"|(ahead|map)?\(([^)]*)\)|\?(\w*)|(-?[0-9.]+)(?!\S)|(\S+)))re");
  Arguments all;
  std::string rest = text;
  for (std::sregex_iterator it(text.begin(), text.end(), one), none; it != none; ++it) {
    const std::smatch& m = *it;
    EXPECT_EQ(m.prefix(), "") << "not understood: " << text;
    rest = m.suffix();
    all.push_back(m[4].matched   ? point(m[1], pose_of(m[4]),
                                       m[3] == "ahead" ? Frame::robot
                                         : m[3] == "map" ? Frame::map
                                                         : frame)
                  : m[6].matched ? number(m[1], std::stod(m[6]))
                                 : saphira::text(m[1], m[2].str() + m[5].str() + m[7].str()));
    if (m[5].matched)
      all.back().kind = ArgumentKind::unbound;
  }
  EXPECT_EQ(rest, "") << "not understood: " << text;
  return all;
}

}  // namespace saphira::test
