#pragma once

#include <string>

namespace saphira::console {

struct ScreenshotOptions {
  std::string file;  ///< PNG; empty: none is made
  int width = 1280;
  int height = 800;
  bool dark = false;
  bool narrow = false;        ///< as a telephone has it
  std::string tab = "Goals";  ///< which view is open
};

/// A picture of the page, by Chromium without a display (its DevTools protocol over pipes).
/// std::runtime_error that says what is missing.
void make_screenshot(const std::string& address, const ScreenshotOptions& options);

}  // namespace saphira::console
