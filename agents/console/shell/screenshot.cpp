#include "screenshot.hpp"

#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "browser.hpp"
#include "saphira/base/base64.hpp"
#include "saphira/base/text.hpp"

namespace saphira::console {

namespace {

constexpr std::chrono::milliseconds kSettle{1500};  // echoes and grid come

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
  const auto bytes = from_base64(picture.at("data").get<std::string>());
  if (!bytes)
    throw std::runtime_error("the browser's picture cannot be read");
  std::ofstream out(options.file, std::ios::binary);
  out << *bytes;
  if (!out.flush())
    throw UnusableFile(cannot_be(options.file, "written"));
}

}  // namespace saphira::console
