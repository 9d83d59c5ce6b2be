#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "saphira/idl/request.hpp"

namespace saphira::bus {

/// The newest requests to a program, each with its end or the newest answer: a repeated one is
/// carried out once.
class KnownRequests {
 public:
  /// The newest answer to a request. nullptr: it is new, and from now on under way.
  const v1::Answer* find(std::uint64_t asker, std::uint64_t number) {
    if (v1::Answer* const known = place(asker, number))
      return known;
    answers_.push_back({.asker = asker, .number = number, .code = v1::ANSWER_UNDERWAY});
    if (answers_.size() > kMost)
      answers_.pop_front();
    return nullptr;
  }
  /// Keeps the answer to a request under way. An end stays: a later answer is not kept.
  void keep(const v1::Answer& answer) {
    v1::Answer* const known = place(answer.asker, answer.number);
    if (known != nullptr && known->code == v1::ANSWER_UNDERWAY)
      *known = answer;
  }

 private:
  static constexpr std::size_t kMost = 256;

  v1::Answer* place(std::uint64_t asker, std::uint64_t number) {
    const auto found = std::find_if(answers_.begin(), answers_.end(), [&](const auto& one) {
      return one.asker == asker && one.number == number;
    });
    return found == answers_.end() ? nullptr : &*found;
  }

  std::deque<v1::Answer> answers_;  ///< oldest first
};

}  // namespace saphira::bus
