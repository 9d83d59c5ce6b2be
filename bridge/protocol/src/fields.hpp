#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>

#include "saphira/protocol/packet.hpp"

/// Little-endian fields of a packet's body, one after the other.
namespace saphira::protocol {

/// Writes the bytes of a number of any size.
inline void put(Bytes& out, std::integral auto value) {
  for (unsigned i = 0; i < sizeof value; ++i)
    out.push_back(static_cast<std::uint8_t>(value >> 8U * i & 0xFF));
}
/// With its NUL; cut at one inside.
inline void put(Bytes& out, const std::string& text) {
  const std::size_t size = std::min(text.find('\0'), text.size());
  out.insert(out.end(), text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size));
  out.push_back(0);
}

inline std::string printable(std::string text) {
  for (char& c : text)
    if (c < ' ' || c > '~')
      c = '?';
  return text;
}

/// Reads the fields; zero and a mark behind the packet's end. Half a field counts as missing.
class Fields {
 public:
  explicit Fields(ByteView bytes) : bytes_(bytes) {}

  std::uint8_t u8() {
    if (at_ >= bytes_.size()) {
      ended_ = true;
      return 0;
    }
    return bytes_[at_++];
  }
  template <std::integral T>
  T number() {
    std::make_unsigned_t<T> value = 0;
    for (unsigned i = 0; i < sizeof value; ++i)
      value = static_cast<std::make_unsigned_t<T>>(value | std::make_unsigned_t<T>{u8()} << 8U * i);
    return ended_ ? T{0} : static_cast<T>(value);
  }
  /// Up to its NUL; unprintable characters become question marks.
  std::string string() {
    const ByteView rest = bytes_.subspan(at_);
    const auto end = std::ranges::find(rest, 0);
    if (end == rest.end())
      ended_ = true;
    at_ += static_cast<std::size_t>(end - rest.begin()) + (ended_ ? 0 : 1);
    return printable({rest.begin(), end});
  }
  Bytes rest() {
    Bytes out(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), bytes_.end());
    at_ = bytes_.size();
    return out;
  }
  std::size_t left() const { return bytes_.size() - at_; }
  bool ended() const { return ended_; }

 private:
  ByteView bytes_;
  std::size_t at_ = 0;
  bool ended_ = false;
};

/// Writes a number; reads one. For lists of fields that do both.
struct PutField {
  Bytes& out;
  void operator()(std::integral auto value) const { put(out, value); }
};

struct GetField {
  Fields& in;
  template <std::integral T>
  void operator()(T& value) const {
    value = in.number<T>();
  }
};

void each(const auto& visit, auto&... members) {
  (visit(members), ...);
}

}  // namespace saphira::protocol
