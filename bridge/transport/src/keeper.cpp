#include "saphira/transport/keeper.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "saphira/base/boot_clock.hpp"

namespace saphira::transport {

namespace {

using Clock = BootClock;
using std::chrono::milliseconds;

constexpr milliseconds kRepeat{100};  // the manual's most frequent command (5.2)

void say(const char* text) {
  // Nothing can be done where stderr is gone or nobody reads it; the robot matters more.
  pollfd ready{STDERR_FILENO, POLLOUT, 0};
  if (::poll(&ready, 1, 0) == 1 && (ready.revents & POLLOUT) != 0) [[maybe_unused]]
    const ssize_t n = ::write(STDERR_FILENO, text, std::strlen(text));
}

/// Writes to the robot, whatever kind of line it is, without waiting long for it.
void write_stop(int fd, std::span<const std::uint8_t> stop) {
  std::size_t done = 0;
  for (int tries = 0; done < stop.size() && tries < 5; ++tries) {
    const ssize_t n = ::write(fd, stop.data() + done, stop.size() - done);
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (n < 0 && errno == EAGAIN) {
      pollfd ready{fd, POLLOUT, 0};
      ::poll(&ready, 1, 20);
    } else if (n < 0 && errno != EINTR) {
      return;
    }
  }
}

/// One message: a word, and with 'W' a descriptor. 0 at the end of the bridge.
char receive(int socket, int& passed) {
  char word = 0;
  iovec part{&word, 1};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))];
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  passed = -1;
  ssize_t n = 0;
  do
    n = ::recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
  while (n < 0 && errno == EINTR);
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); n > 0 && c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SCM_RIGHTS)
      std::memcpy(&passed, CMSG_DATA(c), sizeof passed);
  }
  return n > 0 ? word : '\0';
}

[[noreturn]] void keep(int socket, const std::vector<std::uint8_t>& stop, milliseconds silence) {
  // It outlives what ends the bridge: the signals of the terminal are for the bridge, whose end is
  // heard on the socket.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGQUIT, SIGPIPE, SIGUSR1, SIGUSR2})
    ::signal(signal, SIG_IGN);
  ::prctl(PR_SET_NAME, "saphira-keeper");
  ::prctl(PR_SET_PDEATHSIG, 0);
  int robot = -1;
  bool acting = false;
  auto heard = Clock::now();
  while (true) {
    pollfd ready{socket, POLLIN, 0};
    int timeout = -1;
    if (robot >= 0) {
      const auto left = std::chrono::duration_cast<milliseconds>(heard + silence - Clock::now());
      timeout = acting ? static_cast<int>(kRepeat.count())
                       : std::max(0, static_cast<int>(left.count()) + 1);
    }
    const int n = ::poll(&ready, 1, timeout);
    if (n < 0 && errno == EINTR)
      continue;
    if (n > 0) {
      int passed = -1;
      const char word = receive(socket, passed);
      if (word == '\0') {
        if (robot >= 0) {
          write_stop(robot, stop);
          write_stop(robot, stop);  // once for a line that was cut within a packet
          say("saphira-bridge keeper: the bridge is gone; the robot is stopped\n");
        }
        ::_exit(0);
      }
      if (word == 'W' || word == 'U') {
        if (robot >= 0)
          ::close(robot);
        robot = passed;
      }
      heard = Clock::now();
      if (acting)
        say("saphira-bridge keeper: the bridge is back\n");
      acting = false;
      continue;
    }
    if (robot >= 0 && Clock::now() - heard >= silence) {
      write_stop(robot, stop);
      if (!std::exchange(acting, true))
        say("saphira-bridge keeper: the bridge is silent; the robot is stopped\n");
    }
  }
}

}  // namespace

Keeper::Keeper(const std::vector<std::uint8_t>& stop, std::chrono::milliseconds silence) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
    throw std::runtime_error(std::string("keeper: no socket pair: ") + std::strerror(errno));
  pid_ = ::fork();
  if (pid_ < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw std::runtime_error(std::string("keeper: no second process: ") + std::strerror(errno));
  }
  if (pid_ == 0) {
    // Whatever else is open belongs to the bridge: a pipe that the keeper held would never end.
    const int kept = ::fcntl(ends[1], F_DUPFD_CLOEXEC, 3);
    for (int fd = 0; fd < 1024; ++fd) {
      if (fd != kept && fd != STDERR_FILENO)
        ::close(fd);
    }
    keep(kept, stop, silence);
  }
  ::close(ends[1]);
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  socket_ = ends[0];
  alive_ = true;
}

Keeper::~Keeper() {
  ::close(socket_);
  int status = 0;
  ::waitpid(pid_, &status, 0);
}

bool Keeper::send(char word, int fd) {
  iovec part{&word, 1};
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
  // A full queue means that the keeper is stopped; it is told later.
  if (errno != EAGAIN && errno != EINTR)
    alive_ = false;
  return false;
}

void Keeper::watch(int fd) {
  watched_ = fd;
  told_ = alive_ && send('W', fd);
}

void Keeper::unwatch() {
  watched_ = -1;
  told_ = alive_ && send('U', -1);
}

void Keeper::beat() {
  if (!alive_)
    return;
  if (!told_)
    told_ = send(watched_ >= 0 ? 'W' : 'U', watched_);
  else
    send('B', -1);
}

}  // namespace saphira::transport
