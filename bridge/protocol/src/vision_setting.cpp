#include "saphira/protocol/vision_setting.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "saphira/base/numbers.hpp"

namespace saphira::protocol {
namespace {

using What = VisionSetting::What;

constexpr int kMostRows = 1000;
constexpr std::size_t kLongestColor = 40;

constexpr std::array<std::pair<const char*, What>, 4> kLines{
    {{"line_bottom_row", What::bottom_row},
     {"line_num_slices", What::slices},
     {"line_slice_size", What::slice_size},
     {"line_min_mass", What::minimum_mass}}};

bool is_color(const std::string& name) {
  return !name.empty() && name.size() <= kLongestColor && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '#';
  });
}

std::optional<VisionSetting> setting_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    return std::nullopt;
  const std::string name = text.substr(0, equals), given = text.substr(equals + 1);
  const auto value = number_in<int>(given);
  const std::string kind = name.size() > 9 && name.starts_with("pioneer_") ? name.substr(9) : "";
  if (kind.empty()) {
    for (const auto& [known, what] : kLines)
      if (name == known && value && *value >= (what == What::slice_size ? 1 : 0) &&
          *value <= kMostRows)
        return VisionSetting{what, 0, *value, {}};
    return std::nullopt;
  }
  const int channel = name[8] - 'a';
  if (channel < 0 || channel > 2)
    return std::nullopt;
  if (kind == "_mode" && value && *value >= 0 && *value <= 2)
    return VisionSetting{What::mode, channel, *value, {}};
  if (kind == "_color" && is_color(given))
    return VisionSetting{What::color, channel, 0, given};
  return std::nullopt;
}

}  // namespace

VisionSetting parse_vision_setting(const std::string& text) {
  if (auto setting = setting_of(text))
    return *std::move(setting);
  throw std::invalid_argument(
      "expected pioneer_X_mode=N (X: a, b or c; N: 0 blob, 1 line, 2 blob with box), "
      "pioneer_X_color=NAME, or line_bottom_row, line_num_slices, line_slice_size or "
      "line_min_mass =N, found \"" +
      text + "\"");
}

}  // namespace saphira::protocol
