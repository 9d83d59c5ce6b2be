#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace saphira::console {

/// A place on the board: the topic's rank (lower ones are sent first) and the instance's key.
using Place = std::pair<int, std::string>;

/// The state of the board in a browser.
struct Viewer {
  std::map<Place, std::uint64_t> has;  ///< the version of each sent item
  std::uint64_t sent = 0;              ///< frames
  struct UnderWay {
    std::uint64_t frame = 0;
    double sent = 0.0;   ///< [s]
    bool whole = false;  ///< of all topics
  };
  std::deque<UnderWay> under_way;  ///< frames that it has not acknowledged, the oldest first
  double last = -1e9;              ///< [s] time of the newest frame
  double delay = 0.0;              ///< [s] from the newest acknowledged frame to its answer
  double quickest = 1e9;           ///< [s] the shortest delay
};

/// The newest state of all items, as JSON texts, and each viewer's news. Nothing queues up: a slow
/// viewer gets fewer and newer frames, at no cost for others. Times are seconds of any steady
/// clock.
class Board {
 public:
  struct Settings {
    std::size_t frame_bytes = 200'000;  ///< about the largest frame; the rest comes in the next
    int unseen = 2;                     ///< whole frames on their way to a viewer at once
    std::size_t most_unseen = 12;       ///< frames in all
    double queue = 0.2;                 ///< [s] a link that delays by this much more is full
    double silence = 0.5;               ///< [s] until an empty frame as a sign of life
  };

  Board() = default;
  explicit Board(Settings settings) : settings_(settings) {}

  /// A topic, with its newest `most` items. Returns its rank: the first topic has the smallest.
  int topic(std::string name, std::size_t most = 1);
  /// The topics so far are urgent: an operator needs each cycle, however long the link delays.
  void urgent_so_far() { urgent_ = static_cast<int>(topics_.size()); }

  void put(int topic, const std::string& key, std::string json, double now,
           const std::string& owner = {});
  void withdraw(int topic, const std::string& key);
  /// The owner is lost: its items are withdrawn.
  void lose(int topic, const std::string& owner);
  std::size_t size() const { return items_.size(); }

  /// The news for a viewer, as one JSON text:
  ///   {"seq": 7, "now": 12.345, "items": [{"t": topic, "k": key, "a": age [ms], "d": {...}}, ...]}
  /// "d" is null where the item was withdrawn. While enough whole frames are on their way, only the
  /// urgent topics, and those only while the link is not full: the delay shows when frames queue
  /// up. Nothing while too many frames are on their way, or without news and with a recent frame.
  std::optional<std::string> frame(Viewer& viewer, double now) const;
  /// The present items of these topics, whatever a viewer has: the members "now" and "items" of a
  /// frame.
  std::string members(const std::vector<int>& topics, double now) const;
  /// The viewer has acknowledged a frame.
  static void seen(Viewer& viewer, std::uint64_t frame, double now);

 private:
  struct Item {
    std::string json;
    std::string owner;
    std::uint64_t version = 0;
    double came = 0.0;  ///< [s]
  };
  struct Topic {
    std::string name;
    std::size_t most = 1;
    std::size_t count = 0;
  };

  Topic& entry(int topic) { return topics_.at(static_cast<std::size_t>(topic)); }
  void forget_oldest(int topic);
  void append(std::string& items, const Place& place, double age, const std::string& json) const;

  Settings settings_;
  std::vector<Topic> topics_;
  int urgent_ = 0;  ///< topics, the first ones
  std::map<Place, Item> items_;
  std::uint64_t version_ = 0;
};

/// The text in quotation marks, in JSON form.
std::string quoted(const std::string& text);

}  // namespace saphira::console
