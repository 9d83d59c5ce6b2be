#include "saphira/sim/host.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <thread>

#include "process.hpp"
#include "saphira/base/local_socket.hpp"
#include "saphira/base/text.hpp"
#include "saphira/protocol/command.hpp"
#include "saphira/protocol/information.hpp"
#include "saphira/sim/trace.hpp"
#include "saphira/transport/address.hpp"
#include "saphira/transport/link.hpp"
#include "trouble.hpp"

namespace saphira::sim {
namespace {

using namespace std::chrono_literals;
using protocol::Bytes;

using test::source;
using test::wait_until;

// Generous: only a failure takes this long.
constexpr auto kLimit = 20s;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A descriptor of that local socket, when somebody listens.
Descriptor connected(const std::string& path) {
  Descriptor fd;
  EXPECT_TRUE(wait_until([&] { return bool(fd = connect_local(path)); }));
  return fd;
}

class Client {
 public:
  explicit Client(const std::string& path) : fd_(connected(path)) {}
  explicit Client(std::uint16_t port) : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_TRUE(wait_until([&] {
      return ::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    }));
  }
  void close() { fd_.reset(); }
  void send(const Bytes& bytes) const {
    EXPECT_EQ(::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  /// The next packet's body; empty when the connection has closed.
  Bytes next() {
    while (true) {
      if (auto body = parser_.next())
        return *body;
      pollfd wait{fd_, POLLIN, 0};
      const int ready =
          ::poll(&wait, 1, static_cast<int>(std::chrono::milliseconds(kLimit).count()));
      std::uint8_t buffer[1024];
      const ssize_t size = ready == 1 ? ::read(fd_, buffer, sizeof buffer) : -1;
      if (size <= 0) {
        EXPECT_EQ(ready, 1) << "no packet came";
        return {};
      }
      parser_.feed({buffer, static_cast<std::size_t>(size)});
    }
  }
  protocol::InformationPacket information() {
    while (true) {
      const Bytes body = next();
      if (body.empty())
        return {};
      if (const auto packet = protocol::decode_information(body))
        return *packet;
    }
  }
  void open() {
    for (int i = 0; i < 3; ++i) {
      send(protocol::encode_sync(i));
      EXPECT_EQ(protocol::sync_number(next()), i);
    }
    send(encode(protocol::Open{}));
  }

 private:
  Descriptor fd_;
  protocol::PacketParser parser_;
};

class HostTest : public ::testing::Test {
 protected:
  HostTest() : stop_(::eventfd(0, 0)) {
    options_.world = source("config/worlds/office.wld");
    options_.robot = source("config/robots/pioneer.p");
    options_.socket = directory_ + "/robot";
    options_.trace = directory_ + "/trace.csv";
    options_.log = [this](std::string_view level, const std::string& line) {
      const std::scoped_lock lock(mutex_);
      log_ += std::string(level) + " " + line + "\n";
    };
  }
  ~HostTest() override {
    stop();
    ::close(stop_);
  }

  void start() {
    thread_ = std::thread([this] { run(options_, stop_); });
  }
  void stop() {
    if (!thread_.joinable())
      return;
    const std::uint64_t one = 1;
    EXPECT_EQ(::write(stop_, &one, sizeof one), static_cast<ssize_t>(sizeof one));
    thread_.join();
    std::uint64_t count = 0;
    EXPECT_EQ(::read(stop_, &count, sizeof count), static_cast<ssize_t>(sizeof count));
  }
  std::string log() {
    const std::scoped_lock lock(mutex_);
    return log_;
  }
  bool logs(const std::string& text) {
    return wait_until([&] { return log().find(text) != std::string::npos; });
  }
  std::vector<TraceRow> trace() const {
    return parse_trace(read_file(options_.trace), options_.trace);
  }

  HostOptions options_;
  const test::TempDir folder_;
  const std::string directory_ = folder_.path();
  int stop_;
  std::thread thread_;
  std::mutex mutex_;
  std::string log_;
};

TEST_F(HostTest, ServesLive) {
  options_.rate = 20.0;
  start();
  Client client(*options_.socket);
  client.open();
  client.send(encode(protocol::Velocity{0.3}));
  for (int i = 0; i < 20; ++i) {
    client.information();
    client.send(encode(protocol::Pulse{}));
  }
  // The trace can be read while it grows.
  EXPECT_TRUE(wait_until([&] { return trace().size() >= 20U; }));
  client.close();
  EXPECT_TRUE(logs("the client has gone"));
  EXPECT_TRUE(wait_until([&] { return trace().back().velocity == 0.0; }));
  EXPECT_GT(trace().back().pose_in_world.x, 1.6);
  stop();
  EXPECT_FALSE(std::filesystem::exists(*options_.socket));
}

TEST_F(HostTest, AStepWhileTimeIsPausedWaitsForAClient) {
  options_.view_socket = directory_ + "/view";
  start();
  const Descriptor viewer = connected(*options_.view_socket);
  const auto say = [&](const std::string& line) {
    EXPECT_EQ(::send(viewer, line.data(), line.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(line.size()));
  };
  say("{\"do\":\"pause\",\"on\":true}\n{\"do\":\"step\"}\n");
  std::string shown;
  EXPECT_TRUE(wait_until([&] {
    char part[4096];
    const ssize_t size = ::recv(viewer, part, sizeof part, MSG_DONTWAIT);
    shown.append(part, static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    return shown.find("\"paused\":true") != std::string::npos;
  }));
  Client client(*options_.socket);
  client.open();
  client.information();
  EXPECT_TRUE(wait_until([&] { return trace().size() == 1U; }));
  say("{\"do\":\"step\"}\n");
  client.information();
  EXPECT_TRUE(wait_until([&] { return trace().size() == 2U; }));
}

// As a bridge opens a serial line, leaves, and returns.
TEST_F(HostTest, ServesATerminal) {
  options_.socket.reset();
  options_.terminal = directory_ + "/tty";
  start();
  ASSERT_TRUE(logs("listening on " + *options_.terminal));
  const auto heart = [this] {
    transport::Link link(transport::parse_address("serial:" + *options_.terminal + "@9600"));
    EXPECT_TRUE(wait_until([&] {
      link.advance(now());
      return link.state() == transport::Link::State::open;
    })) << link.trouble();
    protocol::PacketParser parser;
    const auto hear = [&](const auto& wanted) {
      return wait_until([&] {
        std::vector<std::uint8_t> bytes;
        EXPECT_TRUE(link.read(bytes, now())) << link.trouble();
        parser.feed(bytes);
        while (const auto body = parser.next())
          if (wanted(*body))
            return true;
        return false;
      });
    };
    EXPECT_TRUE(link.write(encode(protocol::Close{}), now()));  // after any earlier client
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(link.write(protocol::encode_sync(i), now()));
      EXPECT_TRUE(hear([&](const Bytes& body) { return protocol::sync_number(body) == i; })) << i;
    }
    EXPECT_TRUE(link.write(encode(protocol::Open{}), now()));
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(
          hear([](const Bytes& body) { return protocol::decode_information(body).has_value(); }));
    }
  };
  heart();
  EXPECT_TRUE(logs("the client has closed the terminal"));
  heart();
  stop();
  EXPECT_FALSE(std::filesystem::is_symlink(*options_.terminal));
}

TEST_F(HostTest, ATerminalTakesNoFilesPlace) {
  options_.socket.reset();
  options_.terminal = directory_ + "/tty";
  std::ofstream(*options_.terminal) << "precious";
  EXPECT_TRUE(test::has(test::trouble_of<UnusableFile>([&] { run(options_, stop_); }),
                        "is no symbolic link"));
  EXPECT_EQ(read_file(*options_.terminal), "precious");
}

// The file is right for a smaller robot.
TEST_F(HostTest, AStartWithoutRoomIsNamedByItsPlace) {
  const std::string world = directory_ + "/narrow.wld";
  std::ofstream(world) << "width 4000 height 4000\n0 0 4000 0\n  position 2000 150 0\n"
                          "robot 2000 160 0\n";
  options_.world = world;
  const auto trouble = [&] { return test::trouble([&] { run(options_, stop_); }); };
  EXPECT_NE(trouble().find("narrow.wld:3:3: "), std::string::npos) << trouble();
  options_.position = Pose{2.0, 2.0, 0.0};
  options_.more.push_back({});
  EXPECT_NE(trouble().find("narrow.wld:4:1: "), std::string::npos) << trouble();
  options_.more[0].position = Pose{2.0, 2.1, 0.0};
  EXPECT_NE(trouble().find("--position of robot 2: "), std::string::npos) << trouble();
  options_.more[0].position = Pose{-99.999, 0.007, 0.0};
  EXPECT_EQ(trouble(),
            "--position of robot 2: expected a place in the world of (4000, 4000) mm, found "
            "(-99999, 7)");
}

// A dry run reports the mistakes that a run reports.
TEST_F(HostTest, ACheckPlacesTheRobotsAndOpensNothing) {
  options_.position = Pose{1.5, 6.0, 0.0};
  EXPECT_THROW(check(options_), std::invalid_argument);
  options_.position.reset();
  options_.more.push_back({});
  EXPECT_THROW(check(options_), std::invalid_argument) << "no place for the second robot";
  options_.more.clear();
  options_.socket = "/nowhere/robot";
  EXPECT_NO_THROW(check(options_));
}

// Without a tick of time, a false header must still not hold back the step behind it.
TEST_F(HostTest, AFalseHeaderDoesNotStallSingleStep) {
  options_.step = true;
  start();
  Client client(*options_.socket);
  client.open();
  client.send({0xFA, 0xFB, 180});
  client.send(encode(protocol::Step{}));
  EXPECT_EQ(client.information().motors, protocol::Motors::kStopped);
}

TEST_F(HostTest, RefusesASecondClientAndTakesTheNext) {
  start();
  {
    Client first(*options_.socket);
    first.open();
    Client second(*options_.socket);
    EXPECT_TRUE(second.next().empty());
    EXPECT_TRUE(logs("second client was refused"));
    first.information();
  }
  EXPECT_TRUE(logs("the client has gone"));
  Client third(*options_.socket);
  third.open();
  third.information();
}

TEST_F(HostTest, ServesTcp) {
  options_.tcp = 0;
  options_.step = true;
  start();
  ASSERT_TRUE(logs("listening on 127.0.0.1:"));
  const std::string line = log();
  const auto at = line.find("127.0.0.1:") + 10;
  Client client(static_cast<std::uint16_t>(std::stoi(line.substr(at))));
  client.open();
  client.send(encode(protocol::Step{}));
  client.information();
}

TEST_F(HostTest, TakesOverTheSocketOfOneThatDied) {
  {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, options_.socket->c_str(), sizeof address.sun_path - 1);
    const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(::bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    ::close(fd);
  }
  ASSERT_TRUE(std::filesystem::exists(*options_.socket));
  start();
  Client client(*options_.socket);
  client.open();
}

TEST_F(HostTest, WarningsOfFilesAreLoggedAsWarnings) {
  options_.world = directory_ + "/odd.wld";
  std::ofstream(options_.world) << "width 10000 height 10000\nposition 5000 5000 0\n"
                                   "3000 3000 3000 3000\n";
  std::ifstream robot(options_.robot);
  options_.robot = directory_ + "/odd.p";
  std::ofstream(options_.robot) << robot.rdbuf() << "\nSonarUnit 7 100 -100 -90\n";
  const Host host(options_);
  EXPECT_TRUE(log().find("warning " + options_.world + ":3: ") != std::string::npos) << log();
  EXPECT_TRUE(log().find("warning " + options_.robot + ":") != std::string::npos) << log();
  EXPECT_TRUE(log().find("info listening on ") != std::string::npos) << log();
}

TEST_F(HostTest, RefusesWhatItCannotServe) {
  const auto message = [&](const HostOptions& options) -> std::string {
    try {
      run(options, stop_);
      return "no error";
    } catch (const UnusableFile& error) {  // 2 is the exit code of these two
      return error.what();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  };
  const auto with = [&](auto change) {
    HostOptions options = options_;
    change(options);
    return message(options);
  };
  using Options = HostOptions;
  const std::string bare = directory_ + "/bare.wld";
  std::ofstream(bare) << "width 1000 height 1000\n";
  const std::vector<std::pair<const char*, std::function<void(Options&)>>> refused{
      {"/nowhere.wld", [](Options& o) { o.world = "/nowhere.wld"; }},
      {"rate", [](Options& o) { o.rate = 0.0; }},
      {"in a wall",
       [](Options& o) {
         o.position = Pose{1.5, 6.0, 0.0};
       }},
      {"characters", [](Options& o) { o.socket = std::string(200, 'x'); }},
      {"/nowhere/robot", [](Options& o) { o.socket = "/nowhere/robot"; }},
      {"found a folder", [](Options& o) { o.socket = "/tmp"; }},
      {"/nowhere/t.csv", [](Options& o) { o.trace = "/nowhere/t.csv"; }},
      {"nobody", [](Options& o) { o.tcp = 0, o.tcp_address = "nobody"; }},
      {"--position of robot 2: the robot would stand in robot 1: with its radius of 0.22 m the two "
       "overlap by 0.44 m",
       [](Options& o) {
         o.position = Pose{1.5, 7.0, 0.0};
         o.more.push_back({.robot = {}, .position = o.position});
       }},
      {"position", [&](Options& o) { o.world = bare; }},
      {"position", [](Options& o) { o.more.push_back({}); }}};
  for (const auto& [part, change] : refused)
    EXPECT_TRUE(test::has(with(change), part)) << part;
  const std::string notes = directory_ + "/notes.txt";
  std::ofstream(notes) << "mine";
  const std::string found =
      "socket " + notes + ": expected a new name, or a socket; found a file, which stays as it is";
  for (const auto change :
       {+[](Options& o) { return &o.socket; }, +[](Options& o) { return &o.view_socket; },
        +[](Options& o) { return &o.stereo_socket; }}) {
    EXPECT_EQ(with([&](Options& o) { *change(o) = notes; }), found);
    HostOptions options = options_;
    *change(options) = notes;
    EXPECT_THROW(check(options), UnusableFile) << "a dry run finds it, too";
  }
  EXPECT_EQ(read_file(notes), "mine");

  start();
  EXPECT_TRUE(logs("listening"));
  EXPECT_NE(message(options_).find("another simulator"), std::string::npos);
}

// A client that sends only necessary packets: time must not wait, and must not run away from a
// client either.
TEST_F(HostTest, RunsAsFastAsItsClientReads) {
  options_.rate = kMaxRate;
  options_.trace.clear();
  start();
  Client client(*options_.socket);
  client.open();
  const protocol::RobotParameters parameters = protocol::load_parameters(options_.robot);
  const auto begin = std::chrono::steady_clock::now();
  client.send(encode(protocol::RotationVelocity{0.5}));
  double turned = 0.0;
  double last = 0.0;
  constexpr int kPackets = 2000;
  for (int i = 0; i < kPackets; ++i) {
    const double th = interpret(client.information(), parameters).th;
    turned += norm2_angle(th - last);
    last = th;
    client.send(encode(protocol::Pulse{}));
  }
  const double took =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_LT(took, 0.1 * kPackets / 10.0);
  // No packet was lost on the way, and the watchdog saw every pulse in time.
  EXPECT_NEAR(turned, 0.5 * 0.1 * kPackets, 2.0);
}

TEST_F(HostTest, ServesSeveralRobotsInOneWorld) {
  options_.step = true;
  options_.position = Pose{2.0, 7.0, 0.0};
  options_.more.push_back({{}, Pose{4.0, 7.0, kPi}});
  options_.more.push_back({source("config/robots/pioneer.p"), Pose{6.0, 7.0, 0.0}});
  start();
  Client one(*options_.socket);
  Client two(*options_.socket + "-2");
  Client three(*options_.socket + "-3");
  for (Client* client : {&one, &two, &three})
    client->open();
  one.send(encode(protocol::Velocity{0.4}));
  for (int i = 0; i < 100; ++i) {
    for (Client* client : {&three, &one, &two})
      client->send(encode(protocol::Step{}));
    for (Client* client : {&one, &two, &three})
      client->information();
  }
  EXPECT_TRUE(logs("robot 3: listening on "));
  stop();
  const auto rows = trace();
  ASSERT_EQ(rows.size(), 100U);
  EXPECT_EQ(rows.back().contacts, 1);
  EXPECT_NEAR(rows.back().pose_in_world.x, 4.0 - 0.44, 1e-3);
  const std::string third = directory_ + "/trace-3.csv";
  EXPECT_EQ(parse_trace(read_file(third), third).back().pose_in_world, (Pose{6.0, 7.0, 0.0}));
  EXPECT_FALSE(std::filesystem::exists(*options_.socket + "-3"));
}

// One picture of a stream.
std::string next_picture(int fd) {
  std::string picture;
  std::size_t size = std::string::npos;
  while (picture.size() < size) {
    std::array<char, 65536> buffer{};
    pollfd wait{fd, POLLIN, 0};
    if (::poll(&wait, 1, static_cast<int>(std::chrono::milliseconds(kLimit).count())) != 1)
      return "no picture came";
    const ssize_t got = ::read(fd, buffer.data(), std::min(buffer.size(), size - picture.size()));
    if (got <= 0)
      return "the stream has ended";
    picture.append(buffer.data(), static_cast<std::size_t>(got));
    const std::string head = "\n640 240\n255\n";
    if (const auto at = picture.find(head); at != std::string::npos)
      size = at + head.size() + 640 * 240;
  }
  return picture;
}

TEST_F(HostTest, ShowsWhatTheStereoCamerasSee) {
  options_.step = true;
  options_.stereo = directory_ + "/pictures";
  options_.stereo_socket = directory_ + "/eyes";
  start();
  Client client(*options_.socket);
  client.open();
  Descriptor viewer = connected(*options_.stereo_socket);
  std::string last;
  for (int cycle = 1; cycle <= 3; ++cycle) {
    client.send(encode(protocol::Step{}));
    client.information();
    const std::string picture = next_picture(viewer);
    EXPECT_TRUE(picture.starts_with("P5\n# saphira stereo cycle=" + std::to_string(cycle) + " "))
        << picture.substr(0, 80);
    EXPECT_EQ(picture, read_bytes(options_.stereo + "/00000" + std::to_string(cycle) + ".pgm"));
    EXPECT_NE(picture, last);
    last = picture;
  }
  // In single step a late viewer has missed nothing.
  Descriptor late = connected(*options_.stereo_socket);
  for (int cycle = 1; cycle <= 3; ++cycle)
    EXPECT_EQ(next_picture(late),
              read_bytes(options_.stereo + "/00000" + std::to_string(cycle) + ".pgm"));
  late.reset();
  viewer.reset();
  client.send(encode(protocol::Step{}));
  client.information();
}

TEST_F(HostTest, WritesDownWhatIsAgainstTheTables) {
  options_.step = true;
  options_.check = directory_ + "/check";
  start();
  {
    Client client(*options_.socket);
    client.open();
    client.send(encode(protocol::Step{}));
    client.information();
  }
  ASSERT_TRUE(logs("the client has gone"));
  const std::string good = read_file(*options_.check);
  EXPECT_EQ(good.find("violation:"), std::string::npos) << good;
  EXPECT_NE(good.find("client: 1 x STEP (64)"), std::string::npos) << good;
  EXPECT_NE(good.find("0 violations"), std::string::npos) << good;
  {
    Client client(*options_.socket);
    client.open();
    client.send({0x55});
    client.send(encode(protocol::Step{}));
    client.information();
    // At once, not at the end of the connection.
    EXPECT_NE(read_file(*options_.check).find("violation: 1 bytes that belong to no packet"),
              std::string::npos);
  }
}

TEST(Host, NumbersNames) {
  EXPECT_EQ(numbered("run.csv", 1), "run.csv");
  EXPECT_EQ(numbered("run.csv", 2), "run-2.csv");
  EXPECT_EQ(numbered("a.b/robot", 12), "a.b/robot-12");
  EXPECT_EQ(numbered("/tmp/.robot", 3), "/tmp/.robot-3");
  EXPECT_EQ(numbered(".robot", 3), ".robot-3");
}

TEST(Host, DefaultSocket) {
  ::unsetenv("ROBOT_SOCKET");
  EXPECT_EQ(default_socket(), "/tmp/saphira-robot-" + std::to_string(::getuid()));
  ::setenv("ROBOT_SOCKET", "/tmp/mine", 1);
  EXPECT_EQ(default_socket(), "/tmp/mine");
  ::unsetenv("ROBOT_SOCKET");
}

}  // namespace
}  // namespace saphira::sim
