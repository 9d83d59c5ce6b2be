#include "plot.hpp"

#include <array>
#include <cstdio>

namespace saphira::bench {

namespace {

constexpr double kWidth = 380;
constexpr double kHeight = 300;
constexpr double kLeft = 52;
constexpr double kRight = 12;
constexpr double kTop = 34;
constexpr double kBottom = 46;

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

std::string text(double x, double y, const std::string& anchor, const std::string& what,
                 const std::string& more = "") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\"" +
         more + ">" + what + "</text>\n";
}

std::string panel_svg(const Panel& panel, double x0) {
  const double width = kWidth - kLeft - kRight;
  const double height = kHeight - kTop - kBottom;
  const auto x = [&](double v) { return x0 + kLeft + v / panel.x_max * width; };
  const auto y = [&](double v) { return kTop + height - v / panel.y_max * height; };
  std::string out = text(x0 + kWidth / 2, 20, "middle", panel.title, " font-weight=\"bold\"");
  for (int i = 0; i <= 4; ++i) {
    const double at_x = panel.x_max * i / 4;
    const double at_y = panel.y_max * i / 4;
    out += "<path stroke=\"#d8dbe0\" d=\"M" + number(x(0)) + " " + number(y(at_y)) + "H" +
           number(x(panel.x_max)) + "M" + number(x(at_x)) + " " + number(y(0)) + "V" +
           number(y(panel.y_max)) + "\"/>\n";
    out += text(x(at_x), y(0) + 15, "middle", number(at_x));
    out += text(x(0) - 6, y(at_y) + 4, "end", number(at_y));
  }
  out += text(x(panel.x_max / 2), kHeight - 12, "middle", panel.x_label);
  out += "<g transform=\"translate(" + number(x0 + 13) + " " + number(y(panel.y_max / 2)) +
         ") rotate(-90)\">" + text(0, 0, "middle", panel.y_label) + "</g>\n";
  double legend = kTop + 14;
  for (const Curve& curve : panel.curves) {
    std::string way;
    for (const Vec2& p : curve.points) {
      way += (way.empty() ? "M" : "L") + number(x(p.x())) + " " +
             number(y(std::min(p.y(), panel.y_max)));
      out += "<circle r=\"3\" fill=\"" + curve.colour + "\" cx=\"" + number(x(p.x())) + "\" cy=\"" +
             number(y(std::min(p.y(), panel.y_max))) + "\"/>\n";
    }
    out += "<path fill=\"none\" stroke-width=\"2\" stroke=\"" + curve.colour + "\" d=\"" + way +
           "\"/>\n";
    out += text(x(panel.x_max) - 6, legend, "end", curve.label, " fill=\"" + curve.colour + "\"");
    legend += 15;
  }
  return out;
}

}  // namespace

std::string plot_svg(const std::vector<Panel>& panels) {
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
                    number(kWidth * static_cast<double>(panels.size())) + "\" height=\"" +
                    number(kHeight) +
                    "\" font-family=\"sans-serif\" font-size=\"11\" fill=\"#30343b\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  double x0 = 0.0;
  for (const Panel& panel : panels) {
    out += panel_svg(panel, x0);
    x0 += kWidth;
  }
  return out + "</svg>\n";
}

}  // namespace saphira::bench
