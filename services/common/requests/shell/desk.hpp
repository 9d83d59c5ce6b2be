#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "saphira/bus/audit.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/bus/request_server.hpp"
#include "saphira/requests/request.hpp"

namespace saphira {

/// Takes requests from the bus on one topic, and answers them. Checks each against the table of
/// functors, and logs requests. For the node's own thread.
class Desk {
 public:
  using Answers = std::shared_ptr<bus::Writer<v1::Answer>>;
  /// answers: of a program with several desks.
  Desk(bus::Node& node, const bus::RequestTopic& topic, std::vector<Functor> functors,
       Answers answers = {});

  /// The new requests that fit their functors, for answer(). `now`: the newest step of this
  /// program.
  std::vector<Request> take(const v1::Stamp& now);
  /// The outcome of a request that was taken. Nothing: it follows.
  void answer(const Request& request, const std::optional<Answer>& outcome);
  /// The outcomes of all that were taken, in their order.
  template <class Outcome>
  void answer(const std::vector<Request>& requests, const std::vector<Outcome>& outcomes) {
    for (std::size_t i = 0; i < requests.size(); ++i)
      answer(requests[i], outcomes[i]);
  }
  /// A later answer. False, and nothing is told: the request has ended.
  bool answer(std::uint64_t asker, std::uint64_t number, const Answer& answer);

  /// Failed requests since the start.
  std::uint64_t refused() const { return refused_; }

 private:
  bus::Node& node_;
  std::vector<Functor> functors_;
  bus::Reader<v1::Request> reader_;
  bus::RequestServer server_;
  bool asked_ = false;            ///< there was an asker at the last look
  std::vector<Request> waiting_;  ///< lockstep: whose cycle has not come
  v1::Stamp now_;
  std::uint64_t refused_ = 0;
  std::optional<bus::Audit> audit_;
};

}  // namespace saphira
