#include "line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "process.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {

namespace {

constexpr char kHall[] =
    "width 20000 height 8000\n"
    "0 0 0 8000\n0 0 20000 0\n0 8000 20000 8000\n20000 0 20000 8000\n"
    "7000 0 7000 8000 ; the wall ahead\n";

}  // namespace

Wire packet(const Wire& body) {
  Wire out{0xFA, 0xFB, static_cast<std::uint8_t>(body.size() + 2)};
  out.insert(out.end(), body.begin(), body.end());
  int sum = 0;
  std::size_t left = body.size();
  const std::uint8_t* p = body.data();
  while (left > 1) {
    sum = (sum + (p[0] << 8 | p[1])) & 0xFFFF;
    left -= 2;
    p += 2;
  }
  if (left > 0)
    sum ^= p[0];
  out.push_back(static_cast<std::uint8_t>(sum >> 8));
  out.push_back(static_cast<std::uint8_t>(sum & 0xFF));
  return out;
}

Wire packet(std::uint8_t command, int argument) {
  const int size = std::abs(argument);
  return packet(Wire{command, static_cast<std::uint8_t>(argument >= 0 ? 0x3B : 0x1B),
                     static_cast<std::uint8_t>(size & 0xFF),
                     static_cast<std::uint8_t>(size >> 8 & 0xFF)});
}

Line::Line(const std::string& file)
    : world_(sim::parse_world(kHall, "hall.wld")),
      parameters_(protocol::load_parameters(source("config/robots/" + file + ".p"))),
      scene_(world_),
      server_(scene_, parameters_, kStart, {}),
      checker_([this](const protocol::RobotIdentity&) { return parameters_; }) {}

void Line::send(const Wire& bytes) {
  checker_.feed(protocol::Side::kClient, bytes, time_);
  server_.receive(bytes);
  take();
}

void Line::take() {
  const auto bytes = server_.take_output();
  checker_.feed(protocol::Side::kServer, bytes, time_);
  received_.insert(received_.end(), bytes.begin(), bytes.end());
}

void Line::wait(double seconds) {
  for (int i = 0; i < static_cast<int>(std::lround(seconds / sim::kTick)); ++i) {
    server_.advance(1);
    time_ += sim::kTick;
    take();
  }
}

std::optional<Wire> Line::next() {
  // Their receivers: FA FB, a count, and a right checksum.
  while (received_.size() >= 3) {
    const std::size_t size = 3U + received_[2];
    if (received_[0] != 0xFA || received_[1] != 0xFB || received_.size() < size) {
      if (received_[0] == 0xFA && received_[1] == 0xFB)
        return std::nullopt;
      received_.erase(received_.begin());
      continue;
    }
    Wire body(received_.begin() + 3, received_.begin() + static_cast<std::ptrdiff_t>(size - 2));
    const Wire whole(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(size));
    received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(size));
    if (packet(body) == whole)
      return body;
  }
  return std::nullopt;
}

std::optional<Wire> Line::expect(const std::function<bool(const Wire&)>& property, double seconds) {
  const double until = now() + seconds;
  while (true) {
    while (const auto body = next())
      if (property(*body))
        return body;
    if (now() >= until - 1e-9)
      return std::nullopt;
    wait(sim::kTick);
  }
}

std::string Line::violations() const {
  std::string out;
  for (const auto& finding : checker_.findings())
    if (finding.kind == protocol::Finding::Kind::kViolation)
      out += to_string(finding) + "\n";
  return out;
}

namespace {
constexpr double kP1 = 2.0 * kPi / 1024.0;  // [rad] of one unit of heading
constexpr double kP2 = 2.0 * kPi / 4096.0;
}  // namespace

// From ARIA's and Player's tables.
const std::vector<KnownRobot>& all_known() {
  static const std::vector<KnownRobot> robots{
      {"pion1m", kP1, 0.05066, 2.5332, 0.1734, 7, false, 3, 130},
      {"pion1x", kP1, 0.05066, 2.5332, 0.1734, 7, false, 3, 130},
      {"psos1m", kP1, 0.05066, 2.5332, 0.1734, 7, false, 3, 130},
      {"psos1x", kP1, 0.05066, 2.5332, 0.1734, 7, false, 3, 130},
      {"psos43m", kP1, 0.05066, 2.5332, 0.1734, 7, false, 3, 130},
      {"pionat", kP1, 0.07, 2.5332, 0.1734, 7, false, 3, 130},
      {"p2dx", kP2, 0.84, 1, 0.268, 16, true, 3, 166},
      {"p2de", kP2, 0.969, 1, 0.268, 16, true, 3, 166},
      {"p2ce", kP2, 0.826, 1, 0.268, 16, true, 3, 166},
      {"p2df", kP2, 0.485, 1, 0.268, 16, true, 3, 166},
      {"p2d8", kP2, 0.485, 1, 1, 16, true, 3, 166},
      {"p2d8+", kP2, 0.485, 1, 1, 16, true, 3, 166},
      {"p2at", kP2, 1.32, 1, 0.268, 16, true, 3, 245},
      {"p2at8", kP2, 1.32, 1, 1, 16, true, 3, 245},
      {"p2at8+", kP2, 0.465, 1, 1, 16, true, 3, 245},
      {"p3dx", kP2, 0.485, 1, 1, 16, true, 3, 166},
      {"p3dx-sh", kP2, 1, 1, 1, 16, true, 3, 166},
      {"p3at", kP2, 0.465, 1, 1, 16, true, 3, 245},
      {"p3at-sh", kP2, 1, 1, 1, 16, true, 3, 245},
      {"amigo", kP2, 0.5083, 0.6154, 1, 8, true, 2, 150},
      {"amigo-sh", kP2, 1, 1, 1, 8, true, 2, 150},
      {"p2pb", kP2, 0.424, 1, 0.268, 24, true, 3, 166},
      {"p2pp", kP2, 0.485, 1, 0.268, 24, true, 3, 166},
      {"perfpb", kP2, 0.485, 1, 1, 32, true, 3, 166},
      {"perfpb+", kP2, 0.485, 1, 1, 32, true, 3, 166},
      {"peoplebot-sh", kP2, 1, 1, 1, 32, true, 3, 166},
      {"powerbot", kP2, 0.5813, 1, 1, 32, true, 3, 414},
      {"powerbot-sh", kP2, 1, 1, 1, 32, true, 3, 414},
      {"patrolbot-sh", kP2, 1, 1, 1, 16, true, 3, 166},
  };
  return robots;
}

const KnownRobot* find_known(const std::string& subclass) {
  const std::string name = lowered(subclass);
  for (const KnownRobot& robot : all_known())
    if (robot.subclass == name)
      return &robot;
  return nullptr;
}

std::string test_name(std::string robot) {
  std::replace(robot.begin(), robot.end(), '-', '_');
  std::replace(robot.begin(), robot.end(), '+', 'p');
  return robot;
}

}  // namespace saphira::test
