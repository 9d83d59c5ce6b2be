#pragma once

#include <array>
#include <string>
#include <string_view>

struct lws;

namespace saphira::relay {

/// Two connections of libwebsockets, of which each gets what comes by the other: a WebSocket or a
/// plain socket. Bounded: who does not read holds up the other side.
class Splice {
 public:
  enum Side { kNear, kFar };

  /// The connection of a side is there. is_websocket: what it gets goes as binary messages.
  void attach(Side side, lws* wsi, bool is_websocket);
  bool is_attached(Side side) const { return ends_[side].wsi != nullptr; }
  /// Bytes have come by a side.
  void came(Side side, std::string_view bytes);
  /// A side can be written to: 0, or -1, by which libwebsockets closes it.
  int write(Side side);
  /// A side is closed. The other one gets what is left, and is closed then.
  void closed(Side side);
  /// Closes what is there.
  void close();
  /// Both sides are closed.
  bool is_over() const { return ends_[kNear].gone && ends_[kFar].gone; }

 private:
  struct End {
    lws* wsi = nullptr;
    bool is_websocket = false;
    bool held = false;  ///< it is not read for now
    bool gone = false;
    std::string out;  ///< what it is still to get
  };
  void hold(End& end, bool held);

  std::array<End, 2> ends_;
};

}  // namespace saphira::relay
