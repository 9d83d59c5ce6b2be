#include "introduction.hpp"

#include <cstring>
#include <string_view>

#include "submessage.hpp"

namespace saphira::bus::internal {

namespace {

// [bytes]
constexpr std::size_t kPrefix = 12;
constexpr std::size_t kGuid = 16;
constexpr std::size_t kDuration = 8;
constexpr std::size_t kMessageIdentity = kGuid + 8;
// Of data: its inline QoS begins here, or its payload with the encapsulation.
constexpr std::size_t kRestAt = 20;
constexpr std::size_t kEncapsulation = 4;
// The second byte of an encapsulation.
constexpr std::uint8_t kPlainBig = 0;
constexpr std::uint8_t kPlainLittle = 1;
constexpr std::uint8_t kListBig = 2;
constexpr std::uint8_t kListLittle = 3;

constexpr std::size_t kEnd = 0x0001;
constexpr std::size_t kLease = 0x0002;
constexpr std::size_t kUserData = 0x002c;
constexpr std::size_t kParticipantGuid = 0x0050;
constexpr std::size_t kName = 0x0062;
constexpr std::size_t kKeyHash = 0x0070;
constexpr std::size_t kStatus = 0x0071;

std::size_t half(const char* at, bool little) {
  const auto one = static_cast<std::uint8_t>(at[0]);
  const auto other = static_cast<std::uint8_t>(at[1]);
  return little ? one | std::size_t{other} << 8U : other | std::size_t{one} << 8U;
}

/// Calls good(parameter, value) for each parameter of a list. Returns the size of the list with its
/// end; 0 where it does not end as it should, or one of them is not good.
template <class Good>
std::size_t size_of_list(std::string_view list, bool little, Good&& good) {
  for (std::size_t at = 0; list.size() - at >= 4;) {
    const std::size_t parameter = half(list.data() + at, little);
    const std::size_t size = half(list.data() + at + 2, little);
    at += 4;
    if (parameter == kEnd)
      return at;
    if (size % 4 != 0 || size > list.size() - at || !good(parameter, list.substr(at, size)))
      return 0;
    at += size;
  }
  return 0;
}

/// True where a list of parameters names that participant, once; and where an announcement says,
/// once, how long it is good. The hash of a key is refused, since Fast DDS may take it for the
/// participant's GUID.
bool names_alone(std::string_view list, bool little, const std::uint8_t* prefix, bool announces) {
  int names = 0;
  int leases = 0;
  const std::size_t size =
      size_of_list(list, little, [&](std::size_t parameter, std::string_view value) {
        if (parameter == kParticipantGuid)
          return ++names == 1 && value.size() == kGuid &&
                 std::memcmp(value.data(), prefix, kPrefix) == 0;
        if (parameter == kLease)
          return ++leases == 1 && value.size() == kDuration;
        return parameter != kKeyHash;
      });
  return size > 0 && names == 1 && (leases == 1 || !announces);
}

/// Where the payload of data begins; 0 where there is none, or its inline QoS gives a status or a
/// key. Fast DDS adds inline QoS where programs are in one process.
std::size_t payload_of(const Submessage& data) {
  if (data.id != kData || (data.flags() & (kPayload | kKey)) != kPayload ||
      data.half(2) != kRestAt - 4)
    return 0;
  std::size_t at = kRestAt;
  if ((data.flags() & kInlineQos) != 0) {
    const std::string_view rest(reinterpret_cast<const char*>(data.data) + at, data.size - at);
    const std::size_t size =
        size_of_list(rest, data.little, [](std::size_t parameter, std::string_view /*value*/) {
          return parameter != kKeyHash && parameter != kStatus;
        });
    if (size == 0)
      return 0;
    at += size;
  }
  return data.size - at < kEncapsulation ? 0 : at;
}

/// The values of a payload in CDR, one after the other. Behind its end all are empty.
class Values {
 public:
  Values(std::string_view payload, bool little) : rest_(payload), little_(little) {}

  bool good() const { return good_; }
  std::string_view bytes(std::size_t count) {
    if (count > rest_.size()) {
      good_ = false;
      count = rest_.size();
    }
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    at_ += count;
    return taken;
  }
  std::size_t word() {
    bytes((4 - at_ % 4) % 4);
    const std::string_view four = bytes(4);
    std::size_t value = 0;
    for (std::size_t i = 0; i < four.size(); ++i)
      value = value << 8U | static_cast<std::uint8_t>(four[little_ ? four.size() - 1 - i : i]);
    return value;
  }
  std::string_view octets() { return bytes(word()); }
  /// Without the zero at its end, which has to be the only one.
  std::string_view text() {
    const std::string_view whole = octets();
    good_ = good_ && !whole.empty() && whole.find('\0') == whole.size() - 1;
    return whole.substr(0, whole.empty() ? 0 : whole.size() - 1);
  }

 private:
  std::string_view rest_;
  const bool little_;
  std::size_t at_ = 0;
  bool good_ = true;
};

/// A ParticipantGenericMessage (DDS Security 1.1, 7.4.3.3) with one token of a handshake. The
/// certificate comes with permissions and with the participant's data, which hold its prefix.
bool is_own_handshake(std::string_view payload, bool little, const std::uint8_t* prefix) {
  Values values(payload, little);
  const std::string_view source = values.bytes(kMessageIdentity);
  // The related message, and the participant and endpoints that it is for.
  values.bytes(kMessageIdentity + 3 * kGuid);
  const std::string_view kind = values.text();
  if (!values.good() || std::memcmp(source.data(), prefix, kPrefix) != 0 ||
      kind != "dds.sec.auth" || values.word() != 1)
    return false;
  values.text();  // the kind of token
  for (std::size_t left = values.word(); left > 0 && values.good(); --left) {
    values.text();
    values.text();
  }
  int permissions = 0;
  int participants = 0;
  for (std::size_t left = values.word(); left > 0 && values.good(); --left) {
    const std::string_view name = values.text();
    const std::string_view value = values.octets();
    if (name == "c.perm")
      ++permissions;
    if (name == "c.pdata" && (++participants > 1 || !names_alone(value, false, prefix, false)))
      return false;
  }
  return values.good() && permissions == participants;
}

/// The list of parameters of an announcement: its place in the message [0: there is none, or it has
/// another form], its size, and the submessage behind it.
struct Announcement {
  std::size_t at = 0;
  std::size_t size = 0;
  bool little = true;
  std::size_t next = 0;
};

/// The first one of a sound message, at or behind a submessage.
Announcement announcement_in(const std::uint8_t* message, std::size_t size,
                             std::size_t from = kHeader) {
  std::size_t next = 0;
  for (std::size_t at = from; at + kSubmessageHeader <= size; at = next) {
    const Submessage part = submessage(message, size, at, next);
    if (!part.has_data() || !part.is_of(kParticipantWriter))
      continue;
    const std::size_t payload_at = payload_of(part);
    if (payload_at == 0)
      return {};
    const std::size_t list_at = payload_at + kEncapsulation;
    return {at + kSubmessageHeader + list_at, part.size - list_at,
            part.data[payload_at + 1] == kListLittle, next};
  }
  return {};
}

}  // namespace

bool speaks_for_itself(const std::uint8_t* message, std::size_t size) {
  const std::uint8_t* const prefix = message + kHeader - kPrefix;
  std::size_t next = 0;
  for (std::size_t at = kHeader; at + kSubmessageHeader <= size; at = next) {
    const Submessage part = submessage(message, size, at, next);
    if (part.id == kInfoSource)
      return false;
    if (!part.has_data())
      continue;
    const bool announces = part.is_of(kParticipantWriter);
    if (!announces && !part.is_of(kHandshakeWriter) && !part.is_for(kHandshakeReader))
      continue;
    const std::size_t payload_at = payload_of(part);
    if (payload_at == 0)
      return false;
    const std::uint8_t encoding = part.data[payload_at + 1];
    const std::string_view payload(
        reinterpret_cast<const char*>(part.data) + payload_at + kEncapsulation,
        part.size - payload_at - kEncapsulation);
    const bool own = announces ? (encoding == kListLittle || encoding == kListBig) &&
                                     names_alone(payload, encoding == kListLittle, prefix, true)
                               : (encoding == kPlainLittle || encoding == kPlainBig) &&
                                     is_own_handshake(payload, encoding == kPlainLittle, prefix);
    if (!own)
      return false;
  }
  return true;
}

bool is_farewell(const std::uint8_t* message, std::size_t size) {
  std::size_t next = 0;
  for (std::size_t at = kHeader; at + kSubmessageHeader <= size; at = next) {
    const Submessage part = submessage(message, size, at, next);
    if (part.has_data() && part.is_of(kParticipantWriter) && (part.flags() & kPayload) == 0)
      return true;
  }
  return false;
}

std::optional<Announced> announced(const std::uint8_t* message, std::size_t size) {
  const Announcement announcement = announcement_in(message, size);
  if (announcement.at == 0)
    return std::nullopt;
  const std::string_view list(reinterpret_cast<const char*>(message) + announcement.at,
                              announcement.size);
  Announced found;
  const std::size_t whole =
      size_of_list(list, announcement.little, [&](std::size_t parameter, std::string_view value) {
        Values values(value, announcement.little);
        if (parameter == kName)
          found.name = values.text();
        else if (parameter == kUserData)
          found.data = values.octets();
        return true;
      });
  return whole > 0 ? std::optional(found) : std::nullopt;
}

void set_lease(std::uint8_t* message, std::size_t size, std::chrono::seconds lease) {
  for (std::size_t from = kHeader;;) {
    const Announcement announcement = announcement_in(message, size, from);
    if (announcement.at == 0)
      return;
    const bool little = announcement.little;
    auto* parameter = reinterpret_cast<char*>(message + announcement.at);
    for (; half(parameter, little) != kEnd; parameter += 4 + half(parameter + 2, little)) {
      if (half(parameter, little) != kLease)
        continue;
      for (unsigned i = 0; i < 4; ++i) {
        const auto byte = static_cast<char>(lease.count() >> 8U * i);
        parameter[4 + (little ? i : 3 - i)] = byte;
        parameter[8 + i] = 0;  // the fraction of a second
      }
    }
    from = announcement.next;
  }
}

void renumber(std::uint8_t* message, std::size_t size) {
  std::size_t next = 0;
  for (std::size_t at = kHeader; at + kSubmessageHeader <= size; at = next) {
    const Submessage part = submessage(message, size, at, next);
    if (!part.has_data() || !part.is_of(kParticipantWriter))
      continue;
    const std::uint64_t number = part.word(16) + 1;
    std::uint8_t* const low = message + at + kSubmessageHeader + 16;
    for (unsigned i = 0; i < 4; ++i)
      low[part.little ? i : 3 - i] = static_cast<std::uint8_t>(number >> 8U * i);
  }
}

}  // namespace saphira::bus::internal
