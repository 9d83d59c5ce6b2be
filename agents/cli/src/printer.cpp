#include "saphira/cli/printer.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <mutex>
#include <thread>
#include <utility>

#include "saphira/base/output.hpp"
#include "saphira/base/text.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLastMoment{1000};  // for the last output of a program

/// 0: all is written; otherwise an errno.
int write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::write(fd, text.data(), text.size());
    if (n > 0) {
      text.remove_prefix(static_cast<std::size_t>(n));
    } else if (n < 0 && errno == EAGAIN) {
      // Another process made it non-blocking, as some shells do.
      pollfd ready{fd, POLLOUT, 0};
      ::poll(&ready, 1, -1);
    } else if (n < 0 && errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

std::string formatted(const char* format, std::va_list arguments) {
  std::va_list again;
  va_copy(again, arguments);
  const int size = std::vsnprintf(nullptr, 0, format, arguments);
  std::string text(static_cast<std::size_t>(size < 0 ? 0 : size) + 1, '\0');
  std::vsnprintf(text.data(), text.size(), format, again);
  va_end(again);
  text.pop_back();
  return text;
}

}  // namespace

struct Printer::Shared {
  int fd;
  std::size_t room;
  std::mutex mutex;
  std::condition_variable changed;
  std::string lines;
  std::string picture;
  std::size_t left_out = 0;  ///< texts
  bool outlasts = false;
  bool printing = false;
  bool closed = false;
  std::string trouble;
  bool end = false;
};

Printer::Printer(int fd, std::size_t room) : shared_(std::make_shared<Shared>()) {
  shared_->fd = fd;
  shared_->room = room;
  // Signals belong to the waiting thread.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread([shared = shared_] { run(shared); }).detach();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Printer::~Printer() {
  const std::lock_guard lock(shared_->mutex);
  shared_->end = true;
  shared_->changed.notify_all();
}

void Printer::run(const std::shared_ptr<Shared>& shared) {
  std::unique_lock lock(shared->mutex);
  while (true) {
    shared->changed.wait(
        lock, [&] { return shared->end || !shared->lines.empty() || !shared->picture.empty(); });
    if (shared->end)
      return;
    std::string text = std::exchange(shared->lines, {});
    if (shared->left_out > 0)
      text += "(left out, as nobody read or the disk was full: " +
              counted(std::exchange(shared->left_out, 0), "message") + ")\n";
    text += std::exchange(shared->picture, {});
    shared->printing = true;
    lock.unlock();
    const int why = write_all(shared->fd, text);
    lock.lock();
    shared->printing = false;
    if ((why == ENOSPC || why == EDQUOT) && shared->outlasts) {
      shared->left_out += static_cast<std::size_t>(std::ranges::count(text, '\n'));
    } else if (why != 0) {
      shared->closed = true;
      shared->trouble = output_trouble(shared->fd, why);
    }
    shared->changed.notify_all();
  }
}

void Printer::print(std::string_view text) {
  const std::lock_guard lock(shared_->mutex);
  if (shared_->closed)
    return;
  if (shared_->lines.size() + text.size() > shared_->room)
    ++shared_->left_out;
  else
    shared_->lines += text;
  shared_->changed.notify_all();
}

void Printer::outlast_full_disk() {
  const std::lock_guard lock(shared_->mutex);
  shared_->outlasts = true;
}

void Printer::show(std::string_view picture) {
  const std::lock_guard lock(shared_->mutex);
  if (shared_->closed)
    return;
  shared_->picture = picture;
  shared_->changed.notify_all();
}

bool Printer::flush(milliseconds limit) {
  std::unique_lock lock(shared_->mutex);
  return shared_->changed.wait_for(lock, limit, [&] {
    return shared_->closed ||
           (!shared_->printing && shared_->lines.empty() && shared_->picture.empty());
  });
}

bool Printer::closed() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->closed;
}

std::string Printer::trouble() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->trouble;
}

// Never destroyed: the threads of both live as long as the process.
Printer& out() {
  static auto* const printer = new Printer(STDOUT_FILENO);
  return *printer;
}

Printer& err() {
  static auto* const printer = new Printer(STDERR_FILENO);
  return *printer;
}

void print(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  out().print(formatted(format, arguments));
  va_end(arguments);
}

void complain(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  err().print(formatted(format, arguments));
  va_end(arguments);
}

void flush_output() {
  out().flush(kLastMoment);
  err().flush(kLastMoment);
}

}  // namespace saphira::cli
