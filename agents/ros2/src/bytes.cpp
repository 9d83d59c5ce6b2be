#include "bytes.hpp"

#include <algorithm>

namespace saphira::ros2 {

namespace {

constexpr std::size_t kHead = 16;
constexpr std::uint8_t kCyclone = 0x10;  // vendor 1.16, the first bytes of its identities

}  // namespace

std::optional<Ticket> ticket_of(const bus::ForeignSample& request) {
  constexpr std::size_t begin = bus::internal::kEncapsulationBytes;
  if (request.bytes.size() < begin)
    return std::nullopt;
  if (request.id.writer[0] != 1 || request.id.writer[1] != kCyclone) {
    // A client may name the reader of its answers instead of the writer of its requests.
    const bool named = request.related.writer != bus::WriterId{};
    return Ticket{{}, {named ? request.related.writer : request.id.writer, request.id.number}};
  }
  if (request.bytes.size() < begin + kHead)
    return std::nullopt;
  std::string head = request.bytes.substr(begin, kHead);
  if ((request.bytes[1] & 1) == 0) {  // of a big-endian machine; answers are little-endian
    std::reverse(head.begin(), head.begin() + 8);
    std::reverse(head.begin() + 8, head.end());
  }
  return Ticket{std::move(head), {}};
}

std::string plain(const bus::ForeignSample& request, const Ticket& ticket) {
  std::string bytes = request.bytes;
  bytes.erase(bus::internal::kEncapsulationBytes, ticket.head.size());
  return bytes;
}

std::string answer(const std::string& bytes, const Ticket& ticket) {
  std::string whole = bytes;
  whole.insert(bus::internal::kEncapsulationBytes, ticket.head);
  return whole;
}

}  // namespace saphira::ros2
