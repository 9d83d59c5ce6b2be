#include "saphira/transport/link.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <termios.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "process.hpp"
#include "trouble.hpp"

namespace saphira::transport {
namespace {

TEST(Address, AMissingLineIsNamed) {
  EXPECT_EQ(line_trouble(parse_address("/dev/ttyNone@19200")),
            "/dev/ttyNone: cannot be opened: No such file or directory; the bridge waits until it "
            "is there");
  EXPECT_EQ(line_trouble(parse_address("/dev/null")), "");
  EXPECT_EQ(line_trouble(parse_address("unix:/nowhere")), "");
  EXPECT_EQ(line_trouble(parse_address("tcp:lab:8101")), "");
}

TEST(Address, IsReadInEveryForm) {
  EXPECT_EQ(parse_address("/dev/ttyS0").text(), "/dev/ttyS0@9600");
  EXPECT_EQ(parse_address("/dev/ttyUSB0@19200").baud, 19200);
  EXPECT_EQ(parse_address("serial:/tmp/line").text(), "serial:/tmp/line@9600");
  const Address full = parse_address("serial:/tmp/line@38400,8E2,rtscts");
  EXPECT_EQ(full.kind, Address::Kind::serial);
  EXPECT_EQ(full.baud, 38400);
  EXPECT_EQ(full.parity, 'E');
  EXPECT_EQ(full.stop_bits, 2);
  EXPECT_TRUE(full.flow_control);
  EXPECT_EQ(full.text(), "serial:/tmp/line@38400,8E2,rtscts");
  EXPECT_EQ(parse_address("unix:/tmp/robot").text(), "unix:/tmp/robot");
  EXPECT_EQ(parse_address("/tmp/robot").kind, Address::Kind::local);
  EXPECT_EQ(parse_address("tcp:lab:8101").text(), "tcp:lab:8101");
  EXPECT_EQ(parse_address("tcp:[::1]:8101").name, "::1");
}

TEST(Address, OfRos2HasTheOptionsOfItsProgram) {
  EXPECT_TRUE(parse_address("ros2:").arguments.empty());
  const Address address = parse_address("ros2:tb1,domain=7,laser=-0.03:0:180");
  EXPECT_EQ(address.kind, Address::Kind::ros2);
  EXPECT_EQ(address.text(), "ros2:tb1,domain=7,laser=-0.03:0:180");
  EXPECT_EQ(address.arguments,
            (std::vector<std::string>{"--namespace=tb1", "--domain=7", "--laser=-0.03:0:180"}));
  EXPECT_EQ(parse_address("ros2:,scan=front").arguments, std::vector<std::string>{"--scan=front"});
}

std::string refused(const std::string& address) {
  return test::trouble_of<std::invalid_argument>([&] { parse_address(address); });
}

TEST(Address, SaysWhatWasExpected) {
  for (const char* bad : {"",
                          "robot",
                          "unix:",
                          "tcp:",
                          "tcp:host",
                          "tcp::1",
                          "tcp:host:x",
                          "tcp:host:70000",
                          "/dev/ttyS0@fast",
                          "/dev/ttyS0@12345",
                          "serial:",
                          "/tmp/no-such-line@fast",
                          "/tmp",
                          "/dev/ttyS0@9600,7N1",
                          "localhost:8101",
                          "/dev/ttyS0@9600,xonxoff",
                          "/dev/ttyS0@9600,",
                          "ros2:tb1,",
                          "ros2:tb1,domain",
                          "ros2:,=7"})
    EXPECT_TRUE(test::has(refused(bad), "expected")) << bad;
  EXPECT_TRUE(test::has(refused("localhost:8101"), "tcp:localhost:8101"));
  EXPECT_THROW(parse_address("/" + std::string(200, 'x')), std::invalid_argument);
}

TEST(Address, AnotherFileIsNoSocket) {
  const test::TempDir folder;
  const std::string notes = folder.path("notes.txt");
  std::ofstream(notes) << "mine";
  for (const auto& [text, found] :
       {std::pair("unix:" + notes, "expected a local socket, found a file"),
        {notes, "expected a serial line or a local socket, found a file"},
        {"unix:" + folder.path(), "expected a local socket, found a folder"},
        {"unix:/dev/null", "expected a local socket, found a device"}})
    EXPECT_EQ(refused(text), "\"" + text + "\": " + found);
}

TEST(Address, DefaultIsTheSimulators) {
  ::unsetenv("ROBOT_SOCKET");
  EXPECT_EQ(default_address(), "unix:/tmp/saphira-robot-" + std::to_string(::getuid()));
  ::setenv("ROBOT_SOCKET", "/tmp/other", 1);
  EXPECT_EQ(parse_address(default_address()).text(), "unix:/tmp/other");
  ::unsetenv("ROBOT_SOCKET");
}

bool readable(int fd) {
  pollfd ready{fd, POLLIN, 0};
  return ::poll(&ready, 1, 5000) == 1;
}

/// A robot server's end: listens on a local socket or on a port of this machine.
struct Server {
  explicit Server(bool tcp) {
    path = "/tmp/saphira-link-test-" + std::to_string(::getpid());
    if (tcp) {
      listener = ::socket(AF_INET, SOCK_STREAM, 0);
      sockaddr_in name{};
      name.sin_family = AF_INET;
      name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      EXPECT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&name), sizeof name), 0);
      socklen_t size = sizeof name;
      ::getsockname(listener, reinterpret_cast<sockaddr*>(&name), &size);
      address = "tcp:127.0.0.1:" + std::to_string(ntohs(name.sin_port));
    } else {
      ::unlink(path.c_str());
      listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
      sockaddr_un name{};
      name.sun_family = AF_UNIX;
      path.copy(name.sun_path, sizeof name.sun_path - 1);
      EXPECT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&name), sizeof name), 0);
      address = "unix:" + path;
    }
    ::listen(listener, 4);
  }
  ~Server() {
    ::close(listener);
    ::unlink(path.c_str());
  }
  int accept() const { return ::accept(listener, nullptr, nullptr); }

  int listener = -1;
  std::string path;
  std::string address;
};

class LinkOn : public ::testing::TestWithParam<bool> {};

TEST_P(LinkOn, ConnectsTalksAndComesBack) {
  Server server(GetParam());
  Link link(parse_address(server.address));
  double now = 100.0;
  for (int round = 0; round < 3; ++round) {
    link.advance(now);
    const int peer = server.accept();
    ASSERT_GE(peer, 0);
    pollfd ready{link.fd(), link.poll_events(), 0};
    if (link.state() == Link::State::connecting)
      ::poll(&ready, 1, 5000);
    link.advance(now);
    ASSERT_EQ(link.state(), Link::State::open) << link.trouble();

    ASSERT_EQ(::write(peer, "hello", 5), 5);
    ASSERT_TRUE(readable(link.fd()));
    std::vector<std::uint8_t> in;
    EXPECT_TRUE(link.read(in, now));
    EXPECT_EQ(std::string(in.begin(), in.end()), "hello");
    const std::vector<std::uint8_t> out{1, 2, 3};
    EXPECT_TRUE(link.write(out, now));
    char got[8];
    EXPECT_EQ(::read(peer, got, sizeof got), 3);

    ::close(peer);
    ASSERT_TRUE(readable(link.fd()));
    EXPECT_FALSE(link.read(in, now));
    EXPECT_EQ(link.state(), Link::State::closed);
    EXPECT_NE(link.trouble().find("closed by the robot"), std::string::npos);
    EXPECT_GT(link.due(), now);
    link.advance(now);
    EXPECT_EQ(link.state(), Link::State::closed) << "too early";
    now = link.due();
  }
}
INSTANTIATE_TEST_SUITE_P(LocalAndTcp, LinkOn, ::testing::Bool());

TEST(Link, TriesLessAndLessOftenButAtLeastTwiceASecond) {
  Link link(parse_address("unix:/nonexistent/robot"));
  double now = 1.0;
  std::vector<double> waits;
  for (int i = 0; i < 8; ++i) {
    link.advance(now);
    EXPECT_NE(link.trouble().find("/nonexistent/robot"), std::string::npos);
    waits.push_back(link.due() - now);
    now = link.due();
  }
  EXPECT_NEAR(waits.front(), 0.05, 1e-9);
  EXPECT_NEAR(waits.back(), 0.5, 1e-9);
}

TEST(Link, ASlowLineIsNoQueueOfOldCommands) {
  Server server(false);
  Link link(parse_address(server.address));
  link.advance(1.0);
  const int peer = server.accept();
  const std::vector<std::uint8_t> packet(100, 7);
  bool ok = true;
  for (int i = 0; i < 100000 && ok; ++i)
    ok = link.write(packet, 1.0);
  EXPECT_FALSE(ok);
  EXPECT_NE(link.trouble().find("does not take commands"), std::string::npos);
  ::close(peer);
}

TEST(Link, SpeaksOverATerminalLineWithoutChangingABit) {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(master, 0);
  ASSERT_EQ(::grantpt(master), 0);
  ASSERT_EQ(::unlockpt(master), 0);
  Link link(parse_address(std::string(::ptsname(master)) + "@9600"));
  link.advance(1.0);
  ASSERT_EQ(link.state(), Link::State::open) << link.trouble();
  std::vector<std::uint8_t> all(256);
  std::iota(all.begin(), all.end(), std::uint8_t{0});
  ASSERT_TRUE(link.write(all, 1.0));
  std::vector<std::uint8_t> got;
  while (got.size() < all.size() && readable(master)) {
    std::uint8_t buffer[256];
    const ssize_t n = ::read(master, buffer, sizeof buffer);
    ASSERT_GT(n, 0);
    got.insert(got.end(), buffer, buffer + n);
  }
  EXPECT_EQ(got, all);
  std::vector<std::uint8_t> in;
  EXPECT_TRUE(link.read(in, 1.0)) << "nothing to read is no end";
  ASSERT_EQ(::write(master, all.data(), all.size()), 256);
  while (in.size() < all.size() && readable(link.fd()))
    ASSERT_TRUE(link.read(in, 1.0));
  EXPECT_EQ(in, all);
  ::close(master);
  ASSERT_TRUE(readable(link.fd()));
  EXPECT_FALSE(link.read(in, 1.0)) << "the line was pulled";
}

/// A pseudo-terminal in place of a serial line.
struct Terminal {
  Terminal() {
    EXPECT_GE(master, 0);
    EXPECT_EQ(::grantpt(master), 0);
    EXPECT_EQ(::unlockpt(master), 0);
  }
  ~Terminal() { ::close(master); }
  std::string device() const { return ::ptsname(master); }
  int master = ::posix_openpt(O_RDWR | O_NOCTTY);
};

// A path without a prefix is judged by its present file: also a link, and a file that comes later.
TEST(Link, AnyPathMayBeALine) {
  const Terminal terminal;
  const std::string path = "/tmp/saphira-link-test-line-" + std::to_string(::getpid());
  ::unlink(path.c_str());
  Link late(parse_address(path));
  late.advance(1.0);
  EXPECT_EQ(late.state(), Link::State::closed);
  EXPECT_NE(late.trouble().find("there is no such socket or line"), std::string::npos);
  ASSERT_EQ(::symlink(terminal.device().c_str(), path.c_str()), 0);
  late.advance(late.due());
  EXPECT_EQ(late.state(), Link::State::open) << late.trouble();
  EXPECT_EQ(late.address().kind, Address::Kind::serial);
  late.close("done", 2.0);

  for (const std::string& way :
       {path, path + "@19200", std::filesystem::relative(path).string(), "serial:" + path}) {
    Link link(parse_address(way));
    link.advance(1.0);
    EXPECT_EQ(link.state(), Link::State::open) << way << ": " << link.trouble();
    EXPECT_EQ(link.address().kind, Address::Kind::serial) << way;
  }
  ::unlink(path.c_str());
}

TEST(Link, TriesEachAddressOfAName) {
  Server server(true);  // listens to 127.0.0.1 alone; the name may stand for ::1 first
  const std::string port = server.address.substr(server.address.rfind(':'));
  Link link(parse_address("tcp:localhost" + port));
  double now = 1.0;
  EXPECT_TRUE(test::wait_until([&] {
    if (link.state() == Link::State::closed)
      now = link.due();
    link.advance(now);
    return link.state() == Link::State::open;
  })) << link.trouble();
}

TEST(Link, OneProgramALine) {
  const Terminal terminal;
  Link first(parse_address(terminal.device()));
  first.advance(1.0);
  ASSERT_EQ(first.state(), Link::State::open) << first.trouble();
  Link second(parse_address(terminal.device()));
  second.advance(1.0);
  EXPECT_EQ(second.state(), Link::State::closed);
  // The exclusive mode does not hold for root; the lock then names the holder.
  EXPECT_NE(second.trouble().find(": in use by "), std::string::npos) << second.trouble();
  if (::getuid() == 0) {
    EXPECT_NE(second.trouble().find(std::to_string(::getpid())), std::string::npos)
        << second.trouble();
  }
  first.close("done", 1.0);
  second.advance(second.due());
  EXPECT_EQ(second.state(), Link::State::open) << second.trouble();
}

TEST(Link, SaysWhatIsWrongWithALine) {
  Link missing(parse_address("/dev/no-such-line"));
  missing.advance(1.0);
  EXPECT_EQ(missing.trouble(), "/dev/no-such-line: there is no such line (is it plugged in?)");
  Link file(parse_address("serial:/dev/null"));
  file.advance(1.0);
  EXPECT_EQ(file.state(), Link::State::closed);
  EXPECT_EQ(file.trouble(), "/dev/null: is no serial line");
  Link nobody(parse_address("unix:/tmp/no-such-socket"));
  nobody.advance(1.0);
  EXPECT_NE(nobody.trouble().find("does the simulator run?"), std::string::npos);
  Link nowhere(parse_address("tcp:no-such-host.invalid:8101"));
  nowhere.advance(1.0);
  // The test does not wait for the resolver, which may be quick.
  if (nowhere.state() != Link::State::closed) {
    EXPECT_EQ(nowhere.trouble(), "looks up no-such-host.invalid");
  }
  EXPECT_TRUE(test::wait_until([&] {
    nowhere.advance(1.0);
    return nowhere.state() == Link::State::closed;
  }));
  EXPECT_NE(nowhere.trouble().find("no-such-host.invalid: "), std::string::npos);
}

TEST(Link, SetsTheLine) {
  const Terminal terminal;
  Link link(parse_address(terminal.device() + "@19200,8O2"));
  link.advance(1.0);
  ASSERT_EQ(link.state(), Link::State::open) << link.trouble();
  termios line{};
  ASSERT_EQ(tcgetattr(link.fd(), &line), 0);
  EXPECT_EQ(cfgetospeed(&line), speed_t{B19200});
  EXPECT_NE(line.c_cflag & CSTOPB, 0U);
  EXPECT_EQ(line.c_lflag & (ECHO | ICANON | ISIG), 0U);
}

}  // namespace
}  // namespace saphira::transport
