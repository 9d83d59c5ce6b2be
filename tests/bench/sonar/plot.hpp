#pragma once

#include <string>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::bench {

struct Curve {
  std::string label;
  std::string colour;
  std::vector<Vec2> points;
};

struct Panel {
  std::string title;
  std::string x_label;
  std::string y_label;
  double x_max = 1.0;
  double y_max = 1.0;
  std::vector<Curve> curves;
};

/// Panels beside each other (SVG); both axes begin at 0.
std::string plot_svg(const std::vector<Panel>& panels);

}  // namespace saphira::bench
