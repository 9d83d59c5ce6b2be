#include "saphira/reflector/connection.hpp"

#include <algorithm>
#include <utility>

#include "saphira/protocol/information.hpp"

namespace saphira::reflector {

namespace {

// The answer to SYNC2 is long: on a bad line it needs many tries.
constexpr int kTries = 20;
constexpr std::uint8_t kVelocity = 11;  // the first of the zero setpoints

int sync_of(Connection::State state) {
  return static_cast<int>(state) - static_cast<int>(Connection::State::sync0);
}

Packets zero_setpoints() {
  return {protocol::encode(protocol::Velocity{0.0}),
          protocol::encode(protocol::RotationVelocity{0.0})};
}

}  // namespace

Packets Connection::go(State state, double now) {
  if (state != state_) {
    tries_ = 0;
    began_ = now;
  }
  state_ = state;
  sent_ = now;
  ++tries_;
  if (state == State::open)
    return {protocol::encode(protocol::Open{})};
  Packets out;
  if (state == State::sync0 && in_session_)
    out = zero_setpoints();
  out.push_back(protocol::encode_sync(sync_of(state)));
  return out;
}

Packets Connection::begin(double now, bool in_session) {
  identity_ = {};
  nameless_ = false;
  state_ = State::closed;
  in_session_ = in_session;
  answered_ = now;
  return go(State::sync0, now);
}

Packets Connection::packet(protocol::ByteView body, double now) {
  if (body.empty() || state_ == State::closed || state_ == State::open)
    return {};
  if (protocol::is_information(body[0])) {
    // The server is still open from a session before. One reaction per while is enough: these
    // packets may have been on their way.
    if (now - sent_ < kRetry / 2.0 && tries_ > 1)
      return {};
    Packets out = zero_setpoints();
    out.push_back(protocol::encode(protocol::Close{}));
    go(State::sync0, now);
    out.push_back(protocol::encode_sync(0));
    tries_ = 2;
    return out;
  }
  if (state_ == State::sync2 && nameless_ && body[0] == kVelocity) {
    echoes_ = true;
    return {};
  }
  if (protocol::sync_number(body) != sync_of(state_))
    return {};
  const bool nameless = state_ == State::sync2 && body.size() == 1;
  if (nameless && (echoes_ || !std::exchange(nameless_, true)))
    return zero_setpoints();
  answered_ = now;
  if (state_ != State::sync0 && !nameless)
    round_trip_ = state_ == State::sync1 ? now - began_ : std::min(round_trip_, now - began_);
  switch (state_) {
    case State::sync0:
      return go(State::sync1, now);
    case State::sync1:
      return go(State::sync2, now);
    case State::sync2:
      identity_ = protocol::decode_sync2_reply(body).value_or(protocol::RobotIdentity{});
      echoes_ = false;
      return go(State::open, now);
    default:
      return {};
  }
}

Packets Connection::tick(double now) {
  if (state_ == State::closed || state_ == State::open || now < due() - 1e-9)
    return {};
  return go(tries_ >= kTries ? State::sync0 : state_, now);
}

bool Connection::is_hopeless(double now) const {
  return state_ != State::closed && state_ != State::open && now - answered_ > kPatience;
}

std::string Connection::waiting_for() const {
  if (echoes_ && !open())
    return "a robot: the line echoes every byte, so no robot is connected to it (an echo "
           "in a "
           "modem or terminal server, or a plug with its pins joined?)";
  switch (state_) {
    case State::closed:
      return "a link to the robot";
    case State::open:
      return "";
    default:
      return "the robot to answer SYNC" + std::to_string(sync_of(state_)) +
             (state_ == State::sync0 ? " (is it switched on, and the cable in?)" : "");
  }
}

}  // namespace saphira::reflector
