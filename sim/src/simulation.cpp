#include "saphira/sim/simulation.hpp"

#include <algorithm>

namespace saphira::sim {

RobotNumber Simulation::add(const protocol::RobotParameters& parameters, const Pose& start_in_world,
                            ServerOptions options) {
  options.keeps_time = false;
  Member member;
  member.waited_for = options.single_step;
  member.server = std::make_unique<Server>(scene_, parameters, start_in_world, options);
  servers_.push_back(std::move(member));
  return servers_.size() - 1;
}

void Simulation::receive(RobotNumber number, protocol::ByteView bytes) {
  servers_[number].server->receive(bytes);
  settle();
}

void Simulation::disconnect(RobotNumber number) {
  servers_[number].server->disconnect();
  settle();
}

void Simulation::gap(RobotNumber number) {
  servers_[number].server->gap();
  settle();
}

void Simulation::tick() {
  for (const Member& member : servers_)
    member.server->begin_tick();
  scene_.tick();
  for (const Member& member : servers_)
    member.server->end_tick();
}

bool Simulation::step_due() const {
  bool any = false;
  for (const Member& member : servers_) {
    if (member.waited_for && !member.was_open)
      return false;
    if (!member.server->is_open() || !member.server->single_step())
      continue;
    if (!member.server->step_asked())
      return false;
    any = true;
  }
  return any;
}

// Advances time after the clients' commands.
void Simulation::settle() {
  while (true) {
    bool open = false;
    bool rest = false;
    for (Member& member : servers_) {
      open |= member.server->is_open();
      member.was_open |= member.server->is_open();
      rest |= !member.server->is_open() && member.server->rest_asked();
    }
    if (step_due()) {
      for (int i = 0; i < kTicksPerPacket; ++i)
        tick();
      for (const Member& member : servers_)
        if (member.server->step_asked())
          member.server->end_step();
    } else if (rest && !open) {
      tick();
    } else {
      return;
    }
  }
}

void Simulation::advance(int ticks) {
  for (int i = 0; i < ticks && runs(); ++i) {
    for (const Member& member : servers_)
      member.server->quiet_tick();
    settle();
    tick();
  }
}

bool Simulation::runs() const {
  bool any = false;
  for (const Member& member : servers_) {
    if (member.server->is_open() && member.server->single_step())
      return false;
    any |= member.server->runs();
  }
  return any;
}

int Simulation::ticks_to_packet() const {
  int least = kTicksPerPacket;
  for (const Member& member : servers_)
    if (member.server->runs())
      least = std::min(least, member.server->ticks_to_packet());
  return least;
}

}  // namespace saphira::sim
