#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <utility>

#include "saphira/base/withdraw.hpp"
#include "saphira/idl/request.hpp"

namespace saphira::bus {

/// The server's side of the requests on one topic: each is begun once, its newest answer is told
/// again when it comes again, and it has one end. Without bus and clock: the caller passes on what
/// has come, and writes the answers. It knows the newest 256 requests under way and the newest 256
/// that have ended.
class RequestServer {
 public:
  using Tell = std::function<void(const v1::Answer&)>;
  using Warn = std::function<void(const std::string&)>;
  using Stop = std::function<void(const v1::Request&)>;

  /// address: Request.service of this server, and Answer.service. routed: each request is by a
  /// router, which names the server, and repeats its requests whatever their number. Without a
  /// router a request may name nobody, and one with number 0 is always new.
  RequestServer(std::string address, bool routed, Tell tell, Warn warn)
      : address_(std::move(address)),
        routed_(routed),
        tell_(std::move(tell)),
        warn_(std::move(warn)) {}

  /// A request has come. True: it is to be begun, and is under way from now on.
  bool hear(const v1::Request& request) {
    if (request.service != address_ && (routed_ || !request.service.empty()))
      return false;
    if (!routed_ && request.number == 0)
      return true;
    const bool withdrawn = request.functor == kWithdraw;
    if (const v1::Answer* const known = find(request.asker, request.number)) {
      if (withdrawn && stop_ && !is_end(*known))
        stop_(request);
      if (!known->service.empty())
        tell_(*known);
      return false;
    }
    forget(is_end);
    forget(std::not_fn(is_end));
    known_.push_back({.asker = request.asker, .number = request.number});
    if (withdrawn)
      answer(request.asker, request.number,
             {.code = v1::ANSWER_REFUSED, .text = "withdrawn before it was begun"});
    return !withdrawn;
  }
  /// Tells an answer, and fills in asker, number and service. False, and nothing is told: the
  /// request has ended.
  bool answer(std::uint64_t asker, std::uint64_t number, v1::Answer answer) {
    answer.asker = asker;
    answer.number = number;
    answer.service = address_;
    v1::Answer* const known = find(asker, number);
    if (known != nullptr && is_end(*known)) {
      if (!std::exchange(warned_, true))
        warn_("request " + std::to_string(number) +
              " has ended: a further answer is not told: " + answer.text);
      return false;
    }
    tell_(answer);
    if (known != nullptr)
      *known = std::move(answer);
    return true;
  }
  /// Called, perhaps repeatedly, when a request that is under way is withdrawn.
  void when_withdrawn(Stop stop) { stop_ = std::move(stop); }

 private:
  static constexpr std::ptrdiff_t kMost = 256;

  /// The oldest of a kind, where there are too many of it.
  template <class Kind>
  void forget(Kind kind) {
    if (std::count_if(known_.begin(), known_.end(), kind) >= kMost)
      known_.erase(std::find_if(known_.begin(), known_.end(), kind));
  }
  static bool is_end(const v1::Answer& answer) { return answer.code != v1::ANSWER_UNDERWAY; }
  v1::Answer* find(std::uint64_t asker, std::uint64_t number) {
    const auto found = std::find_if(known_.begin(), known_.end(), [&](const v1::Answer& one) {
      return one.asker == asker && one.number == number;
    });
    return found == known_.end() ? nullptr : &*found;
  }

  std::string address_;
  bool routed_;
  Tell tell_;
  Warn warn_;
  Stop stop_;
  bool warned_ = false;
  std::deque<v1::Answer> known_;  ///< newest answers, oldest request first; no service: none yet
};

}  // namespace saphira::bus
