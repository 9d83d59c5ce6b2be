#include "foreign_robot.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "line.hpp"
#include "process.hpp"

namespace saphira::test {

namespace {

constexpr double kPeriod = 0.1;          // [s]
constexpr double kDistance = 0.485;      // [mm] of one unit of position
constexpr double kAngle = 360.0 / 4096;  // [deg]

void word(Wire& out, int value) {
  out.push_back(static_cast<std::uint8_t>(value & 0xFF));
  out.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFF));
}

}  // namespace

ForeignRobot::ForeignRobot()
    : checker_([](const protocol::RobotIdentity&) {
        return protocol::load_parameters(source("config/robots/p3dx.p"));
      }) {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      ::listen(listener_, 1) != 0 ||
      ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("no port for the foreign robot");
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { run(); });
}

ForeignRobot::~ForeignRobot() {
  stop_ = true;
  thread_.join();
  if (client_ >= 0)
    ::close(client_);
  ::close(listener_);
}

std::string ForeignRobot::trouble() const {
  const std::lock_guard lock(mutex_);
  std::string all = trouble_;
  for (const protocol::Finding& finding : checker_.findings())
    if (finding.kind == protocol::Finding::Kind::kViolation)
      all += to_string(finding) + "; ";
  return all;
}

void ForeignRobot::watch(protocol::Side side, const Wire& bytes) {
  const std::lock_guard lock(mutex_);
  checker_.feed(side, bytes);
}

void ForeignRobot::send(const Wire& body) {
  const Wire bytes = packet(body);
  watch(protocol::Side::kServer, bytes);
  put(bytes);
}

void ForeignRobot::put(const Wire& bytes) const {
  [[maybe_unused]] const auto sent = ::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

void ForeignRobot::run() {
  using Clock = std::chrono::steady_clock;
  Wire received;
  auto due = Clock::now();
  while (!stop_) {
    pollfd fds[2] = {{listener_, POLLIN, 0}, {client_, POLLIN, 0}};
    ::poll(fds, client_ >= 0 ? 2 : 1, 10);
    if (client_ < 0 && (fds[0].revents & POLLIN) != 0) {
      client_ = ::accept(listener_, nullptr, nullptr);
      received.clear();
      syncs_ = 0;
    }
    if (client_ >= 0 && fds[1].revents != 0) {
      std::uint8_t bytes[512];
      const ssize_t size = ::read(client_, bytes, sizeof bytes);
      if (size <= 0) {
        ::close(client_);
        client_ = -1;
        open_ = false;
        const std::lock_guard lock(mutex_);
        checker_.disconnect();
      } else {
        watch(protocol::Side::kClient, {bytes, bytes + size});
        received.insert(received.end(), bytes, bytes + size);
      }
    }
    while (received.size() >= 3 && received.size() >= 3U + received[2]) {
      const auto end = received.begin() + 3 + received[2];
      const Wire whole(received.begin(), end);
      const Wire body(received.begin() + 3, end - 2);
      received.erase(received.begin(), end);
      if (packet(body) == whole) {
        handle(body);
      } else {
        const std::lock_guard lock(mutex_);
        trouble_ += "a bad packet; ";
      }
    }
    if (Clock::now() < due)
      continue;
    due += std::chrono::milliseconds(100);
    if (heads_)
      rotation_ = std::clamp(std::remainder(heading_ - th_, 360.0) / kPeriod / 2.0, -100.0, 100.0);
    th_ = std::remainder(th_ + rotation_ * kPeriod, 360.0);
    x_ = x_ + velocity_ * kPeriod * std::cos(th_ * kPi / 180.0);
    y_ += velocity_ * kPeriod * std::sin(th_ * kPi / 180.0);
    if (open_)
      inform();
  }
}

void ForeignRobot::spoil(std::function<void(Wire&)> how) {
  const std::lock_guard lock(mutex_);
  spoil_ = std::move(how);
}

void ForeignRobot::inform() {
  const Wire body = information();
  const Wire bytes = packet(body);
  watch(protocol::Side::kServer, bytes);
  Wire spoiled = body;
  {
    const std::lock_guard lock(mutex_);
    if (spoil_)
      spoil_(spoiled);
  }
  put(packet(spoiled));
}

Wire ForeignRobot::information() const {
  Wire body{0x32};
  word(body, static_cast<int>(std::floor(x_ / kDistance)) & 0x7FFF);
  word(body, static_cast<int>(std::floor(y_ / kDistance)) & 0x7FFF);
  word(body, static_cast<int>(std::lround(th_ / kAngle)));
  const double difference = rotation_ * kPi / 180.0 / 0.0056;
  word(body, static_cast<int>(std::lround(velocity_ - difference)));
  word(body, static_cast<int>(std::lround(velocity_ + difference)));
  body.push_back(130);                     // 13 V
  word(body, 0);                           // stalls, bumpers
  word(body, 0);                           // control
  word(body, (motors_ ? 1 : 0) | 3 << 1);  // flags
  body.push_back(0);                       // compass
  body.push_back(16);
  for (int i = 0; i < 16; ++i) {
    body.push_back(static_cast<std::uint8_t>(i));
    word(body, 3000 + 10 * i);
  }
  word(body, 0);  // gripper
  body.insert(body.end(), {0, 0, 0});
  word(body, 130);    // battery
  body.push_back(0);  // charge
  word(body, static_cast<int>(std::lround(rotation_ * 10)));
  word(body, 0);      // faults
  word(body, 0);      // lateral velocity
  body.push_back(0);  // temperature
  body.push_back(0);  // state of charge
  return body;
}

void ForeignRobot::handle(const Wire& body) {
  if (!open_ && body.size() == 1 && body[0] == syncs_ && syncs_ < 3) {
    Wire answer{body[0]};
    if (syncs_ == 2)
      for (const std::string text : {"MobileSim", "Pioneer", "p3dx"}) {
        answer.insert(answer.end(), text.begin(), text.end());
        answer.push_back(0);
      }
    ++syncs_;
    send(answer);
    return;
  }
  if (syncs_ < 3) {
    const std::lock_guard lock(mutex_);
    trouble_ += "command " + std::to_string(body[0]) + " before the synchronization; ";
    return;
  }
  int value = 0;
  if (body.size() >= 4) {
    value = body[2] | body[3] << 8;
    if (body[1] == 0x1B)
      value = -value;
  }
  switch (body[0]) {
    case 1:
      open_ = true;
      break;
    case 2:
      open_ = false;
      syncs_ = 0;
      velocity_ = rotation_ = 0.0;
      heads_ = false;
      break;
    case 4:
      motors_ = value != 0;
      break;
    case 7:
      x_ = th_ = 0.0;
      y_ = 0.0;
      break;
    case 11:
      velocity_ = motors_ ? value : 0;
      break;
    case 12:
      heads_ = motors_;
      heading_ = value;
      break;
    case 13:
      heads_ = motors_;
      heading_ = th_ + value;
      break;
    case 9:
    case 21:
      heads_ = false;
      rotation_ = motors_ ? value : 0;
      break;
    default:
      break;  // unsupported, as most are
  }
}

}  // namespace saphira::test
