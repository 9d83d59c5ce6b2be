#pragma once

#include <cstddef>
#include <cstdint>
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
  std::map<Place, std::uint64_t> has;  ///< the version of each item that was sent
  std::uint64_t sent = 0;              ///< frames
  std::uint64_t seen = 0;              ///< the newest frame that it has acknowledged
  double last = -1e9;                  ///< [s] when the newest frame was made
};

/// The newest of everything that is to be seen, as JSON texts, and what of it is news to whom.
/// Nothing queues up: whoever is slow gets fewer and newer frames, at the cost of nobody else.
/// Times are seconds of any steady clock.
class Board {
 public:
  struct Settings {
    std::size_t frame_bytes = 200'000;  ///< about the most in one frame; the rest comes in the next
    std::uint64_t unseen = 2;           ///< frames on their way to a viewer at once
    double silence = 0.5;               ///< [s] an empty frame says that the link is alive
  };

  Board() = default;
  explicit Board(Settings settings) : settings_(settings) {}

  /// A topic, of which the newest `most` items are kept. Returns its rank: that of the first topic
  /// is the smallest.
  int topic(std::string name, std::size_t most = 1);

  void put(int topic, const std::string& key, std::string json, double now);
  void withdraw(int topic, const std::string& key);
  std::size_t size() const { return items_.size(); }

  /// The news for a viewer, as one JSON text:
  ///   {"seq": 7, "now": 12.345, "items": [{"t": topic, "k": key, "a": age [ms], "d": {...}}, ...]}
  /// "d" is null where the item was withdrawn. Nothing while too many frames are on their way, or
  /// where there is no news and the viewer has heard something lately.
  std::optional<std::string> frame(Viewer& viewer, double now) const;
  static void seen(Viewer& viewer, std::uint64_t frame);

 private:
  struct Topic {
    std::string name;
    std::size_t most = 1;
    std::size_t count = 0;
  };
  struct Item {
    std::string json;
    std::uint64_t version = 0;
    double came = 0.0;  ///< [s]
  };

  void forget_oldest(int topic);

  Settings settings_;
  std::vector<Topic> topics_;
  std::map<Place, Item> items_;
  std::uint64_t version_ = 0;
};

/// The text in quotation marks, as JSON has it.
std::string quoted(const std::string& text);

}  // namespace saphira::console
