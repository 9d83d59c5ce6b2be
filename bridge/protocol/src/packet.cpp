#include "saphira/protocol/packet.hpp"

#include <stdexcept>

namespace saphira::protocol {

std::uint16_t checksum(ByteView body) {
  unsigned sum = 0;
  std::size_t at = 0;
  for (; at + 1 < body.size(); at += 2)
    sum = (sum + (static_cast<unsigned>(body[at]) << 8U | body[at + 1])) & 0xFFFFU;
  if (at < body.size())
    sum ^= body[at];
  return static_cast<std::uint16_t>(sum);
}

Bytes frame(ByteView body) {
  if (body.empty() || body.size() > kMaxBody)
    throw std::length_error("a packet's body has 1 to 198 bytes");
  Bytes out;
  out.reserve(body.size() + 5);
  out.push_back(kHeader0);
  out.push_back(kHeader1);
  out.push_back(static_cast<std::uint8_t>(body.size() + 2));
  out.insert(out.end(), body.begin(), body.end());
  const std::uint16_t sum = checksum(body);
  out.push_back(static_cast<std::uint8_t>(sum >> 8U));
  out.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
  return out;
}

void PacketParser::feed(ByteView bytes) {
  if (begin_ > 0) {
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
    give_up_ = give_up_ > begin_ ? give_up_ - begin_ : 0;
    begin_ = 0;
  }
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

void PacketParser::skip(std::size_t count) {
  begin_ += count;
  counters_.skipped_bytes += count;
}

std::optional<Bytes> PacketParser::next() {
  while (begin_ < buffer_.size()) {
    const std::size_t have = buffer_.size() - begin_;
    const std::uint8_t* p = buffer_.data() + begin_;
    const bool wait = begin_ >= give_up_;
    if (p[0] != kHeader0 || (have >= 2 && p[1] != kHeader1)) {
      skip(1);
      continue;
    }
    const std::size_t count = have >= 3 ? p[2] : 3;
    if (count < 3 || count > kMaxCount) {
      ++counters_.bad_counts;
      skip(2);
      continue;
    }
    if (have < 3 + count) {
      if (wait)
        return std::nullopt;
      if (have >= 3)
        ++counters_.abandoned;
      skip(have >= 2 ? 2 : 1);
      continue;
    }
    const ByteView body{p + 3, count - 2};
    const unsigned sent = static_cast<unsigned>(p[3 + count - 2]) << 8U | p[3 + count - 1];
    if (sent != checksum(body)) {
      ++counters_.bad_checksums;
      skip(2);
      continue;
    }
    ++counters_.packets;
    Bytes out(body.begin(), body.end());
    begin_ += 3 + count;
    return out;
  }
  return std::nullopt;
}

void PacketParser::gap() {
  give_up_ = buffer_.size();
}

void PacketParser::reset() {
  buffer_.clear();
  begin_ = 0;
  give_up_ = 0;
}

}  // namespace saphira::protocol
