#pragma once

#include <cstdint>
#include <deque>

namespace saphira::console {

/// Decides when a page gets the next picture, and how good it is, so that pictures come as often
/// and as fresh as the page's link carries them. A page acknowledges each picture; the link is full
/// when the answers take longer than the quickest one by 0.2 s. Then one picture is on its way at a
/// time, and its quality falls. Otherwise as many are on their way as fit into the quickest delay.
/// Times are seconds of any steady clock.
class PictureFlow {
 public:
  /// True where a newer picture than the last one may go.
  bool takes(std::uint64_t number, double now) const;
  void sent(std::uint64_t number, double now);
  void acknowledged(std::uint64_t number, double now);
  /// [1..100] of a JPEG; 0: as it comes.
  int quality() const;

 private:
  struct UnderWay {
    std::uint64_t number = 0;
    double sent = 0.0;
  };
  bool is_full(double delay) const;

  std::deque<UnderWay> under_way_;
  std::uint64_t last_ = 0;
  double delay_ = 0.0;
  double quickest_ = 1e9;
  std::size_t step_ = 0;  ///< of the quality; 0: the best
  int even_ = 0;          ///< answers in turn for a better or a worse one: above or below 0
};

}  // namespace saphira::console
