#pragma once

#include <cstdint>
#include <deque>
#include <map>

namespace saphira::console {

/// Decides when a page gets the next picture, and how good it is, so that pictures come as often
/// and as fresh as the page's link carries them. A page acknowledges each picture. As many are on
/// their way as fit into the quickest answer's delay; the link is full when answers take 0.2 s
/// longer (late), and then there is one less each time. The quality falls while the link is full or
/// answers come less often than each 0.15 s, and rises while they come as often as pictures. Times
/// are seconds of any steady clock.
///
/// A page has several connections (lanes): a lost packet delays the pictures of its own lane alone,
/// and until its answer the others go on. The link is full where more than half of them are late.
class PictureFlow {
 public:
  using Lane = std::uint64_t;
  void open(Lane lane) { lanes_[lane]; }
  void close(Lane lane) { lanes_.erase(lane); }
  /// True where a newer picture than the last one may go by this lane.
  bool takes(Lane lane, std::uint64_t number, double now) const;
  void sent(Lane lane, std::uint64_t number, double now);
  void acknowledged(Lane lane, std::uint64_t number, double now);
  /// [1..100] of a JPEG; 0: as it comes.
  int quality() const;

 private:
  struct UnderWay {
    std::uint64_t number = 0;
    double sent = 0.0;
  };
  bool is_late(double delay) const;
  bool is_full() const { return 2 * late_ > lanes_.size(); }

  std::map<Lane, std::deque<UnderWay>> lanes_;  ///< what is under way by each
  std::uint64_t last_ = 0;
  double answered_ = -1.0;  ///< [s] time of the newest answer [-1: none yet]
  double gap_ = 0.1;        ///< [s] between answers, in the mean
  double quickest_ = 1e9;   ///< [s] delay of an answer
  std::size_t late_ = 0;    ///< late answers in turn
  double room_ = 2.0;       ///< pictures on their way at a time
  std::size_t step_ = 0;    ///< of the quality; 0: the best
  int even_ = 0;            ///< answers in turn for a better or a worse one: above or below 0
};

}  // namespace saphira::console
