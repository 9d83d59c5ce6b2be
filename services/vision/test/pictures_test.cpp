#include "vision/shell/pictures.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cstring>

#include "process.hpp"

namespace saphira::vision {
namespace {

// A camera's end of the line.
class Camera {
 public:
  explicit Camera(const std::string& path) : listener_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::listen(listener_, 1), 0);
  }
  ~Camera() {
    ::close(client_);
    ::close(listener_);
  }
  Camera& operator=(Camera&&) = delete;

  void accept() { client_ = ::accept(listener_, nullptr, nullptr); }
  void show(std::uint64_t cycle) const {
    say("P5\n# saphira stereo cycle=" + std::to_string(cycle) +
        " focal=10 baseline=0.1 height=1 forward=0\n4 1\n255\nabcd");
  }
  void say(const std::string& bytes) const {
    EXPECT_EQ(::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  void hang_up() {
    ::close(client_);
    client_ = -1;
  }

 private:
  int listener_;
  int client_ = -1;
};

std::uint64_t cycle_of(const std::optional<StereoPicture>& picture) {
  return picture ? picture->cycle : 0;
}

TEST(Pictures, WithoutASocketThereAreNone) {
  Pictures none("");
  EXPECT_FALSE(none.connected());
  EXPECT_FALSE(none.take(1));
  EXPECT_EQ(none.trouble(), "no stereo socket was given");
}

TEST(Pictures, ACameraThatComesLateOrAgainIsFound) {
  const test::TempDir folder;
  const std::string path = folder.path("eyes");
  Pictures pictures(path);
  EXPECT_TRUE(test::wait_until([&] {
    return pictures.trouble().find("No such file") != std::string::npos;
  })) << pictures.trouble();
  Camera camera(path);
  for (int round = 0; round < 2; ++round) {
    camera.accept();
    EXPECT_TRUE(test::wait_until([&] { return pictures.connected(); }));
    EXPECT_EQ(pictures.trouble(), "");
    camera.show(5);
    EXPECT_TRUE(test::wait_until([&] { return pictures.has(5); }));
    EXPECT_EQ(cycle_of(pictures.take(5)), 5U);
    EXPECT_FALSE(pictures.take(5));
    camera.hang_up();
    EXPECT_TRUE(test::wait_until([&] { return !pictures.connected(); }));
    EXPECT_NE(pictures.trouble().find("closed"), std::string::npos);
  }
}

TEST(Pictures, TheNewestOfTheCyclesThatHaveBeen) {
  const test::TempDir folder;
  const std::string path = folder.path("eyes");
  Camera camera(path);
  std::atomic<int> came = 0;
  Pictures pictures(path, [&] { ++came; });
  camera.accept();
  ASSERT_TRUE(test::wait_until([&] { return pictures.connected(); }));
  camera.show(1);
  camera.show(2);
  camera.show(4);
  // That of cycle 4 is the first of a cycle from 3 on: then all are here.
  EXPECT_TRUE(test::wait_until([&] { return pictures.has(3); }));
  EXPECT_EQ(cycle_of(pictures.take(3)), 2U);
  EXPECT_EQ(cycle_of(pictures.take(4)), 4U);
  EXPECT_TRUE(test::wait_until([&] { return came == 3; }));
}

TEST(Pictures, WhatIsNoPictureIsSaidAndTriedAgain) {
  const test::TempDir folder;
  const std::string path = folder.path("eyes");
  Camera camera(path);
  Pictures pictures(path);
  camera.accept();
  camera.say("HTTP/1.1 200 OK\r\n");
  EXPECT_TRUE(test::wait_until([&] {
    return pictures.trouble().find("expected a PGM file") != std::string::npos;
  })) << pictures.trouble();
  camera.hang_up();
  camera.accept();
  camera.show(7);
  EXPECT_TRUE(test::wait_until([&] { return cycle_of(pictures.take(7)) == 7U; }));
}

}  // namespace
}  // namespace saphira::vision
