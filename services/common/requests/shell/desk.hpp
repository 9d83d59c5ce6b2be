#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "saphira/bus/audit.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/requests/request.hpp"

namespace saphira {

/// Takes requests from the bus and answers them. Checks each against the table of functors, carries
/// out a repeated request once, and logs requests. For the node's own thread.
class Desk {
 public:
  /// Carries out a checked request. Nothing: the answer follows (Desk::answer).
  using Act = std::function<std::optional<Answer>(const Request&)>;

  /// A desk has one topic of answers.
  Desk(bus::Node& node, const bus::Topic<v1::Answer>& answers);

  void serve(const bus::RequestTopic& topic, std::vector<Functor> functors, Act act);

  /// Carries out new requests. `now`: the newest step of this program.
  void take(const v1::Stamp& now);
  /// The result of a request that was taken earlier.
  void answer(std::uint64_t asker, std::uint64_t number, const Answer& answer);

  /// Failed requests since the start.
  std::uint64_t refused() const { return refused_; }

 private:
  using Id = std::pair<std::uint64_t, std::uint64_t>;  ///< asker, number
  struct Counter {
    bus::Reader<v1::Request> reader;
    std::vector<Functor> functors;
    Act act;
    std::vector<Request> waiting{};  ///< lockstep: whose cycle has not come
    bool asked = false;              ///< there was an asker at the last look
  };
  void take(Counter& counter);
  void handle(const Counter& counter, Request request);

  bus::Node& node_;
  bus::Writer<v1::Answer> writer_;
  std::vector<std::unique_ptr<Counter>> counters_;
  v1::Stamp now_;
  /// The newest requests, with the newest answer to each: oldest first.
  std::deque<std::pair<Id, std::optional<v1::Answer>>> known_;
  std::uint64_t refused_ = 0;
  std::optional<bus::Audit> audit_;
};

}  // namespace saphira
