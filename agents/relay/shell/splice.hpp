#pragma once

#include <array>
#include <string>
#include <string_view>

struct lws;

namespace saphira::relay {

/// Joins two connections of libwebsockets, each a WebSocket or a plain socket: each gets the
/// other's bytes. Bounded: a side that does not read holds up the other.
class Splice {
 public:
  enum Side { kNear, kFar };

  /// The connection of a side is open. is_websocket: its bytes are sent as binary messages.
  void attach(Side side, lws* wsi, bool is_websocket);
  bool is_attached(Side side) const { return ends_[side].wsi != nullptr; }
  /// Bytes have come by a side.
  void came(Side side, std::string_view bytes);
  /// A side can be written to: 0, or -1, by which libwebsockets closes it.
  int write(Side side);
  /// A side is closed. The other one gets the rest, and is then closed.
  void closed(Side side);
  /// Closes both sides.
  void close();
  /// Both sides are closed.
  bool is_over() const { return ends_[kNear].gone && ends_[kFar].gone; }

 private:
  struct End {
    lws* wsi = nullptr;
    bool is_websocket = false;
    bool held = false;  ///< reading is paused
    bool gone = false;
    std::string out;  ///< bytes still to send
  };
  void hold(End& end, bool held);

  std::array<End, 2> ends_;
};

}  // namespace saphira::relay
