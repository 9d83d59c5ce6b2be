#include "saphira/bus/stop.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <system_error>

#include "saphira/command_line/command_line.hpp"

namespace saphira::bus {
namespace {

std::atomic<Stop*> signal_stop{nullptr};

// [s] for the end of a program after a signal, longer than any of its own limits. Fast DDS may
// hang.
constexpr unsigned kHardEnd = 30;

// Only calls that are allowed in a signal handler: an atomic, write(2), alarm(2) and _exit(2).
void on_signal(int /*signal*/) {
  const int saved = errno;
  if (Stop* stop = signal_stop.load())
    stop->request();
  alarm(kHardEnd);
  errno = saved;
}

void on_hard_end(int /*signal*/) {
  static constexpr char kText[] = "ended hard: the program did not end by itself after a signal\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kText, sizeof kText - 1);
  _exit(kExitBroken);
}

}  // namespace

Stop::Stop() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0)
    throw std::system_error(errno, std::generic_category(), "eventfd");
}

Stop::~Stop() {
  Stop* self = this;
  if (signal_stop.compare_exchange_strong(self, nullptr))
    alarm(0);
  close(fd_);
}

void Stop::request() {
  requested_.store(true, std::memory_order_release);
  const std::uint64_t one = 1;
  // Fails only where the counter is full, and then fd_ is readable already.
  [[maybe_unused]] const auto written = write(fd_, &one, sizeof one);
}

void stop_on_signals(Stop& stop) {
  signal_stop = &stop;
  struct sigaction end {};
  end.sa_handler = on_hard_end;
  sigemptyset(&end.sa_mask);
  sigaction(SIGALRM, &end, nullptr);
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // The terminal is gone; nohup asks to continue nevertheless.
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &action, nullptr);
}

}  // namespace saphira::bus
