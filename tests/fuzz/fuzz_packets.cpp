// Bytes from a line: through the parser in pieces, into every decoder, and into a whole server.
// Every packet from the parser must be a packet in the input, for any pieces.

#include <algorithm>
#include <cmath>

#include "fuzz.hpp"
#include "saphira/protocol/check.hpp"
#include "saphira/protocol/command.hpp"
#include "saphira/protocol/impossible.hpp"
#include "saphira/protocol/information.hpp"
#include "saphira/protocol/packet.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/sim/server.hpp"

namespace {

using namespace saphira;
using fuzz::require;

void decode_everything(const protocol::Bytes& body) {
  const protocol::Command command = protocol::decode_command(body);
  // A decoded command can be encoded again. (An unknown command's argument is not kept.)
  const protocol::Bytes again = protocol::encode(command);
  require(
      std::holds_alternative<protocol::Unknown>(command) ||
      protocol::decode_command(protocol::ByteView(again).subspan(3, again.size() - 5)).index() ==
          command.index());
  protocol::decode_sync2_reply(body);
  std::visit(
      [](const auto& packet) {
        const protocol::Bytes bytes = protocol::encode(packet);
        protocol::decode_packet(protocol::ByteView(bytes).subspan(3, bytes.size() - 5));
      },
      protocol::decode_packet(body));
  if (auto packet = protocol::decode_information(body)) {
    const protocol::RobotParameters parameters;
    protocol::ServerPacket possible = *packet;
    const auto impossible = protocol::take_out_impossible(possible, parameters);
    if (!impossible || !impossible->whole) {
      const auto in =
          protocol::interpret(std::get<protocol::InformationPacket>(possible), parameters);
      require(std::abs(in.velocity) <= 2.0 && std::abs(in.rotation_velocity) <= 7.0);
      require(std::abs(in.th) <= kPi && in.sonars.empty() && in.ptu <= protocol::kLongestPulse);
    }
    const protocol::Bytes copy = protocol::encode(*packet);
    const auto back =
        protocol::decode_information(protocol::ByteView(copy).subspan(3, copy.size() - 5));
    require(back.has_value());
    packet->unknown_bytes = 0;  // not written
    if (packet->sonars.size() <= protocol::kMaxSonarsInPacket)
      require(*back == *packet);
  }
}

// The checker survives any bytes, from either side.
void check(protocol::ByteView bytes) {
  protocol::Checker checker;
  for (int i = 0; i < 2; ++i) {
    checker.feed(protocol::Side::kClient, protocol::encode_sync(i));
    checker.feed(protocol::Side::kServer, protocol::encode_sync(i));
  }
  checker.feed(protocol::Side::kClient, protocol::encode_sync(2));
  checker.feed(protocol::Side::kServer, protocol::encode_sync2_reply({"a", "b", "c"}));
  checker.feed(protocol::Side::kClient, protocol::encode(protocol::Open{}));
  require(checker.violations() == 0);
  const std::size_t half = bytes.size() / 2;
  checker.feed(protocol::Side::kClient, bytes.first(half));
  checker.feed(protocol::Side::kServer, bytes.subspan(half));
  if (!bytes.empty()) {
    const auto body = bytes.first(std::min(bytes.size(), protocol::kMaxBody));
    checker.feed(protocol::Side::kClient, protocol::frame(body));
    checker.feed(protocol::Side::kServer, protocol::frame(body));
  }
  checker.disconnect();
  checker.summary();
}

void serve(protocol::ByteView bytes) {
  static const sim::World world =
      sim::parse_world("width 4000 height 4000 0 0 4000 0 4000 0 4000 4000", "fuzz.wld");
  protocol::RobotParameters parameters;
  parameters.sonars.resize(1);
  if (!bytes.empty()) {
    parameters.protocol = static_cast<protocol::Protocol>(bytes[0] % 3);
    parameters.gripper = parameters.gyro = parameters.move_command = (bytes[0] & 4U) != 0;
    parameters.settable_accelerations = parameters.settable_velocities = (bytes[0] & 8U) != 0;
    parameters.encoder_unit = 1e-5;
    parameters.front_bumpers = 5;
  }
  sim::Scene scene(world);
  sim::Server server(scene, parameters, {2.0, 2.0, 0.0}, {});
  for (int i = 0; i < 3; ++i)
    server.receive(protocol::encode_sync(i));
  server.receive(protocol::encode(protocol::Open{}));
  server.receive(protocol::encode(protocol::Enable{true}));
  server.receive(bytes);
  // Again with a frame around it, so that commands with damaged bodies arrive.
  if (!bytes.empty())
    server.receive(protocol::frame(bytes.first(std::min(bytes.size(), protocol::kMaxBody))));
  server.advance(30);
  server.disconnect();
  server.advance(1000);
  require(!server.robot().moving());
  require(server.robot().clearance() > -1e-9);
}

}  // namespace

void saphira::fuzz::run(std::string_view text) {
  const std::size_t size = text.size();
  const protocol::ByteView input(bytes_of(text), size);
  protocol::PacketParser parser;
  std::size_t at = 0;
  std::size_t piece = size > 0 ? input[0] : 0;
  auto from = input.begin();
  while (at < size) {
    piece = (piece * 31 + 7) % 61 + 1;
    const std::size_t length = std::min(piece, size - at);
    parser.feed(input.subspan(at, length));
    at += length;
    if (piece == 13)
      parser.gap();
    while (const auto body = parser.next()) {
      // In order, and each byte at most once.
      const protocol::Bytes packet = protocol::frame(*body);
      const auto found = std::search(from, input.end(), packet.begin(), packet.end());
      require(found != input.end());
      from = found + static_cast<std::ptrdiff_t>(packet.size());
      decode_everything(*body);
    }
  }
  require(parser.counters().skipped_bytes <= size);
  if (size > 0)
    decode_everything(protocol::Bytes(
        input.begin(),
        input.begin() + static_cast<std::ptrdiff_t>(std::min(size, protocol::kMaxBody))));
  check(input);
  serve(input);
}
