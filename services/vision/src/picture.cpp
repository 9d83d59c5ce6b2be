#include "saphira/vision/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::vision {
namespace {

constexpr std::size_t kLongestHeader = 512;
constexpr int kLargest = 4096;  // [pixels] a side
constexpr std::string_view kComment = "# saphira stereo ";
const char* const kSource = "stereo pictures";

[[noreturn]] void wrong(const std::string& expected) {
  throw FileError(kSource, 1, 1, expected);
}

template <class T>
T number(std::string_view text, const std::string& what) {
  const auto value = number_in<T>(text);
  if (!value)
    wrong("expected a number for " + what + ", found \"" + std::string(text) + "\"");
  return *value;
}

void read_comment(std::string_view comment, StereoPicture& picture) {
  const std::array<std::pair<std::string_view, double*>, 5> members{{
      {"focal", &picture.rig.focal},
      {"baseline", &picture.rig.baseline},
      {"height", &picture.rig.height},
      {"forward", &picture.rig.forward},
      {"pan", &picture.rig.pan},
  }};
  while (!comment.empty()) {
    const std::size_t blank = std::min(comment.find(' '), comment.size());
    const std::string_view word = comment.substr(0, blank);
    comment.remove_prefix(std::min(blank + 1, comment.size()));
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos)
      continue;
    const std::string_view name = word.substr(0, equals);
    const std::string_view value = word.substr(equals + 1);
    if (name == "cycle")
      picture.cycle = number<std::uint64_t>(value, "cycle");
    for (const auto& [each, member] : members)
      if (name == each)
        *member = number<double>(value, std::string(name));
  }
}

}  // namespace

void PictureStream::feed(std::string_view bytes) {
  waiting_ += bytes;
}

std::optional<StereoPicture> PictureStream::take() {
  // P5, the comment, the size, the largest value: a line each.
  std::array<std::string_view, 4> lines;
  std::size_t at = 0;
  for (std::string_view& line : lines) {
    const std::size_t end = waiting_.find('\n', at);
    if (end == std::string::npos) {
      if (waiting_.size() > kLongestHeader ||
          !std::string_view("P5\n").starts_with(std::string_view(waiting_).substr(0, 3)))
        wrong("expected a PGM file (P5)");
      return std::nullopt;
    }
    line = std::string_view(waiting_).substr(at, end - at);
    at = end + 1;
  }
  if (lines[0] != "P5" || !lines[1].starts_with(kComment) || lines[3] != "255")
    wrong("expected P5, a comment \"# saphira stereo cycle=...\", the size, and 255");
  StereoPicture picture;
  read_comment(lines[1].substr(kComment.size()), picture);
  const std::size_t blank = std::min(lines[2].find(' '), lines[2].size() - 1);
  const int columns = number<int>(lines[2].substr(0, blank), "the columns");
  picture.rows = number<int>(lines[2].substr(blank + 1), "the rows");
  if (columns < 2 || columns > kLargest || picture.rows < 1 || picture.rows > kLargest ||
      columns % 2 != 0)
    wrong("expected two pictures side by side, found a size of " + std::string(lines[2]));
  if (!(picture.rig.focal > 0.0) || !(picture.rig.baseline > 0.0) || !(picture.rig.height > 0.0))
    wrong("expected focal, baseline and height above 0");
  if (!std::isfinite(picture.rig.forward) || !(std::abs(picture.rig.pan) <= kPi))
    wrong("expected a number of meters for forward, and a pan of -pi to pi");
  picture.columns = columns / 2;
  const std::size_t size =
      static_cast<std::size_t>(columns) * static_cast<std::size_t>(picture.rows);
  if (waiting_.size() - at < size)
    return std::nullopt;
  picture.pixels.assign(waiting_.begin() + static_cast<std::ptrdiff_t>(at),
                        waiting_.begin() + static_cast<std::ptrdiff_t>(at + size));
  waiting_.erase(0, at + size);
  return picture;
}

}  // namespace saphira::vision
