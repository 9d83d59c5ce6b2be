// The keeper's own process.
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "saphira/base/boot_clock.hpp"
#include "saphira/transport/keeper.hpp"

namespace saphira::transport {

namespace {

using Clock = BootClock;
using std::chrono::milliseconds;

constexpr milliseconds kRepeat{100};  // the manual's most frequent command (5.2)

void say(const char* text) {
  // Without a reader of stderr the message is dropped; the robot matters more.
  pollfd ready{STDERR_FILENO, POLLOUT, 0};
  if (::poll(&ready, 1, 0) == 1 && (ready.revents & POLLOUT) != 0) [[maybe_unused]]
    const ssize_t n = ::write(STDERR_FILENO, text, std::strlen(text));
}

/// Writes to the robot, over any kind of line, without a long wait.
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

constexpr std::size_t kMostBytes = 64;  // of the stop packets

struct Message {
  char word =
      '\0';        ///< 'W': watch a robot, 'U': none, 'B': the heart beats; 0: the bridge has ended
  int robot = -1;  ///< the descriptor that came with 'W'
  std::vector<std::uint8_t> stop;  ///< likewise
};

Message receive(int socket) {
  std::array<std::uint8_t, 1 + kMostBytes> buffer{};
  iovec part{buffer.data(), buffer.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))];
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  Message out;
  ssize_t n = 0;
  do
    n = ::recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
  while (n < 0 && errno == EINTR);
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); n > 0 && c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SCM_RIGHTS)
      std::memcpy(&out.robot, CMSG_DATA(c), sizeof out.robot);
  }
  if (n > 0) {
    out.word = static_cast<char>(buffer[0]);
    out.stop.assign(buffer.begin() + 1, buffer.begin() + n);
  }
  return out;
}

/// Shows the bridge that the keeper is alive. An answer that does not fit into the queue is
/// dropped.
void answer(int socket) {
  const char word = 'b';
  [[maybe_unused]] const ssize_t n = ::send(socket, &word, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace

void keep(int socket, milliseconds silence) {
  // The keeper outlives the signals of the terminal, which are for the bridge. It sees the bridge's
  // end on the socket.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGQUIT, SIGPIPE, SIGUSR1, SIGUSR2})
    ::signal(signal, SIG_IGN);
  int robot = -1;
  std::vector<std::uint8_t> stop;
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
      Message message = receive(socket);
      if (message.word == '\0') {
        if (robot >= 0) {
          write_stop(robot, stop);
          write_stop(robot, stop);  // a first time, for a line that was cut within a packet
          say("saphira-bridge keeper: the bridge is gone; the robot is stopped\n");
        }
        ::_exit(0);
      }
      if (message.word == 'W' || message.word == 'U') {
        if (robot >= 0)
          ::close(robot);
        robot = message.robot;
        stop = std::move(message.stop);
      }
      heard = Clock::now();
      if (message.word == 'B')
        answer(socket);
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

}  // namespace saphira::transport
