#include "screenshot.hpp"

#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "browser.hpp"

namespace saphira::console {

namespace {

constexpr std::chrono::milliseconds kSettle{1500};  // echoes and grid come

std::string decode_base64(const std::string& text) {
  static const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned value = 0;
  int bits = 0;
  for (const char c : text) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos)
      break;
    value = (value << 6U | static_cast<unsigned>(digit)) & 0xffffffU;
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += static_cast<char>(value >> static_cast<unsigned>(bits) & 0xffU);
    }
  }
  return bytes;
}

}  // namespace

void make_screenshot(const std::string& address, const ScreenshotOptions& options) {
  Browser browser;
  browser.open(options.narrow ? 390 : options.width, options.narrow ? 844 : options.height,
               options.narrow);
  browser.call(
      "Emulation.setEmulatedMedia",
      {{"features",
        {{{"name", "prefers-color-scheme"}, {"value", options.dark ? "dark" : "light"}}}}});
  browser.go(address);
  if (!browser.wait("!!document.querySelector('.link.live')"))
    throw std::runtime_error("the page shows no robot: is one on the bus? (saphira status)");
  browser.value("document.getElementById('tab-" + options.tab + "').click()");
  std::this_thread::sleep_for(kSettle);
  const nlohmann::json picture = browser.call("Page.captureScreenshot", {{"format", "png"}});
  std::ofstream out(options.file, std::ios::binary);
  out << decode_base64(picture.at("data").get<std::string>());
  if (!out.flush())
    throw std::runtime_error(options.file + ": cannot be written");
}

}  // namespace saphira::console
