#include "browser.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <thread>
#include <vector>

namespace saphira::console {

namespace {

using Json = nlohmann::json;

constexpr std::chrono::seconds kPatience{20};
constexpr std::chrono::milliseconds kLook{100};

std::string find_browser() {
  const char* const path = std::getenv("PATH");
  std::string folders = path == nullptr ? "/usr/bin" : path;
  for (std::size_t begin = 0; begin <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
      if (const std::string file = folders.substr(begin, end - begin) + "/" + name;
          access(file.c_str(), X_OK) == 0)
        return file;
    begin = end + 1;
  }
  throw std::runtime_error("a picture needs Chromium: apt-get install chromium");
}

}  // namespace

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

void Browser::open(int width, int height, bool telephone) {
  session_.clear();
  const Json target = call("Target.createTarget", {{"url", "about:blank"}});
  const Json attached =
      call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}});
  session_ = attached.at("sessionId").get<std::string>();
  call("Emulation.setDeviceMetricsOverride", {{"width", width},
                                              {"height", height},
                                              {"deviceScaleFactor", telephone ? 2 : 1},
                                              {"mobile", telephone}});
}

void Browser::go(const std::string& address) {
  call("Page.navigate", {{"url", address}});
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

bool Browser::wait(const std::string& expression) {
  const auto end = Clock::now() + kPatience;
  while (value(expression) != true) {
    if (Clock::now() > end)
      return false;
    std::this_thread::sleep_for(kLook);
  }
  return true;
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

}  // namespace saphira::console
