#pragma once

#include <cstddef>
#include <utility>

namespace saphira::cli {

/// The readers of a topic, as they match one after the other: a sample that is not kept reaches
/// those that have matched when it is written.
class Gathering {
 public:
  /// [s] A running program answers a new one at once, and announces itself every 0.25 s.
  static constexpr double kRest = 0.3;

  /// The number of readers at the time `now` [s], which only rises. True where there are some, and
  /// none has come for a while; later ones are not waited for.
  bool complete(std::size_t matched, double now) {
    if (std::exchange(matched_, matched) != matched)
      since_ = now;
    complete_ = complete_ || (matched > 0 && now - since_ >= kRest);
    return complete_ && matched > 0;
  }

 private:
  std::size_t matched_ = 0;
  double since_ = 0.0;
  bool complete_ = false;
};

}  // namespace saphira::cli
