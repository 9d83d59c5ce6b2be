#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "saphira/protocol/packet.hpp"

/// Little-endian fields of a packet's body, one after the other.
namespace saphira::protocol {

inline void put8(Bytes& out, unsigned value) {
  out.push_back(static_cast<std::uint8_t>(value & 0xFFU));
}
inline void put16(Bytes& out, unsigned value) {
  put8(out, value);
  put8(out, value >> 8U);
}
inline void put32(Bytes& out, std::uint32_t value) {
  put16(out, value & 0xFFFFU);
  put16(out, value >> 16U);
}
inline void put16(Bytes& out, std::int16_t value) {
  put16(out, static_cast<unsigned>(static_cast<std::uint16_t>(value)));
}
inline void put32(Bytes& out, std::int32_t value) {
  put32(out, static_cast<std::uint32_t>(value));
}
/// With its NUL; cut at one inside.
inline void put_string(Bytes& out, const std::string& text) {
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
  std::uint16_t u16() {
    const unsigned low = u8();
    const unsigned high = u8();
    return ended_ ? std::uint16_t{0} : static_cast<std::uint16_t>(low | high << 8U);
  }
  std::uint32_t u32() {
    const std::uint32_t low = u16();
    const std::uint32_t high = u16();
    return ended_ ? 0U : low | high << 16U;
  }
  std::int8_t i8() { return static_cast<std::int8_t>(u8()); }
  std::int16_t i16() { return static_cast<std::int16_t>(u16()); }
  std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
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

/// Writes a field of any type; reads one. For lists of fields that do both.
struct PutField {
  Bytes& out;
  void operator()(std::uint8_t value) const { put8(out, value); }
  void operator()(std::int8_t value) const { put8(out, static_cast<std::uint8_t>(value)); }
  void operator()(std::uint16_t value) const { put16(out, unsigned{value}); }
  void operator()(std::int16_t value) const { put16(out, value); }
  void operator()(std::uint32_t value) const { put32(out, value); }
  void operator()(std::int32_t value) const { put32(out, value); }
};

struct GetField {
  Fields& in;
  void operator()(std::uint8_t& value) const { value = in.u8(); }
  void operator()(std::int8_t& value) const { value = in.i8(); }
  void operator()(std::uint16_t& value) const { value = in.u16(); }
  void operator()(std::int16_t& value) const { value = in.i16(); }
  void operator()(std::uint32_t& value) const { value = in.u32(); }
  void operator()(std::int32_t& value) const { value = in.i32(); }
};

void each(const auto& visit, auto&... members) {
  (visit(members), ...);
}

}  // namespace saphira::protocol
