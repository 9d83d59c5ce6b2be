#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include "saphira/bus/node.hpp"

namespace saphira::bus {

/// Lets other programs watch and ask what runs on an in-memory bus: carries samples between that
/// bus and a node of the DDS bus.
///
/// Outwards goes what is written inside. Periodic topics are carried only while somebody outside
/// reads them. Inwards goes what is read inside, except what the inside itself writes periodically
/// or keeps (cyclic, latched): that has one source. An outside writer is one inside as well: when
/// it is lost outside, it is lost inside.
///
/// For one thread, which carries between the steps of what is inside. When it does that is outside
/// of any lockstep, as it is for programs that are not on the in-memory bus.
class Gateway {
 public:
  /// Of the topics that have endpoints inside now. `outside` outlives it.
  Gateway(Node& outside, std::shared_ptr<MemoryBus> inside);
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  /// Carries what has come on either side. Costs next to nothing where nothing has.
  void carry();
  /// Waits until something has come from outside, stop is requested or the time has run out.
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
