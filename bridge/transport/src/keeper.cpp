#include "saphira/transport/keeper.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "inherited.hpp"
#include "saphira/base/places.hpp"

namespace saphira::transport {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPause{1000};  // between two starts
constexpr int kUnanswered = 40;       // heartbeats: 2 s, by a keeper that is busy

}  // namespace

Keeper::Keeper(milliseconds silence, std::string program)
    : silence_(silence), program_(std::move(program)) {
  if (program_.empty())
    program_ = program_folder() + "/saphira-keeper";
  if (const std::string trouble = start(); !trouble.empty())
    throw std::runtime_error(trouble);
}

Keeper::~Keeper() {
  end();
}

std::string Keeper::start() {
  started_ = BootClock::now();
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return std::string("keeper: no socket pair: ") + std::strerror(errno);
  std::string silence = std::to_string(silence_.count());
  std::array<char*, 3> argv{program_.data(), silence.data(), nullptr};
  const Inherited inherited(ends[1], kKeeperSocket);
  const int error = ::posix_spawn(&pid_, program_.c_str(), &inherited.files, &inherited.attributes,
                                  argv.data(), environ);
  ::close(ends[1]);
  socket_ = ends[0];
  if (error != 0) {
    pid_ = -1;
    return "keeper: " + program_ + ": " + std::strerror(error);
  }
  ::fcntl(socket_, F_SETFL, O_NONBLOCK);
  alive_ = true;
  told_ = watched_ < 0;
  unanswered_ = 0;
  return {};
}

/// A keeper ends by itself when it does not hear the bridge any more, after stopping its robot; a
/// hanging one does not.
void Keeper::end() {
  socket_.reset();
  if (pid_ <= 0)
    return;
  if (!alive_)
    ::kill(pid_, SIGKILL);
  int status = 0;
  ::waitpid(std::exchange(pid_, -1), &status, 0);
  alive_ = false;
}

bool Keeper::send(char word, int fd, const std::vector<std::uint8_t>& rest) {
  std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(word)};
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  iovec part{bytes.data(), bytes.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  if (fd >= 0) {
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr* c = CMSG_FIRSTHDR(&message);
    c->cmsg_level = SOL_SOCKET;
    c->cmsg_type = SCM_RIGHTS;
    c->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(c), &fd, sizeof fd);
  }
  if (::sendmsg(socket_, &message, MSG_NOSIGNAL) >= 0)
    return true;
  // A full queue means that the keeper is stopped; it gets the message later.
  if (errno != EAGAIN && errno != EINTR)
    alive_ = false;
  return false;
}

void Keeper::watch(int fd, std::vector<std::uint8_t> stop) {
  watched_ = fd;
  stop_ = std::move(stop);
  told_ = alive_ && send('W', fd, stop_);
}

void Keeper::unwatch() {
  watched_ = -1;
  told_ = alive_ && send('U', -1);
}

void Keeper::hear() {
  std::array<char, 16> words{};
  while (alive_) {
    const ssize_t n = ::recv(socket_, words.data(), words.size(), MSG_DONTWAIT);
    if (n > 0) {
      unanswered_ = 0;
    } else if (n == 0) {
      alive_ = false;
    } else {
      if (errno != EAGAIN && errno != EINTR)
        alive_ = false;
      return;
    }
  }
}

void Keeper::beat() {
  hear();
  if (alive_ && unanswered_ >= kUnanswered)
    alive_ = false;  // it hangs
  if (!alive_) {
    if (BootClock::now() - started_ < kPause)
      return;
    end();
    if (!start().empty())
      return;
    ++restarts_;
  }
  if (!told_)
    told_ = watched_ >= 0 ? send('W', watched_, stop_) : send('U', -1);
  ++unanswered_;
  send('B', -1);
}

}  // namespace saphira::transport
