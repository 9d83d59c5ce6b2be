#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace saphira::protocol {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

// Manual Table 5-1.
inline constexpr std::uint8_t kHeader0 = 0xFA;
inline constexpr std::uint8_t kHeader1 = 0xFB;
/// Largest byte count (body and checksum) that a receiver accepts, manual 5.1.3.
inline constexpr std::size_t kMaxCount = 200;
/// Largest body that frame() takes.
inline constexpr std::size_t kMaxBody = kMaxCount - 2;

/// The checksum of a packet's body, manual 5.1.2. (The printed C fragment has `n = 2` where
/// `n -= 2` is meant.)
std::uint16_t checksum(ByteView body);

/// The whole packet around a body: header, count, body, checksum (high byte first).
/// std::length_error where the body is empty or longer than kMaxBody.
Bytes frame(ByteView body);

/// The counts of a parser since it was made.
struct ParserCounters {
  std::uint64_t packets = 0;        ///< good ones
  std::uint64_t bad_checksums = 0;  ///< a header and a count, but the checksum is wrong
  std::uint64_t bad_counts = 0;     ///< a header with an impossible count
  std::uint64_t abandoned = 0;      ///< begun and never completed: see PacketParser::gap
  std::uint64_t skipped_bytes = 0;  ///< bytes that belong to no good packet

  /// Packets that were received and ignored (manual 5.1.3).
  std::uint64_t bad_packets() const { return bad_checksums + bad_counts + abandoned; }
  bool operator==(const ParserCounters&) const = default;
};

/// Finds packets in a stream of bytes. Other bytes are skipped and counted. After a bad packet the
/// search goes on directly behind its header, so that one false header (or one damaged byte) costs
/// no good packet behind it.
class PacketParser {
 public:
  /// Takes bytes as they come, in pieces of any size.
  void feed(ByteView bytes);

  /// The body of the next good packet (without checksum), or nothing until more bytes come.
  std::optional<Bytes> next();

  /// The line has been silent for longer than any pause inside a packet. A packet that has begun
  /// will not be completed: it was a false header or lost its end. Without this call, a false
  /// header with a large count would hold back the packets behind it until that many bytes have
  /// come. Call next() afterwards: the bytes held back may contain packets.
  void gap();

  /// True where a packet has begun and is not complete.
  bool pending() const { return begin_ < buffer_.size(); }

  /// Forgets the bytes held; the counters stay. For a new connection.
  void reset();

  const ParserCounters& counters() const { return counters_; }

  template <class Archive>
  void archive(Archive& a) {
    a("buffer", buffer_)("begin", begin_)("give_up", give_up_)("counters", counters_);
    a.expect(begin_ <= buffer_.size(), "a place in the buffer");
  }

 private:
  void skip(std::size_t count);

  Bytes buffer_;
  std::size_t begin_ = 0;    // of the bytes not yet consumed
  std::size_t give_up_ = 0;  // candidates before this one are dropped
  ParserCounters counters_;
};

}  // namespace saphira::protocol
