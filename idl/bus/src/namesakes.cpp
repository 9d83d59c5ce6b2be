#include "saphira/bus/namesakes.hpp"

#include <algorithm>

#include "neighbours.hpp"
#include "saphira/bus/introspect.hpp"

namespace saphira::bus {
namespace {

// For the status of a program of the same name that has announced itself.
constexpr std::chrono::seconds kAwaited{2};

}  // namespace

struct Namesakes::Impl {
  explicit Impl(Node& the_node) : node(the_node), statuses(the_node.reader(topics::kStatus)) {}

  bool may_serve() const {
    if (acted || Clock::now() - made > kAwaited)
      return false;
    return std::ranges::any_of(found_programs(node), [&](const ProgramEntry& other) {
      return other.robot == node.options().robot && other.kind() == node.status().name &&
             !other.silent && !other.refused && !neighbours.knows(other.id);
    });
  }

  Node& node;
  Reader<v1::ServiceStatus> statuses;
  internal::Neighbours neighbours;
  const Clock::time_point made = Clock::now();
  bool acted = false;
  bool waits = false;
  bool served = false;  // another one, at some time
};

Namesakes::Namesakes(Node& node) : impl_(std::make_unique<Impl>(node)) {}
Namesakes::~Namesakes() = default;

bool Namesakes::poll() {
  Impl& self = *impl_;
  v1::ServiceStatus& own = self.node.status();
  for (const WriterId& gone : self.statuses.take_lost())
    self.neighbours.lose(gone);
  const Checked member = self.node.identity();
  self.statuses.visit([&](const v1::ServiceStatus& other, const SampleInfo& info) {
    if (info.disposed)
      self.neighbours.lose(info.writer);
    else if (other.instance != own.instance && may_be_of_a_kind(member, info.sender.get()))
      self.neighbours.update(info.writer, other, Clock::now());
  });
  if (const auto other = self.neighbours.serves_instead(own)) {
    own.state = v1::SERVICE_WAITING;
    own.reason = *other;
    self.served = true;
    return self.waits = true;
  }
  return self.waits = self.may_serve();
}

bool Namesakes::waits() const {
  return impl_->waits;
}

void Namesakes::act() {
  impl_->acted = true;
}

bool Namesakes::superseded() const {
  return impl_->served && !impl_->waits;
}

bool Namesakes::stepping_since(Clock::time_point since) const {
  return impl_->neighbours.stepping_since(since, Clock::now());
}

}  // namespace saphira::bus
