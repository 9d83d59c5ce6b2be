#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "saphira/bus/audit.hpp"
#include "saphira/bus/known_requests.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/requests/request.hpp"

namespace saphira {

/// Takes requests from the bus and answers them. Checks each against the table of functors, hands
/// out a repeated request once, and logs requests. For the node's own thread.
class Desk {
 public:
  /// A desk has one topic of answers.
  Desk(bus::Node& node, const bus::Topic<v1::Answer>& answers);

  void serve(const bus::RequestTopic& topic, std::vector<Functor> functors);

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
  /// A later answer.
  void answer(std::uint64_t asker, std::uint64_t number, const Answer& answer);

  /// Failed requests since the start.
  std::uint64_t refused() const { return refused_; }

 private:
  struct Counter {
    bus::Reader<v1::Request> reader;
    std::vector<Functor> functors;
    std::vector<Request> waiting{};  ///< lockstep: whose cycle has not come
    bool asked = false;              ///< there was an asker at the last look
    bus::KnownRequests known{};      ///< of this topic: nobody spoils a request on another one
  };
  void take(Counter& counter, std::vector<Request>& out);
  /// Writes an answer, for repeated requests as well: on the topics with that functor, or on all.
  void send(std::uint64_t asker, std::uint64_t number, const Answer& answer,
            const std::string& functor);

  bus::Node& node_;
  bus::Writer<v1::Answer> writer_;
  std::vector<std::unique_ptr<Counter>> counters_;
  v1::Stamp now_;
  std::uint64_t refused_ = 0;
  std::optional<bus::Audit> audit_;
};

}  // namespace saphira
