#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <utility>

#include "saphira/base/identity.hpp"
#include "saphira/base/withdraw.hpp"
#include "saphira/idl/request.hpp"

namespace saphira::bus {

/// The server's side of the requests on one topic: each is begun once, its newest answer is told
/// again when it comes again, and it has one end. Without bus and clock: the caller passes on what
/// has come, and writes the answers. It knows the newest 256 requests under way and the newest 256
/// that have ended. A request is its sender's: askers and numbers are public, and a member of a
/// secured bus that uses those of another repeats, withdraws and forestalls nothing of theirs.
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

  /// A request has come. sender: the member that has written it [none on an open bus]. True: it is
  /// to be begun, and is under way from now on.
  bool hear(const v1::Request& request, const Identity* sender = nullptr) {
    if (request.service != address_ && (routed_ || !request.service.empty()))
      return false;
    if (!routed_ && request.number == 0)
      return true;
    const bool withdrawn = request.functor == kWithdraw;
    const std::string member = sender ? sender->name : std::string();
    const Known* own = nullptr;
    bool is_of_another = false;
    for (const Known& known : known_)
      if (known.answer.asker == request.asker && known.answer.number == request.number) {
        if (known.member == member)
          own = &known;
        else
          is_of_another = true;
      }
    if (withdrawn && is_of_another && !(own && own->begun))
      return false;
    if (own) {
      if (withdrawn && stop_ && !is_end(*own))
        stop_(request);
      if (!own->answer.service.empty())
        tell_(own->answer);
      return false;
    }
    forget(is_end);
    forget(std::not_fn(is_end));
    known_.push_back({member, !withdrawn, {.asker = request.asker, .number = request.number}});
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
    Known* const known = find(asker, number);
    if (known != nullptr && is_end(*known)) {
      if (!std::exchange(warned_, true))
        warn_("request " + std::to_string(number) +
              " has ended: a further answer is not told: " + answer.text);
      return false;
    }
    tell_(answer);
    if (known != nullptr)
      known->answer = std::move(answer);
    return true;
  }
  /// Called, perhaps repeatedly, when a request that is under way is withdrawn.
  void when_withdrawn(Stop stop) { stop_ = std::move(stop); }

 private:
  static constexpr std::ptrdiff_t kMost = 256;

  struct Known {
    std::string member;
    bool begun;         ///< else it was withdrawn before
    v1::Answer answer;  ///< the newest; no service: none yet
  };

  /// The oldest of a kind, where there are too many of it.
  template <class Kind>
  void forget(Kind kind) {
    if (std::count_if(known_.begin(), known_.end(), kind) >= kMost)
      known_.erase(std::find_if(known_.begin(), known_.end(), kind));
  }
  static bool is_end(const Known& known) { return known.answer.code != v1::ANSWER_UNDERWAY; }
  /// The one that has not ended, where two members use the same numbers; else the newest.
  Known* find(std::uint64_t asker, std::uint64_t number) {
    Known* found = nullptr;
    for (Known& known : known_)
      if (known.answer.asker == asker && known.answer.number == number &&
          (found == nullptr || is_end(*found)))
        found = &known;
    return found;
  }

  std::string address_;
  bool routed_;
  Tell tell_;
  Warn warn_;
  Stop stop_;
  bool warned_ = false;
  std::deque<Known> known_;  ///< oldest request first
};

}  // namespace saphira::bus
