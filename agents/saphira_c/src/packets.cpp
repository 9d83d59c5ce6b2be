// Communication with the robot server without the OS (manual 8.6 and 4.3.5), and the connection
// itself.

#include <poll.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "os.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/protocol/packet.hpp"
#include "saphira/reflector/connection.hpp"
#include "saphira/transport/link.hpp"

using namespace saphira;
using c::Os;

namespace {

constexpr double kConnectTime = 8.0;  // [s] of a connection
constexpr double kAtLeast = 0.1;      // [s] least wait of sfWaitClientPacket (manual 8.6)
constexpr int kOdometryFrame = 1;

/// A line to the robot server, and its present packet. Only the program's own calls serve it.
class Line {
 public:
  explicit Line(const std::string& address) : link_(transport::parse_address(address)) {}

  /// Opens until the server has identified itself. `why` gives the reason of a failure.
  bool open(std::string& why) {
    const double until = BootClock::seconds() + kConnectTime;
    bool begun = false;
    while (BootClock::seconds() < until) {
      const double now = BootClock::seconds();
      link_.advance(now);
      if (link_.state() == transport::Link::State::open) {
        send_all(begun ? connection_.tick(now) : connection_.begin(now, true));
        begun = true;
        for (auto body = next(); body; body = next())
          send_all(connection_.packet(*body, BootClock::seconds()));
        if (connection_.open())
          return describe(why);
      }
      wait(0.02);
    }
    why =
        link_.state() == transport::Link::State::open ? connection_.waiting_for() : link_.trouble();
    return false;
  }

  bool send(const protocol::Bytes& bytes) { return link_.write(bytes, BootClock::seconds()); }

  /// The next whole packet within so many seconds; one that is there unread is the next.
  bool have(double seconds) {
    if (there_ && at_ == 0)
      return true;
    const double until = BootClock::seconds() + seconds;
    while (true) {
      if (std::optional<protocol::Bytes> body = next()) {
        packet_ = std::move(*body);
        at_ = 0;
        there_ = true;
        return true;
      }
      const double left = until - BootClock::seconds();
      if (left <= 0.0 || link_.state() != transport::Link::State::open)
        return false;
      wait(std::min(left, 0.05));
    }
  }

  /// The packet is parsed into the state reflector's structures.
  void process() {
    if (!there_ && !have(1.0))
      return;
    there_ = false;
    const protocol::ServerPacket any = protocol::decode_packet(packet_);
    const auto* const information = std::get_if<protocol::InformationPacket>(&any);
    if (information == nullptr)
      return;
    reflector_.packet(*information, BootClock::seconds(), kOdometryFrame);
    Os::get().reflect(reflector_.state(), parameters_);
  }
  void reset() {
    reflector_ = {};
    reflector_.configure(parameters_);
    reflector_.open(BootClock::seconds(), std::nullopt, kOdometryFrame);
  }

  /// The next bytes of the packet as a number; 0 behind its end.
  std::uint32_t read(std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
      value |= static_cast<std::uint32_t>(at_ < packet_.size() ? packet_[at_++] : 0U) << (8U * i);
    return value;
  }
  int left() const { return static_cast<int>(packet_.size() - at_); }

  void close() {
    send(protocol::encode(protocol::Velocity{0.0}));
    send(protocol::encode(protocol::RotationVelocity{0.0}));
    send(protocol::encode(protocol::Close{}));
    link_.close("the program ends");
  }

 private:
  bool describe(std::string& why) {
    const protocol::RobotIdentity& robot = connection_.identity();
    try {
      parameters_ = protocol::parameters_of(robot, c::configuration() + "/robots");
    } catch (const std::exception& error) {
      why = error.what();
      return false;
    }
    c::show_names(robot);
    reset();
    return true;
  }
  void send_all(const reflector::Packets& packets) {
    for (const protocol::Bytes& packet : packets)
      send(packet);
  }
  std::optional<protocol::Bytes> next() {
    if (auto body = parser_.next())
      return body;
    std::vector<std::uint8_t> bytes;
    if (link_.state() == transport::Link::State::open)
      link_.read(bytes, BootClock::seconds());
    parser_.feed(bytes);
    return parser_.next();
  }
  void wait(double seconds) {
    pollfd fd{link_.fd(), link_.poll_events(), 0};
    ::poll(&fd, 1, std::max(1, static_cast<int>(std::lround(seconds * 1000.0))));
  }

  transport::Link link_;
  reflector::Connection connection_;
  protocol::PacketParser parser_;
  reflector::Reflector reflector_;
  protocol::RobotParameters parameters_;
  protocol::Bytes packet_;
  std::size_t at_ = 0;
  bool there_ = false;
};

std::unique_ptr<Line>& line() {
  static auto* const the_line = new std::unique_ptr<Line>();
  return *the_line;
}

Line* open_line(const char* function) {
  if (!line() && !Os::get().started())
    Os::get().say(std::string(function) + ": no robot is connected: call sfConnectToRobot first",
                  true);
  else if (!line())
    Os::get().say(std::string(function) +
                      ": the OS reads the packets, since sfStartup was called (manual 8.6)",
                  true);
  return line().get();
}

/// The address of the manual's port; empty for an unknown port.
std::string address_of(int port, const char* name) {
  const auto given = [&](const char* variable) {
    const char* const value = std::getenv(variable);
    return value != nullptr && *value != '\0' ? std::string(value) : std::string(name);
  };
  if (name == nullptr)
    return {};
  if (const std::string on_bus = saphira::c::robot_of_environment(); !on_bus.empty())
    return on_bus;
  if (port == sfLOCALPORT)
    return std::strcmp(name, sfCOMLOCAL) == 0 ? transport::default_address() : name;
  if (port == sfTTYPORT)
    return std::strcmp(name, sfCOM1) == 0   ? given("SAPHIRA_COM1")
           : std::strcmp(name, sfCOM2) == 0 ? given("SAPHIRA_COM2")
                                            : name;
  if (port == sfBUSPORT)
    return std::string(saphira::c::kOnBus) + name;
  if (port != sfTCPPORT)
    return {};
  const std::string host = name;
  return "tcp:" + (host.find(':') == std::string::npos ? host + ":8101" : host);
}

bool drives(int command) {
  using enum protocol::Number;
  static constexpr protocol::Number kDriving[]{kOpen,
                                               kClose,
                                               kMove,
                                               kRotate,
                                               kVelocity,
                                               kHeading,
                                               kDeltaHeading,
                                               kRotationVelocity,
                                               kWheelVelocities,
                                               kDeltaSetpoint,
                                               kLateralVelocity,
                                               kStep};
  return std::find(std::begin(kDriving), std::end(kDriving),
                   static_cast<protocol::Number>(command)) != std::end(kDriving);
}

void command(const char* function, int number, protocol::Bytes argument) {
  if (number < 0 || number > 255)
    return Os::get().say(std::string(function) + ": expected a command number of 0 to 255", true);
  protocol::Bytes body = std::move(argument);
  body.insert(body.begin(), static_cast<std::uint8_t>(number));
  if (body.size() > protocol::kMaxBody)
    return Os::get().say(std::string(function) + ": the string does not fit into a packet", true);
  if (Os::get().started()) {
    if (drives(number))
      return Os::get().say(std::string(function) + ": command " + std::to_string(number) +
                               " would drive the robot beside the state reflector (manual 8.6): "
                               "use sfSetVelocity and the others",
                           true);
    return Os::get().send(protocol::frame(body));
  }
  if (Line* const to = open_line(function))
    to->send(protocol::frame(body));
}

std::uint8_t low(int value) {
  return static_cast<std::uint8_t>(static_cast<unsigned>(value) & 0xFFU);
}
std::uint8_t high(int value) {
  return low(static_cast<int>(static_cast<unsigned>(value) >> 8U));
}

protocol::Bytes three(int type, std::uint8_t first, std::uint8_t second) {
  protocol::Bytes bytes;
  for (const std::uint8_t byte : {low(type), first, second})
    bytes.push_back(byte);
  return bytes;
}

std::uint32_t read(const char* function, std::size_t bytes) {
  Line* const from = open_line(function);
  return from == nullptr ? 0 : from->read(bytes);
}

}  // namespace

extern "C" {

const char* sfCOMLOCAL = "local";
const char* sfCOM1 = "/dev/ttyS0";
const char* sfCOM2 = "/dev/ttyS1";
char sfRobotName[64], sfRobotClass[64], sfRobotSubclass[64];

int sfConnectToRobot(int port, const char* name) {
  const std::string address = address_of(port, name);
  if (address.empty()) {
    Os::get().say(name == nullptr
                      ? "sfConnectToRobot: the name is NULL"
                      : "sfConnectToRobot: expected sfLOCALPORT, sfTTYPORT, sfTCPPORT or sfBUSPORT",
                  true);
    return 0;
  }
  if (Os::get().started())
    return Os::get().connect(address) ? 1 : 0;
  if (address.starts_with(saphira::c::kOnBus)) {
    Os::get().say(
        "sfConnectToRobot: there are no packets on the bus: call sfStartup before, or talk "
        "to the robot's own server (sfLOCALPORT and others, with SAPHIRA_ROBOT unset)",
        true);
    return 0;
  }
  try {
    line() = std::make_unique<Line>(address);
    std::string why;
    if (line()->open(why)) {
      std::atexit([] { sfDisconnectFromRobot(); });
      return 1;
    }
    Os::get().say("no robot at " + address + ": " + why, true);
  } catch (const std::exception& error) {
    Os::get().say(error.what(), true);
  }
  line().reset();
  return 0;
}

void sfDisconnectFromRobot(void) {
  if (line()) {
    line()->close();
    line().reset();
  } else {
    Os::get().disconnect();
  }
}

int sf_is_connected(void) {
  if (Os::get().started())
    return Os::get().connected() ? 1 : 0;
  return line() ? 1 : 0;
}

void sfResetRobotVars(void) {
  if (line())
    line()->reset();
}

void sfRobotCom(int com) {
  command("sfRobotCom", com, {});
}
void sfRobotComInt(int com, int arg) {
  const int size = std::min(std::abs(arg), 0xFFFF);
  command("sfRobotComInt", com, three(arg < 0 ? 0x1B : 0x3B, low(size), high(size)));
}
void sfRobotCom2Bytes(int com, int b1, int b2) {
  command("sfRobotCom2Bytes", com, three(0x3B, low(b2), low(b1)));
}
void sfRobotComStr(int com, const char* str) {
  if (str == nullptr)
    return Os::get().say("sfRobotComStr: the string is NULL", true);
  protocol::Bytes argument(str, str + std::strlen(str) + 1);
  argument.insert(argument.begin(), 0x2B);
  command("sfRobotComStr", com, std::move(argument));
}
void sfRobotComStrn(int com, const char* str, int n) {
  if (str == nullptr || n < 0 || n > 255)
    return Os::get().say(str == nullptr ? "sfRobotComStrn: the string is NULL"
                                        : "sfRobotComStrn: expected 0 to 255 characters",
                         true);
  protocol::Bytes argument;
  argument.reserve(static_cast<std::size_t>(n) + 2);
  argument.push_back(0x2B);
  argument.push_back(low(n));
  std::copy(str, str + n, std::back_inserter(argument));
  command("sfRobotComStrn", com, std::move(argument));
}

int sfWaitClientPacket(int ms) {
  Line* const from = open_line("sfWaitClientPacket");
  return from != nullptr && from->have(std::max(ms / 1000.0, kAtLeast)) ? 1 : 0;
}
int sfHaveClientPacket(void) {
  Line* const from = open_line("sfHaveClientPacket");
  return from != nullptr && from->have(0.0) ? 1 : 0;
}
void sfProcessClientPacket(int) {
  if (Line* const from = open_line("sfProcessClientPacket"))
    from->process();
}
int sfClientBytes(void) {
  Line* const from = open_line("sfClientBytes");
  return from == nullptr ? 0 : from->left();
}
int sfReadClientByte(void) {
  return static_cast<int>(read("sfReadClientByte", 1));
}
int sfReadClientSint(void) {
  return static_cast<std::int16_t>(read("sfReadClientSint", 2));
}
int sfReadClientUsint(void) {
  return static_cast<int>(read("sfReadClientUsint", 2));
}
int sfReadClientWord(void) {
  return static_cast<int>(read("sfReadClientWord", 4));
}
char* sfReadClientString(void) {
  static char text[256];
  std::size_t length = 0;
  for (auto c = read("sfReadClientString", 1); c != 0 && length < sizeof text - 1;
       c = read("sfReadClientString", 1))
    text[length++] = static_cast<char>(c);
  text[length] = '\0';
  return text;
}

}  // extern "C"
