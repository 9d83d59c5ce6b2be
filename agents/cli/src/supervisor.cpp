#include "saphira/cli/supervisor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "saphira/base/text.hpp"

extern "C" char** environ;

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kTakenIn{2000};  // run of a new version before the next one
constexpr milliseconds kFirstBackoff{100};
constexpr milliseconds kLastBackoff{5000};
/// Between two checks for hanging children.
constexpr milliseconds kWatch{1000};
constexpr std::size_t kLongestLine = 4096;  ///< longer ones are broken up
constexpr const char* kHandedOver = "children 1";

bool is_crash(int status) {
  if (!WIFSIGNALED(status))
    return false;
  const int by = WTERMSIG(status);
  return by == SIGSEGV || by == SIGABRT || by == SIGBUS || by == SIGFPE || by == SIGILL;
}

std::string describe_end(int status) {
  if (WIFEXITED(status))
    return "exit code " + std::to_string(WEXITSTATUS(status));
  const int number = WTERMSIG(status);
  const char* name = sigabbrev_np(number);
  return "killed by SIG" + std::string(name == nullptr ? std::to_string(number).c_str() : name);
}

milliseconds until(Supervisor::Clock::time_point when) {
  return std::max(milliseconds(0),
                  std::chrono::ceil<milliseconds>(when - Supervisor::Clock::now()));
}

std::vector<std::string> robots_of(const std::vector<ChildSpec>& children) {
  std::vector<std::string> robots;
  for (const ChildSpec& child : children)
    robots.push_back(child.robot);
  return robots;
}

/// Both ends of a pipe, closed with the object unless they are taken.
class Pipe {
 public:
  explicit Pipe(const std::string& child) {
    if (pipe2(ends_, O_CLOEXEC | O_NONBLOCK) != 0)
      throw std::runtime_error(child + " cannot be started, no pipe: " + strerror(errno));
  }
  ~Pipe() {
    for (const int end : ends_)
      if (end >= 0)
        close(end);
  }
  Pipe& operator=(Pipe&&) = delete;

  int out() const { return ends_[1]; }
  int take_in() { return std::exchange(ends_[0], -1); }
  /// The name of the writing end, for the child.
  std::string name() const {
    struct stat info {};
    fstat(ends_[1], &info);
    return std::to_string(ends_[1]) + ":" + std::to_string(info.st_ino);
  }

 private:
  int ends_[2] = {-1, -1};
};

}  // namespace

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> all;
  all.reserve(words.size() + 1);
  for (std::string& word : words)
    all.push_back(word.data());
  all.push_back(nullptr);
  return all;
}

std::vector<std::string> merged_environment(const std::map<std::string, std::string>& added) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    if (!added.contains(text.substr(0, text.find('='))))
      all.push_back(text);
  }
  for (const auto& [name, value] : added)
    all.emplace_back(name).append("=").append(value);
  return all;
}

std::string file_of(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0)
    return {};
  return std::to_string(info.st_dev) + ":" + std::to_string(info.st_ino) + ":" +
         std::to_string(info.st_mtim.tv_sec) + "." + std::to_string(info.st_mtim.tv_nsec);
}

Supervisor::Supervisor(std::vector<ChildSpec> children, Print print, milliseconds proven)
    : print_(std::move(print)), proven_(proven), watchdog_(robots_of(children)) {
  for (ChildSpec& spec : children) {
    slots_.emplace_back();
    slots_.back().spec = std::move(spec);
  }
}

Supervisor::~Supervisor() {
  stop();
  for (const Stream& stream : streams_)
    close(stream.fd);
  for (const Slot& slot : slots_)
    if (slot.beats >= 0)
      close(slot.beats);
}

void Supervisor::start() {
  for (std::size_t i = 0; i < slots_.size(); ++i)
    launch(i);
}

void Supervisor::launch(std::size_t index) {
  Slot& slot = slots_[index];
  // Everything that allocates comes before the fork: another thread may hold the heap's lock.
  std::map<std::string, std::string> added = slot.spec.environment;
  Pipe beats(slot.spec.name);
  added[kHeartbeatVariable] = beats.name();
  added[kRestartedVariable] = slot.trouble;
  std::vector<std::string> environment = merged_environment(added);
  const std::vector<char*> argv = pointers(slot.spec.argv);
  const std::vector<char*> env = pointers(environment);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error(slot.spec.name + " cannot be started, no pipe: " + strerror(errno));
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0) {
    close(ends[0]);
    close(ends[1]);
    throw std::runtime_error(slot.spec.name + " cannot be started: " + strerror(errno));
  }
  if (pid == 0) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent)
      _exit(127);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGINT, SIG_DFL);
    const int null = open("/dev/null", O_RDONLY);
    dup2(null, STDIN_FILENO);
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    fcntl(beats.out(), F_SETFD, 0);
    execve(argv[0], argv.data(), env.data());
    const char* why = strerrordesc_np(errno);
    for (const char* text : {"cannot run ", static_cast<const char*>(argv[0]), ": ", why, "\n"})
      if (write(STDERR_FILENO, text, strlen(text)) < 0)
        break;
    _exit(127);
  }
  close(ends[1]);
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  streams_.push_back({ends[0], index, {}});
  if (slot.beats >= 0)
    close(slot.beats);
  slot.beats = beats.take_in();
  slot.trouble.clear();
  watchdog_.forget(index);
  slot.pid = pid;
  slot.pid_fd = static_cast<int>(syscall(SYS_pidfd_open, pid, 0));
  slot.started = Clock::now();
  slot.file = file_of(slot.spec.argv[0]);
  slot.due.reset();
  if (++slot.starts > 1)
    say(slot.spec.name + " started again (pid " + std::to_string(pid) + ")");
}

std::string Supervisor::hand_over() const {
  std::string text = kHandedOver;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const Slot& slot = slots_[i];
    if (slot.pid == 0)
      continue;
    fcntl(slot.beats, F_SETFD, 0);
    int output = -1;
    for (const Stream& stream : streams_)
      if (stream.slot == i) {
        output = stream.fd;  // the newest one
        fcntl(output, F_SETFD, 0);
      }
    text += "\n" + slot.spec.name + " " + std::to_string(slot.pid) + " " +
            std::to_string(slot.starts) + " " + std::to_string(output) + " " +
            std::to_string(slot.beats) + " " + slot.file;
  }
  return text + "\n";
}

void Supervisor::take_over(const std::string& children) {
  std::istringstream in(children);
  std::string line;
  if (!std::getline(in, line) || line != kHandedOver)
    throw std::invalid_argument("the previous version has handed over another format");
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string name;
    std::string more;
    Slot taken;
    int output = -1;
    // No file: it was gone when the child was started.
    if (!(words >> name >> taken.pid >> taken.starts >> output >> taken.beats) ||
        !(words >> taken.file || words.eof()) || words >> more)
      throw std::invalid_argument(
          "the previous version has handed over another format: expected "
          "a name without blanks, four numbers and a file, found \"" +
          line + "\"");
    const auto slot = std::ranges::find_if(
        slots_, [&](const Slot& one) { return one.spec.name == name && one.pid == 0; });
    for (const int fd : {output, taken.beats})
      if (fd >= 0)
        fcntl(fd, F_SETFD, FD_CLOEXEC);
    if (slot == slots_.end()) {
      say(name + " is no more part of it");
      kill(taken.pid, SIGTERM);
      kill(taken.pid, SIGCONT);
      for (const int fd : {output, taken.beats})
        close(fd);
      continue;
    }
    taken.spec = std::move(slot->spec);
    taken.pid_fd = static_cast<int>(syscall(SYS_pidfd_open, taken.pid, 0));
    taken.started = Clock::now();
    *slot = taken;
    if (output >= 0)
      streams_.push_back({output, static_cast<std::size_t>(slot - slots_.begin()), {}});
  }
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].pid == 0)
      launch(i);
}

void Supervisor::step(milliseconds timeout, std::initializer_list<int> wake_fds) {
  for (const Slot& slot : slots_)
    if (slot.due)
      timeout = std::min(timeout, until(*slot.due));
  timeout = std::min(timeout, kWatch);
  const auto began = BootClock::now();
  poll_once(timeout, wake_fds);
  watch(BootClock::now() - began, timeout);
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].due && Clock::now() >= *slots_[i].due)
      launch_again(i);
  renew_next();
}

void Supervisor::renew(const std::function<std::string(const ChildSpec& child)>& objection) {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const Slot& slot = slots_[i];
    const std::string& program = slot.spec.argv[0];
    if (slot.pid == 0 || file_of(program) == slot.file ||
        std::ranges::find(to_renew_, i) != to_renew_.end())
      continue;
    const std::string why_not = objection(slot.spec);
    if (why_not.empty())
      to_renew_.push_back(i);
    else
      say(slot.spec.name + " stays as it is: " + why_not);
  }
  say(to_renew_.empty() ? "no program has a new version to take in"
                        : "new versions of " + counted(to_renew_.size(), "program") +
                              " are taken in, one after the other");
}

void Supervisor::renew_next() {
  if (renewing_) {
    const Slot& slot = slots_[*renewing_];
    if (slot.pid == 0 || slot.due || Clock::now() - slot.started < kTakenIn)
      return;
    renewing_.reset();
    if (to_renew_.empty())
      say("all new versions are taken in");
  }
  if (to_renew_.empty())
    return;
  const std::size_t next = to_renew_.front();
  to_renew_.erase(to_renew_.begin());
  if (slots_[next].pid == 0)
    return;
  renewing_ = next;
  slots_[next].started = Clock::now();  // its end now is no sign of a failure
  say(slots_[next].spec.name + ": a new version is taken in");
  kill(slots_[next].pid, SIGTERM);
  kill(slots_[next].pid, SIGCONT);
}

void Supervisor::read_beats(std::size_t index) {
  Heartbeat beat;
  while (slots_[index].beats >= 0 && read(slots_[index].beats, &beat, sizeof beat) == sizeof beat)
    watchdog_.hear(index, beat, Clock::now());
}

/// How long a thread of the child was ready and had no processor, since the last call. Whichever
/// thread that was, others may have waited for it.
std::chrono::nanoseconds Supervisor::starved(Slot& slot) {
  std::map<std::string, std::chrono::nanoseconds> waited;
  std::chrono::nanoseconds longest{0};
  std::error_code none;
  for (const auto& thread :
       std::filesystem::directory_iterator("/proc/" + std::to_string(slot.pid) + "/task", none)) {
    long long ran = 0;
    long long ready = 0;
    if (!(std::ifstream(thread.path() / "schedstat") >> ran >> ready))
      continue;
    const auto& now = waited[thread.path().filename()] = std::chrono::nanoseconds(ready);
    if (const auto before = slot.waited.find(thread.path().filename()); before != slot.waited.end())
      longest = std::max(longest, now - before->second);
  }
  slot.waited = std::move(waited);
  return longest;
}

void Supervisor::watch(BootClock::duration waited, milliseconds timeout) {
  for (std::size_t i = 0; i < slots_.size(); ++i)
    read_beats(i);
  if (waited > timeout + kWatch)
    watchdog_.slept(Clock::now());
  if (Clock::now() - judged_ < kWatch)
    return;
  judged_ = Clock::now();
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[i];
    if (slot.pid == 0 || !slot.spec.restart || !slot.trouble.empty())
      continue;
    watchdog_.starved(i, starved(slot), Clock::now());
    if (const auto trouble = watchdog_.trouble(i, Clock::now())) {
      slot.trouble = *trouble;
      say(slot.spec.name + ": " + *trouble + "; killed");
      kill(slot.pid, SIGKILL);
    }
  }
}

void Supervisor::launch_again(std::size_t index) {
  Slot& slot = slots_[index];
  try {
    launch(index);
  } catch (const std::exception& error) {
    // The machine lacks a process, descriptor or memory for it now: the others continue.
    const milliseconds delay = put_off(slot, false);
    say(std::string(error.what()) + "; tried again in " + std::to_string(delay.count()) + " ms");
  }
}

milliseconds Supervisor::put_off(Slot& slot, bool proven) {
  slot.backoff = proven || slot.backoff == milliseconds(0)
                     ? kFirstBackoff
                     : std::min(slot.backoff * 2, kLastBackoff);
  slot.due = Clock::now() + slot.backoff;
  return slot.backoff;
}

void Supervisor::poll_once(milliseconds timeout, std::initializer_list<int> wake_fds) {
  std::vector<pollfd> fds;
  for (const Stream& stream : streams_)
    fds.push_back({stream.fd, POLLIN, 0});
  for (const Slot& slot : slots_)
    fds.push_back({slot.pid_fd, POLLIN, 0});  // poll skips a negative one
  for (const int fd : wake_fds)
    fds.push_back({fd, POLLIN, 0});
  poll(fds.data(), fds.size(), static_cast<int>(timeout.count()));
  std::vector<Stream> open_streams;
  for (Stream& stream : streams_)
    if (read_stream(stream))
      open_streams.push_back(std::move(stream));
    else
      close(stream.fd);
  streams_ = std::move(open_streams);
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].pid != 0)
      reap(i);
}

bool Supervisor::read_stream(Stream& stream) {
  char buffer[4096];
  const std::string& name = slots_[stream.slot].spec.name;
  while (true) {
    const ssize_t n = read(stream.fd, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      return true;
    for (const char c : std::string_view(buffer, static_cast<std::size_t>(n))) {
      if (c != '\n')
        stream.line += c;
      if (c == '\n' || stream.line.size() >= kLongestLine) {
        print_(name, stream.line);
        stream.line.clear();
      }
    }
    if (n == 0) {
      if (!stream.line.empty())
        print_(name, std::exchange(stream.line, {}));
      return false;
    }
  }
}

void Supervisor::reap(std::size_t index) {
  Slot& slot = slots_[index];
  int status = 0;
  if (waitpid(slot.pid, &status, WNOHANG) != slot.pid)
    return;
  // Its last output is printed before the news of its end.
  for (Stream& stream : streams_)
    if (stream.slot == index)
      read_stream(stream);
  if (slot.pid_fd >= 0)
    close(slot.pid_fd);
  slot.pid_fd = -1;
  slot.pid = 0;
  slot.ended = describe_end(status);
  slot.crashed = slot.crashed || is_crash(status);
  if (stopping_)
    return;
  const bool proven = Clock::now() - slot.started >= proven_;
  slot.misused = WIFEXITED(status) && WEXITSTATUS(status) == 2 && slot.starts == 1 && !proven;
  if (!slot.spec.restart || slot.misused) {
    say(slot.spec.name + " ended: " + slot.ended);
    return;
  }
  const milliseconds delay = put_off(slot, proven);
  say(slot.spec.name + " ended: " + slot.ended + "; started again in " +
      std::to_string(delay.count()) + " ms");
}

void Supervisor::stop(milliseconds limit) {
  stopping_ = true;
  const Clock::time_point end = Clock::now() + limit;
  for (Slot& slot : slots_)
    slot.due.reset();
  const auto running = [](const Slot& slot) { return slot.pid != 0; };
  for (std::size_t i = slots_.size(); i-- > 0;) {
    if (slots_[i].pid == 0)
      continue;
    kill(slots_[i].pid, SIGTERM);
    kill(slots_[i].pid, SIGCONT);  // a stopped child gets the SIGTERM then
    // Each child has its share of the remaining time, so that a hanging one does not use up the
    // others'.
    const auto share = std::chrono::duration_cast<milliseconds>(until(end) / (i + 1));
    const Clock::time_point next = Clock::now() + share;
    while (slots_[i].pid != 0 && Clock::now() < next)
      poll_once(until(next));
  }
  while (std::ranges::any_of(slots_, running) && Clock::now() < end)
    poll_once(until(end));
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].pid == 0)
      continue;
    say(slots_[i].spec.name + " did not end in time: killed");
    kill(slots_[i].pid, SIGKILL);
    while (slots_[i].pid != 0)
      poll_once(milliseconds(100));
  }
}

std::vector<Supervisor::Child> Supervisor::children() const {
  std::vector<Child> all;
  for (const Slot& slot : slots_)
    all.push_back({slot.spec.name, slot.pid, slot.starts, slot.ended, slot.crashed});
  return all;
}

std::optional<std::string> Supervisor::misused() const {
  for (const Slot& slot : slots_)
    if (slot.misused)
      return slot.spec.name;
  return std::nullopt;
}

bool Supervisor::finished() const {
  return std::ranges::none_of(slots_, [](const Slot& slot) { return slot.pid != 0 || slot.due; });
}

}  // namespace saphira::cli
