#include "screenshot.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "saphira/base/base64.hpp"
#include "saphira/base/text.hpp"

namespace saphira::console {

namespace {

using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{20};
constexpr std::chrono::milliseconds kPollPeriod{100};
constexpr std::chrono::milliseconds kSettle{1500};  // echoes and grid come

std::string find_browser() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    for (const char* name : {"/chromium", "/chromium-browser", "/google-chrome"})
      if (access((folder + name).c_str(), X_OK) == 0)
        return folder + name;
  throw std::runtime_error("a picture needs Chromium: apt-get install chromium");
}

/// A running Chromium without a display, controlled by its DevTools protocol: JSON texts that end
/// with a zero byte, on its descriptors 3 and 4.
class Browser {
 public:
  Browser();
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  Json call(const std::string& method, const Json& parameters);
  /// The following commands are for the page of that target.
  void attach(const Json& target) {
    session_ =
        call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}})
            .at("sessionId");
  }
  /// The value of a JavaScript expression in the page.
  Json value(const std::string& expression);

 private:
  std::string read_text(Clock::time_point end);

  std::string folder_;
  std::string session_;
  std::string received_;
  pid_t pid_ = -1;
  int to_ = -1;
  int from_ = -1;
  int id_ = 0;
};

Browser::Browser() {
  const std::string program = find_browser();
  signal(SIGPIPE, SIG_IGN);  // write reports an ended browser
  char name[] = "/tmp/saphira-browser-XXXXXX";
  if (mkdtemp(name) == nullptr)
    throw std::runtime_error("no temporary folder for the browser");
  folder_ = name;
  std::array<int, 2> commands{};
  std::array<int, 2> answers{};
  if (pipe2(commands.data(), O_CLOEXEC) != 0 || pipe2(answers.data(), O_CLOEXEC) != 0)
    throw std::runtime_error("no pipes for the browser");
  to_ = commands[1];
  from_ = answers[0];
  const std::string data = "--user-data-dir=" + folder_;
  std::vector<const char*> argv{
      program.c_str(), "--headless=new",    "--remote-debugging-pipe", "--no-first-run",
      "--disable-gpu", "--hide-scrollbars", "--disable-dev-shm-usage", data.c_str()};
  if (geteuid() == 0)
    argv.push_back("--no-sandbox");  // Chromium's own sandbox does not work for root
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    // Above 4 first, since the pipes may be 3 and 4 themselves.
    const int in = fcntl(commands[0], F_DUPFD, 10);
    const int out = fcntl(answers[1], F_DUPFD, 10);
    const int null = ::open("/dev/null", O_RDWR);
    dup2(in, 3);
    dup2(out, 4);
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
    execv(program.c_str(), const_cast<char* const*>(argv.data()));
    _exit(127);
  }
  close(commands[0]);
  close(answers[1]);
}

Browser::~Browser() {
  close(to_);
  close(from_);
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

Json Browser::call(const std::string& method, const Json& parameters) {
  Json command{{"id", ++id_}, {"method", method}, {"params", parameters}};
  if (!session_.empty())
    command["sessionId"] = session_;
  const std::string text = command.dump();
  if (write(to_, text.c_str(), text.size() + 1) != static_cast<ssize_t>(text.size() + 1))
    throw std::runtime_error("the browser takes no commands");
  const auto end = Clock::now() + kPatience;
  while (Clock::now() < end) {
    const Json answer = Json::parse(read_text(end), nullptr, false);
    if (!answer.is_object() || answer.value("id", 0) != id_)
      continue;  // an event
    if (answer.contains("error"))
      throw std::runtime_error("the browser refuses " + method + ": " + answer["error"].dump());
    return answer.value("result", Json::object());
  }
  throw std::runtime_error("the browser does not answer");
}

Json Browser::value(const std::string& expression) {
  const Json result =
      call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}});
  const auto found = result.find("result");
  return found == result.end() ? Json() : found->value("value", Json());
}

std::string Browser::read_text(Clock::time_point end) {
  std::size_t zero = 0;
  while ((zero = received_.find('\0')) == std::string::npos) {
    pollfd readable{from_, POLLIN, 0};
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    std::array<char, 65536> buffer{};
    const ssize_t size = poll(&readable, 1, static_cast<int>(std::max<long>(0, left.count()))) > 0
                             ? read(from_, buffer.data(), buffer.size())
                             : 0;
    if (size <= 0)
      throw std::runtime_error("the browser has ended, or says nothing");
    received_.append(buffer.data(), static_cast<std::size_t>(size));
  }
  const std::string text = received_.substr(0, zero);
  received_.erase(0, zero + 1);
  return text;
}

}  // namespace

void make_screenshot(const std::string& address, const ScreenshotOptions& options) {
  Browser browser;
  browser.attach(browser.call("Target.createTarget", {{"url", "about:blank"}}));
  browser.call("Emulation.setDeviceMetricsOverride",
               {{"width", options.narrow ? 390 : options.width},
                {"height", options.narrow ? 844 : options.height},
                {"deviceScaleFactor", options.narrow ? 2 : 1},
                {"mobile", options.narrow}});
  browser.call(
      "Emulation.setEmulatedMedia",
      {{"features",
        {{{"name", "prefers-color-scheme"}, {"value", options.dark ? "dark" : "light"}}}}});
  browser.call("Page.navigate", {{"url", address}});
  const auto end = Clock::now() + kPatience;
  while (browser.value("!!document.querySelector('.link.live')") != true) {
    if (Clock::now() > end)
      throw std::runtime_error("the page shows no robot: is one on the bus? (saphira status)");
    std::this_thread::sleep_for(kPollPeriod);
  }
  browser.value("document.getElementById('tab-" + options.tab + "').click()");
  std::this_thread::sleep_for(kSettle);
  const Json picture = browser.call("Page.captureScreenshot", {{"format", "png"}});
  const auto bytes = from_base64(picture.at("data").get<std::string>());
  if (!bytes)
    throw std::runtime_error("the browser's picture cannot be read");
  std::ofstream out(options.file, std::ios::binary);
  out << *bytes;
  if (!out.flush())
    throw UnusableFile(cannot_be(options.file, "written"));
}

}  // namespace saphira::console
