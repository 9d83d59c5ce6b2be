#pragma once

// The samples that a writer holds for readers that come later.

#include <cstddef>
#include <deque>
#include <map>
#include <memory>

#include "saphira/bus/endpoint.hpp"

namespace saphira::bus::internal {

/// Copies of the newest samples of each key.
class Kept {
 public:
  void put(const TypeInfo& type, const void* sample, int depth) {
    auto& samples = samples_[type.key(sample)];
    Sample copy(type.create(), type.destroy);
    type.copy(sample, copy.get());
    samples.push_back(std::move(copy));
    if (samples.size() > static_cast<std::size_t>(depth))
      samples.pop_front();
  }
  void erase(const TypeInfo& type, const void* sample) { samples_.erase(type.key(sample)); }
  /// Of each key the oldest first.
  template <class Each>
  void each(Each&& each) const {
    for (const auto& [key, samples] : samples_)
      for (const Sample& sample : samples)
        each(sample.get());
  }

 private:
  using Sample = std::unique_ptr<void, void (*)(void*)>;

  std::map<InstanceKey, std::deque<Sample>> samples_;
};

}  // namespace saphira::bus::internal
