#include "saphira/transport/link.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <thread>
#include <utility>

#include "baud.hpp"
#include "inherited.hpp"
#include "saphira/base/local_socket.hpp"
#include "saphira/base/places.hpp"

namespace saphira::transport {

namespace {

constexpr double kFirstBackoff = 0.05;  // [s]
constexpr double kLastBackoff = 0.5;    // [s]
constexpr int kLongestEnd = 100;        // [10 ms] of a program for ROS 2
constexpr double kNextProgram = 5.0;    // [s] after one that ended at its start
constexpr double kConnectTime = 3.0;    // [s] for a TCP connection to come about
// At 9600 baud these are 0.33 s: a command that waits longer is stale.
constexpr std::size_t kMaxWaiting = 320;
// Reserved for motion commands of the cycles meanwhile. The longest packet of a device, 207 bytes,
// fits into the rest.
constexpr std::size_t kForMotion = 64;

std::string error_text() {
  return std::strerror(errno);
}

/// Raw bytes; 8N1 without flow control is the manual's RS-232 link (5.4).
bool make_raw(int fd, const Address& address) {
  termios line{};
  if (tcgetattr(fd, &line) != 0)
    return false;
  cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS | PARENB | PARODD);
  if (address.parity != 'N')
    line.c_cflag |= PARENB;
  if (address.parity == 'O')
    line.c_cflag |= PARODD;
  if (address.stop_bits == 2)
    line.c_cflag |= CSTOPB;
  if (address.flow_control)
    line.c_cflag |= CRTSCTS;
  const auto speed = speed_of(address.baud);
  if (!speed || cfsetispeed(&line, *speed) != 0 || cfsetospeed(&line, *speed) != 0)
    return false;
  return tcsetattr(fd, TCSANOW, &line) == 0 && tcflush(fd, TCIOFLUSH) == 0;
}

/// The holder of the lock on a file, in words; from /proc/locks, lines such as
/// "1: FLOCK  ADVISORY  WRITE 1234 00:18:5 0 EOF".
std::string holder(int fd) {
  struct stat about {};
  ::fstat(fd, &about);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number;
    std::string kind;
    std::string mode;
    std::string access;
    std::string pid;
    std::string file;
    words >> number >> kind >> mode >> access >> pid >> file;
    if (kind != "FLOCK" || !file.ends_with(":" + std::to_string(about.st_ino)))
      continue;
    std::string name;
    std::getline(std::ifstream("/proc/" + pid + "/comm") >> std::ws, name);
    return "process " + pid + (name.empty() ? "" : " (" + name + ")");
  }
  return "another program";
}

}  // namespace

/// The result of a thread; written before `done`, read after it.
struct Link::LookUp {
  struct Place {
    sockaddr_storage address{};
    socklen_t size = 0;
  };
  int code = 0;
  std::vector<Place> places;
  std::atomic<bool> done{false};

  void find(const std::string& host, int port, int flags) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_NUMERICSERV | flags;
    addrinfo* list = nullptr;
    code = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list);
    for (const addrinfo* each = list; each != nullptr; each = each->ai_next) {
      Place& place = places.emplace_back();
      std::memcpy(&place.address, each->ai_addr, each->ai_addrlen);
      place.size = each->ai_addrlen;
    }
    if (list != nullptr)
      ::freeaddrinfo(list);
  }
};

short Link::poll_events() const {
  short events = POLLIN;
  const bool connects = state_ == State::connecting && address_.kind != Address::Kind::ros2;
  if (connects || !waiting_.empty())
    events |= POLLOUT;
  return events;
}

double Link::due() const {
  if (state_ == State::closed)
    return next_try_;
  return state_ == State::connecting ? give_up_ : std::numeric_limits<double>::infinity();
}

void Link::close(const std::string& why, double now) {
  if (fd_ >= 0) {
    // Another process may hold a copy of the descriptor; the other side shall know at once.
    if (address_.kind != Address::Kind::serial) {
      ::shutdown(fd_, SHUT_RDWR);
    } else if (state_ == State::open) {
      ::ioctl(fd_, TIOCNXCL);
      ::flock(fd_, LOCK_UN);
    }
    fd_.reset();
  }
  look_up_.reset();
  state_ = State::closed;
  waiting_.clear();
  trouble_ = why;
  backoff_ = std::clamp(backoff_ * 2.0, kFirstBackoff, kLastBackoff);
  next_try_ = now + backoff_;
}

void Link::opened() {
  state_ = State::open;
  tries_ = tries_ > 0 ? tries_ - 1 : 0;  // the address that answered is the next one's too
  heard_ = false;
  trouble_.clear();
}

void Link::open(double now) {
  const auto fail = [&](const std::string& what) { close(what + ": " + error_text(), now); };
  address_.settle();
  if (address_.kind == Address::Kind::serial) {
    fd_ = ::open(address_.name.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (fd_ < 0 && errno == ENOENT)
      return close(address_.name + ": there is no such line (is it plugged in?)", now);
    if (fd_ < 0 && errno == EACCES)
      return close(address_.name + ": no permission (are you in the group dialout?)", now);
    if (fd_ < 0 && errno == EBUSY)
      return close(address_.name + ": in use by another program", now);
    // Two programs on one line would each hear half of the robot, and both drive it. The lock is
    // for other bridges, the exclusive mode for any other program.
    if (fd_ >= 0 && ::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      return close(address_.name + ": in use by " + holder(fd_), now);
    if (fd_ >= 0 && ::isatty(fd_) == 0)
      return close(address_.name + ": is no serial line", now);
    if (fd_ < 0 || !make_raw(fd_, address_))
      return fail(address_.name);
    ::ioctl(fd_, TIOCEXCL);
    return opened();
  }
  if (address_.kind == Address::Kind::local) {
    fd_ = connect_local(address_.name, SOCK_NONBLOCK);
    if (fd_ >= 0)
      return opened();
    if (errno == ENOENT)
      return close(address_.name + ": there is no such socket or line (does the simulator run?)",
                   now);
    if (errno == ECONNREFUSED)
      return close(address_.name + ": nobody listens there (does the simulator run?)", now);
    if (errno == EPERM)
      return close(address_.name +
                       ": another user of this machine listens there, in a folder that "
                       "everybody may write",
                   now);
    return fail(address_.name);
  }
  if (address_.kind == Address::Kind::ros2)
    return start_program(now);
  look_up(now);
}

void Link::start_program(double now) {
  reap();
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return close(address_.name + ": " + error_text(), now);
  std::string program = program_folder() + "/" + kRos2Program;
  std::vector<char*> argv{program.data()};
  for (std::string& argument : address_.arguments)
    argv.push_back(argument.data());
  argv.push_back(nullptr);
  int pid = 0;
  const Inherited inherited(ends[1], kRos2Socket);
  const int error = ::posix_spawn(&pid, program.c_str(), &inherited.files, &inherited.attributes,
                                  argv.data(), environ);
  ::close(ends[1]);
  fd_ = ends[0];
  if (error != 0)
    return close(program + ": " + std::strerror(error), now);
  programs_.push_back(pid);
  ::fcntl(fd_, F_SETFL, O_NONBLOCK);
  state_ = State::connecting;
  trouble_ = address_.name + ": looks for the robot's topics";
  give_up_ = std::numeric_limits<double>::infinity();
}

/// The lines of the program before there is a robot.
void Link::hear_program(double now) {
  std::string line;
  char letter = 0;
  ssize_t n = 0;
  while ((n = ::recv(fd_, &letter, 1, 0)) == 1) {
    if (letter != '\n') {
      line += letter;
    } else if (line.empty()) {
      return opened();
    } else {
      trouble_ = std::exchange(line, {});
    }
  }
  if (n == 0) {
    close(address_.text() + " has ended: its message is in the log", now);
    next_try_ = now + kNextProgram;
  }
}

void Link::reap() {
  std::erase_if(programs_, [](int pid) { return ::waitpid(pid, nullptr, WNOHANG) != 0; });
}

/// A program ends by itself when its link is closed, after stopping the robot.
Link::~Link() {
  close("done");
  for (int i = 0; i < kLongestEnd && !programs_.empty(); ++i, reap())
    ::poll(nullptr, 0, 10);
}

/// A resolver without a network is slow, and the loop must not wait: so a thread asks it. A numeric
/// address needs no resolver.
void Link::look_up(double now) {
  look_up_ = std::make_shared<LookUp>();
  look_up_->find(address_.name, address_.port, AI_NUMERICHOST);
  if (look_up_->code == 0)
    return open_tcp(now);
  state_ = State::connecting;
  trouble_ = "looks up " + address_.name;
  give_up_ = std::numeric_limits<double>::infinity();
  std::thread([of = look_up_, host = address_.name, port = address_.port] {
    of->find(host, port, 0);
    of->done = true;
  }).detach();
}

void Link::open_tcp(double now) {
  // A name may have several addresses, and the robot listens to one of them: each try takes the
  // next.
  const std::shared_ptr<LookUp> found = std::exchange(look_up_, nullptr);
  if (found->code != 0)
    return close(address_.name + ": " + ::gai_strerror(found->code), now);
  const LookUp::Place& chosen = found->places[tries_++ % found->places.size()];
  const auto* const place = reinterpret_cast<const sockaddr*>(&chosen.address);
  fd_ = ::socket(place->sa_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int result = fd_ < 0 ? -1 : ::connect(fd_, place, chosen.size);
  if (result != 0 && (fd_ < 0 || errno != EINPROGRESS))
    return close(address_.text() + ": " + error_text(), now);
  // Command packets are sent at once, without waiting for more data.
  const int on = 1;
  ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  if (result == 0)
    return opened();
  state_ = State::connecting;
  trouble_ = "connecting to " + address_.text();
  give_up_ = now + kConnectTime;
}

void Link::advance(double now) {
  if (state_ == State::closed && now >= next_try_)
    open(now);
  if (state_ == State::connecting && address_.kind == Address::Kind::ros2)
    return hear_program(now);
  if (state_ == State::connecting && look_up_) {
    if (!look_up_->done)
      return;
    open_tcp(now);
  }
  if (state_ == State::connecting) {
    pollfd ready{fd_, POLLOUT, 0};
    if (::poll(&ready, 1, 0) > 0) {
      int error = 0;
      socklen_t size = sizeof error;
      if (::getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0)
        opened();
      else
        close(address_.text() + ": " + std::strerror(error), now);
    } else if (now >= give_up_) {
      close(address_.text() + ": no answer", now);
    }
  }
  if (state_ == State::open && !waiting_.empty())
    flush(now);
}

std::string Link::hung_up() const {
  return heard_ ? "closed by the robot"
                : "closed by the robot before it said anything (has it another client?)";
}

std::string Link::failure() const {
  return errno == EPIPE || errno == ECONNRESET ? hung_up() : error_text();
}

bool Link::read(std::vector<std::uint8_t>& out, double now) {
  if (state_ != State::open)
    return state_ == State::connecting;
  std::uint8_t buffer[4096];
  while (true) {
    const ssize_t n = ::read(fd_, buffer, sizeof buffer);
    if (n > 0) {
      heard_ = true;
      backoff_ = 0.0;  // a server that answered deserves a quick second try
      out.insert(out.end(), buffer, buffer + n);
      if (static_cast<std::size_t>(n) < sizeof buffer)
        return true;
      continue;
    }
    if (n < 0 && errno == EINTR)
      continue;
    // A raw serial line that is open without blocking reads nothing as 0 bytes.
    if ((n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) ||
        (n == 0 && address_.kind == Address::Kind::serial && ::isatty(fd_) == 1))
      return true;
    close(address_.text() + ": " + (n == 0 ? hung_up() : failure()), now);
    return false;
  }
}

std::size_t Link::queued() const {
  int in_kernel = 0;  // a terminal's own queue is longer than the wait that is acceptable
  if (address_.kind == Address::Kind::serial && ::ioctl(fd_, TIOCOUTQ, &in_kernel) != 0)
    in_kernel = 0;
  return waiting_.size() + static_cast<std::size_t>(std::max(in_kernel, 0));
}

std::size_t Link::room() const {
  const std::size_t taken = queued() + kForMotion;
  return taken < kMaxWaiting ? kMaxWaiting - taken : 0;
}

bool Link::write(std::span<const std::uint8_t> bytes, double now) {
  if (state_ != State::open)
    return false;
  if (queued() + bytes.size() > kMaxWaiting) {
    close(address_.text() + ": does not take commands", now);
    return false;
  }
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
  return flush(now);
}

bool Link::flush(double now) {
  while (!waiting_.empty()) {
    // A plain write on a serial line; on a socket without SIGPIPE.
    const ssize_t n = address_.kind == Address::Kind::serial
                          ? ::write(fd_, waiting_.data(), waiting_.size())
                          : ::send(fd_, waiting_.data(), waiting_.size(), MSG_NOSIGNAL);
    if (n > 0) {
      waiting_.erase(waiting_.begin(), waiting_.begin() + n);
      continue;
    }
    if (n < 0 && errno == EINTR)
      continue;
    if (n == 0 || errno == EAGAIN || errno == EWOULDBLOCK)
      return true;
    close(address_.text() + ": " + failure(), now);
    return false;
  }
  return true;
}

}  // namespace saphira::transport
