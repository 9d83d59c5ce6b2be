#include "splice.hpp"

#include <algorithm>

#include "loop.hpp"

namespace saphira::relay {

namespace {

constexpr std::size_t kFull = 64 * 1024;  // then the other side is not read
constexpr std::size_t kPiece = 16 * 1024;

}  // namespace

void Splice::hold(End& end, bool held) {
  if (end.held == held || end.wsi == nullptr || end.gone)
    return;
  end.held = held;
  lws_rx_flow_control(end.wsi, held ? 0 : 1);
}

void Splice::attach(Side side, lws* wsi, bool is_websocket) {
  End& end = ends_[side];
  end.wsi = wsi;
  end.is_websocket = is_websocket;
  if (!end.out.empty() || ends_[1 - side].gone)
    lws_callback_on_writable(wsi);
}

void Splice::came(Side side, std::string_view bytes) {
  End& other = ends_[1 - side];
  if (other.gone)
    return;
  other.out.append(bytes);
  if (other.wsi != nullptr)
    lws_callback_on_writable(other.wsi);
  if (other.out.size() > kFull)
    hold(ends_[side], true);
}

int Splice::write(Side side) {
  End& end = ends_[side];
  End& other = ends_[1 - side];
  if (end.out.empty())
    return other.gone ? -1 : 0;
  const std::size_t size = std::min(kPiece, end.out.size());
  if (!web::write(end.wsi, std::string_view(end.out).substr(0, size),
                  end.is_websocket ? LWS_WRITE_BINARY : LWS_WRITE_RAW))
    return -1;
  end.out.erase(0, size);
  if (end.out.size() < kFull / 2)
    hold(other, false);
  if (!end.out.empty() || other.gone)
    lws_callback_on_writable(end.wsi);
  return 0;
}

void Splice::closed(Side side) {
  End& end = ends_[side];
  End& other = ends_[1 - side];
  end.gone = true;
  end.wsi = nullptr;
  end.out.clear();
  if (other.gone)
    return;
  if (other.wsi != nullptr)
    lws_callback_on_writable(other.wsi);
}

void Splice::close() {
  for (End& end : ends_) {
    if (end.wsi != nullptr && !end.gone)
      web::drop(end.wsi);
    else
      end.gone = true;
  }
}

}  // namespace saphira::relay
