#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include "saphira/bus/node.hpp"

namespace saphira::bus {

/// Lets other programs watch and command the programs of an in-memory bus: carries samples between
/// that bus and a node of the DDS bus.
///
/// Outwards: samples written inside. Periodic topics are carried only while an outside program
/// reads them. Inwards: samples that are read inside, except periodic and latched topics (cyclic,
/// latched) that have a writer inside, since these have one source. An outside writer has a
/// counterpart inside: a writer lost outside is lost inside.
///
/// For one thread, which carries samples between the steps of the programs inside. Its timing is
/// outside of any lockstep, as for all programs that are not on the in-memory bus.
class Gateway {
 public:
  /// Carries the topics that have endpoints inside now. `outside` outlives the gateway.
  Gateway(Node& outside, std::shared_ptr<MemoryBus> inside);
  ~Gateway();

  /// Carries the samples that have come on either side. Nearly free where none have.
  void carry();
  /// Waits until a sample has come from outside, stop is requested or the time has run out.
  void wait(std::chrono::milliseconds timeout, const Stop& stop);

 private:
  struct Out;
  struct In;

  Node& outside_;
  std::unique_ptr<Node> inside_;
  std::vector<std::unique_ptr<Out>> outs_;
  std::vector<std::unique_ptr<In>> ins_;
  bool woken_ = true;
};

}  // namespace saphira::bus
