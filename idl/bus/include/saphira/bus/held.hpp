#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "saphira/bus/endpoint.hpp"

namespace saphira::bus {

/// The value of a latched topic without keys: the newest of a living writer. Where that writer has
/// left, it is the newest of the others, such as the service that ran before a second one came and
/// went. Where no writer lives, the last value stays, for a service that only restarts.
template <class T>
class Held {
 public:
  explicit Held(Reader<T> reader) : reader_(std::move(reader)) {}

  /// The values since the last call, oldest first; the last one is the present one.
  std::vector<T> take() {
    std::vector<T> values;
    for (auto& sample : reader_.take()) {
      if (sample.info.disposed)
        continue;
      std::erase_if(
          known_, [&](const Known& one) { return one.writer == sample.info.writer || !one.lives; });
      known_.push_back({sample.info.writer, sample.data});
      values.push_back(std::move(sample.data));
    }
    for (const WriterId& lost : reader_.take_lost()) {
      const auto left = std::find_if(known_.begin(), known_.end(),
                                     [&](const Known& one) { return one.writer == lost; });
      if (left == known_.end())
        continue;
      left->lives = false;
      if (known_.size() == 1)
        continue;
      const bool was_present = left + 1 == known_.end();
      known_.erase(left);
      if (was_present)
        values.push_back(known_.back().value);
    }
    return values;
  }

 private:
  struct Known {
    WriterId writer;
    T value;
    bool lives = true;
  };

  Reader<T> reader_;
  std::vector<Known> known_{};  ///< the present one last
};

}  // namespace saphira::bus
