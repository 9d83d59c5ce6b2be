#pragma once

#include <string>

namespace saphira::console {

struct ScreenshotOptions {
  std::string file;  ///< PNG; empty: none
  int width = 1280;
  int height = 800;
  bool dark = false;
  bool narrow = false;        ///< in a telephone's layout
  std::string tab = "Goals";  ///< the open view
};

/// A picture of the page, by Chromium without a display (its DevTools protocol over pipes).
/// std::runtime_error gives the missing part.
void make_screenshot(const std::string& address, const ScreenshotOptions& options);

}  // namespace saphira::console
