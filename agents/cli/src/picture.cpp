#include "saphira/cli/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace saphira::cli {

namespace {

constexpr double kCell = 0.05;              ///< [m]
constexpr std::size_t kMostEchoes = 20000;  ///< the oldest are dropped
constexpr double kWakeStep = 0.05;          ///< [m]
constexpr double kMargin = 0.5;             ///< [m] around the content

/// The content of a character; of several contents, the last in this order is shown.
enum class Layer { none, wall, echo, wake, goal, robot };

struct Look {
  const char* color;
  char letter;
};
Look look(Layer layer) {
  constexpr Look kLooks[]{{"", ' '},         {"\x1b[90m", ':'}, {"\x1b[37m", '.'},
                          {"\x1b[34m", '-'}, {"\x1b[31m", 'X'}, {"\x1b[32m", 'O'}};
  return kLooks[static_cast<std::size_t>(layer)];
}

/// The order of the dots in a Braille character: Unicode, block 2800.
constexpr std::array<unsigned, 8> kBits{0x01, 0x02, 0x04, 0x40, 0x08, 0x10, 0x20, 0x80};

/// Characters of 2 x 4 dots.
class Canvas {
 public:
  Canvas(int columns, int rows)
      : columns_(columns),
        rows_(rows),
        cells_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

  void dot(int u, int v, Layer layer) {
    if (u < 0 || v < 0 || u >= 2 * columns_ || v >= 4 * rows_)
      return;
    Cell& cell = cells_[index(u / 2, v / 4)];
    cell.bits |= kBits[static_cast<std::size_t>(u % 2) * 4 + static_cast<std::size_t>(v % 4)];
    cell.layer = std::max(cell.layer, layer);
  }

  std::vector<std::string> lines(bool utf8) const {
    std::vector<std::string> all;
    for (int row = 0; row < rows_; ++row) {
      std::string line;
      Layer last = Layer::none;
      for (int column = 0; column < columns_; ++column) {
        const Cell& cell = cells_[index(column, row)];
        if (cell.layer != last && cell.layer != Layer::none) {
          line += look(cell.layer).color;
          last = cell.layer;
        }
        if (cell.bits == 0 || !utf8) {
          line += look(cell.layer).letter;
        } else {
          // U+2800 + bits in UTF-8.
          line += '\xe2';
          line += static_cast<char>(0xa0 | (cell.bits >> 6U));
          line += static_cast<char>(0x80 | (cell.bits & 0x3fU));
        }
      }
      all.push_back(line + "\x1b[0m");
    }
    return all;
  }

 private:
  struct Cell {
    unsigned bits = 0;
    Layer layer = Layer::none;
  };

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  int columns_;
  int rows_;
  std::vector<Cell> cells_;
};

}  // namespace

void Picture::move_robot(const Pose& pose) {
  robot_ = pose;
  if (wake_.empty() || (wake_.back() - pose.position()).norm() >= kWakeStep)
    wake_.push_back(pose.position());
}

void Picture::add_echo(const Vec2& point) {
  const std::pair cell{static_cast<int>(std::floor(point.x() / kCell)),
                       static_cast<int>(std::floor(point.y() / kCell))};
  if (!echoes_.insert(cell).second)
    return;
  order_.push_back(cell);
  if (order_.size() > kMostEchoes) {
    echoes_.erase(order_.front());
    order_.pop_front();
  }
}

std::string Picture::legend(bool utf8) {
  std::string text;
  const auto add = [&](Layer layer, const char* name) {
    text += (text.empty() ? "" : "   ") + std::string(look(layer).color);
    text += utf8 ? std::string("\u28ff") : std::string(1, look(layer).letter);
    text += std::string("\x1b[0m ") + name;
  };
  add(Layer::robot, "robot");
  add(Layer::wake, "its way");
  add(Layer::goal, "goal");
  add(Layer::echo, "heard");
  add(Layer::wall, "map");
  return text;
}

std::vector<std::string> Picture::draw(int columns, int rows, bool utf8) const {
  columns = std::max(columns, 1);
  rows = std::max(rows, 1);
  Vec2 low = robot_.position();
  Vec2 high = low;
  const auto include = [&](const Vec2& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  };
  for (const Vec2& point : wake_)
    include(point);
  if (goal_)
    include(*goal_);
  for (const auto& [i, j] : echoes_)
    include({(i + 0.5) * kCell, (j + 0.5) * kCell});
  low -= Vec2::Constant(kMargin);
  high += Vec2::Constant(kMargin);
  // A dot is about square: a character is twice as high as wide, like 2 x 4 dots.
  const Vec2 size = high - low;
  const double scale = std::max(size.x() / (2 * columns), size.y() / (4 * rows));
  const Vec2 middle = (low + high) / 2;
  Canvas canvas(columns, rows);
  const auto dot = [&](const Vec2& point, Layer layer) {
    canvas.dot(static_cast<int>(std::floor(columns + (point.x() - middle.x()) / scale)),
               static_cast<int>(std::floor(2 * rows - (point.y() - middle.y()) / scale)), layer);
  };

  for (const auto& [from, to] : walls_) {
    const int dots = std::min(static_cast<int>((to - from).norm() / scale), 1000);
    for (int i = 0; i <= dots; ++i)
      dot(from + (to - from) * i / std::max(dots, 1), Layer::wall);
  }
  for (const auto& [i, j] : echoes_)
    dot({(i + 0.5) * kCell, (j + 0.5) * kCell}, Layer::echo);
  for (const Vec2& point : wake_)
    dot(point, Layer::wake);
  if (goal_) {
    for (int i = -3; i <= 3; ++i) {
      dot(*goal_ + Vec2(i * scale, i * scale), Layer::goal);
      dot(*goal_ + Vec2(i * scale, -i * scale), Layer::goal);
    }
  }
  const double radius = std::max(radius_, 2 * scale);
  const int around = static_cast<int>(4 * kPi * radius / scale);
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * kPi * i / around;
    dot(robot_.position() + radius * Vec2(std::cos(angle), std::sin(angle)), Layer::robot);
  }
  for (int i = 0; i * scale < 2 * radius; ++i)
    dot(robot_.position() + i * scale * robot_.direction(), Layer::robot);
  return canvas.lines(utf8);
}

}  // namespace saphira::cli
