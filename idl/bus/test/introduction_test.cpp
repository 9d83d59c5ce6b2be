// Announcements and handshakes, honest and forged, byte by byte.
#include "introduction.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sieve.hpp"

namespace saphira::bus::internal {
namespace {

const std::string kJohn = "john's-prog\1";
const std::string kKate = "kate's-prog\1";
const std::string kAnnouncer("\0\1\0\xc2", 4);
const std::string kHandshaker("\0\2\1\xc3", 4);
const std::string kHandshakeListener("\0\2\1\xc4", 4);
const std::string kNobody(4, '\0');
constexpr std::uint8_t kDataFlags = 0x05;  // little-endian, with a payload

std::string number(std::size_t value, std::size_t bytes, bool little = true) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i)
    text += static_cast<char>(value >> 8U * (little ? i : bytes - 1 - i));
  return text;
}

std::string header(const std::string& sender) {
  return "RTPS\2\2\1\x0f" + sender;
}

std::string submessage(std::uint8_t id, std::uint8_t flags, const std::string& data) {
  return std::string{static_cast<char>(id), static_cast<char>(flags)} + number(data.size(), 2) +
         data;
}

std::string data_of(const std::string& writer, const std::string& payload,
                    const std::string& reader = kNobody, const std::string& qos = "") {
  return number(0, 2) + number(16, 2) + reader + writer + number(0, 4) + number(1, 4) + qos +
         payload;
}

using Parameters = std::vector<std::pair<std::size_t, std::string>>;

std::string list(const Parameters& parameters, bool little = true) {
  std::string text;
  for (const auto& [id, value] : parameters)
    text += number(id, 2, little) + number(value.size(), 2, little) + value;
  return text;
}

std::pair<std::size_t, std::string> guid_of(const std::string& prefix) {
  return {0x50, prefix + std::string("\0\0\1\xc1", 4)};
}
const std::pair<std::size_t, std::string> kLeaseParameter{0x02, number(60, 4) + number(0, 4)};
const std::pair<std::size_t, std::string> kEndParameter{0x01, ""};

/// With a lease in front of the parameters.
std::string announcement(Parameters parameters) {
  parameters.insert(parameters.begin(), kLeaseParameter);
  return header(kJohn) +
         submessage(0x15, kDataFlags,
                    data_of(kAnnouncer, std::string("\0\3\0\0", 4) + list(parameters)));
}

bool good(const std::string& message) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(message.data());
  EXPECT_EQ(sound_length(bytes, message.size()), message.size());
  return speaks_for_itself(bytes, message.size());
}

TEST(Announcement, IsOfItsSender) {
  EXPECT_TRUE(good(announcement({guid_of(kJohn), kEndParameter})));
  EXPECT_FALSE(good(announcement({guid_of(kKate), kEndParameter})));
  EXPECT_FALSE(good(announcement({kEndParameter})));
  EXPECT_FALSE(good(announcement({guid_of(kJohn), guid_of(kKate), kEndParameter})));
  EXPECT_FALSE(good(announcement({guid_of(kKate), guid_of(kJohn), kEndParameter})));
  EXPECT_FALSE(good(announcement({guid_of(kJohn), guid_of(kJohn), kEndParameter})));
}

TEST(Announcement, SaysHowLongItIsGood) {
  const auto with = [](const Parameters& parameters) {
    return good(header(kJohn) +
                submessage(0x15, kDataFlags,
                           data_of(kAnnouncer, std::string("\0\3\0\0", 4) + list(parameters))));
  };
  EXPECT_TRUE(with({kLeaseParameter, guid_of(kJohn), kEndParameter}));
  EXPECT_FALSE(with({guid_of(kJohn), kEndParameter}));
  EXPECT_FALSE(with({guid_of(kJohn), kLeaseParameter, kLeaseParameter, kEndParameter}));
  EXPECT_FALSE(with({guid_of(kJohn), {0x02, "four"}, kEndParameter}));
}

TEST(Announcement, ItsTimeIsSet) {
  for (const bool little : {true, false}) {
    const std::string qos = list({{0x800f, std::string(24, 'x')}, kEndParameter});
    const auto message = [&](std::size_t whole, std::size_t fraction) {
      const std::pair<std::size_t, std::string> lease{
          0x02, number(whole, 4, little) + number(fraction, 4, little)};
      return header(kJohn) + submessage(0x09, 0x01, std::string(8, 'x')) +
             submessage(
                 0x15, kDataFlags | 0x02,
                 data_of(kAnnouncer,
                         std::string{'\0', static_cast<char>(little ? 3 : 2), '\0', '\0'} +
                             list({{0x55, "four"}, lease, guid_of(kJohn), kEndParameter}, little),
                         kNobody, qos));
    };
    std::string changed = message(0x01020304, 0x05060708);
    EXPECT_TRUE(good(changed));
    set_lease(reinterpret_cast<std::uint8_t*>(changed.data()), changed.size(),
              std::chrono::seconds(3));
    EXPECT_EQ(changed, message(3, 0));
  }
}

TEST(Announcement, IsTheNextOne) {
  const std::string first = announcement({guid_of(kJohn), kEndParameter});
  std::string next = first;
  renumber(reinterpret_cast<std::uint8_t*>(next.data()), next.size());
  constexpr std::size_t kNumber = 20 + 4 + 16;  // its low word, little-endian
  std::string expected = first;
  ++expected[kNumber];
  EXPECT_EQ(next, expected);
  next[kNumber] = next[kNumber + 1] = static_cast<char>(0xff);
  renumber(reinterpret_cast<std::uint8_t*>(next.data()), next.size());
  expected[kNumber] = expected[kNumber + 1] = 0;
  ++expected[kNumber + 2];
  EXPECT_EQ(next, expected);
}

TEST(Announcement, TellsNameAndData) {
  const auto said = [](const std::string& message) {
    return announced(reinterpret_cast<const std::uint8_t*>(message.data()), message.size());
  };
  const auto found = said(announcement({guid_of(kJohn),
                                        {0x0062, number(7, 4) + std::string("bridge\0\0", 8)},
                                        {0x002c, number(10, 4) + "robot=ant;" + std::string(2, 0)},
                                        kEndParameter}));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->name, "bridge");
  EXPECT_EQ(found->data, "robot=ant;");
  // Lengths beyond the parameter's end.
  const auto cut = said(announcement(
      {guid_of(kJohn), {0x0062, number(900, 4)}, {0x002c, number(900, 4)}, kEndParameter}));
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->name, "");
  EXPECT_EQ(cut->data, "");
  EXPECT_FALSE(said(announcement({guid_of(kJohn)})));
  EXPECT_FALSE(said(header(kJohn)));
}

TEST(Announcement, HasNoOtherNameOfItsSender) {
  const std::pair<std::size_t, std::string> hash{0x70, guid_of(kKate).second};
  EXPECT_FALSE(good(announcement({hash, guid_of(kJohn), kEndParameter})));
  EXPECT_FALSE(good(announcement({guid_of(kJohn), hash, kEndParameter})));
}

TEST(Announcement, IsReadAsFastDdsReadsIt) {
  EXPECT_FALSE(good(announcement({guid_of(kJohn)})));  // it does not end
  EXPECT_FALSE(good(announcement({{0x55, "odd"}, guid_of(kJohn), kEndParameter})));
  EXPECT_FALSE(good(announcement({{0x50, kJohn}, kEndParameter})));  // too short
  std::string beyond = announcement({guid_of(kJohn), {0x55, "four"}, kEndParameter});
  beyond[beyond.size() - 4 - 4 - 2] = 100;
  EXPECT_FALSE(good(beyond));
  const std::string big =
      std::string("\0\2\0\0", 4) + list({kLeaseParameter, guid_of(kJohn), kEndParameter}, false);
  EXPECT_TRUE(good(header(kJohn) + submessage(0x15, kDataFlags, data_of(kAnnouncer, big))));
  const std::string plain =
      std::string("\0\1\0\0", 4) + list({kLeaseParameter, guid_of(kJohn), kEndParameter});
  EXPECT_FALSE(good(header(kJohn) + submessage(0x15, kDataFlags, data_of(kAnnouncer, plain))));
}

TEST(Announcement, IsPlainData) {
  const std::string payload =
      std::string("\0\3\0\0", 4) + list({kLeaseParameter, guid_of(kJohn), kEndParameter});
  const auto with = [&](std::uint8_t id, std::uint8_t flags, const std::string& qos = "") {
    return good(header(kJohn) + submessage(id, flags, data_of(kAnnouncer, payload, kNobody, qos)));
  };
  EXPECT_TRUE(with(0x15, kDataFlags));
  // Fast DDS adds the identity of a related sample (0x800f).
  EXPECT_TRUE(with(0x15, kDataFlags | 0x02, list({{0x800f, std::string(24, 'x')}, kEndParameter})));
  EXPECT_FALSE(with(0x15, kDataFlags | 0x02, list({{0x800f, std::string(24, 'x')}})));
  EXPECT_FALSE(with(0x15, kDataFlags | 0x02, list({{0x71, number(3, 4)}, kEndParameter})));
  EXPECT_FALSE(with(0x15, kDataFlags | 0x02, list({{0x70, std::string(16, 'x')}, kEndParameter})));
  // A status that is seen only where odd sizes are rounded.
  EXPECT_FALSE(with(
      0x15, kDataFlags | 0x02,
      list({{0x55, "x"}}) + std::string(3, '\1') + list({{0x71, number(3, 4)}, kEndParameter})));
  EXPECT_FALSE(with(0x15, 0x09));  // a key instead of data
  EXPECT_FALSE(with(0x16, kDataFlags));
  EXPECT_FALSE(with(0x15, 0x01));
}

TEST(Announcement, IsNoFarewell) {
  const auto* const prefix = reinterpret_cast<const std::uint8_t*>(kJohn.data());
  const std::vector<std::uint8_t> message = farewell(prefix);
  EXPECT_TRUE(is_announcement(message.data(), message.size()));
  EXPECT_FALSE(speaks_for_itself(message.data(), message.size()));
  EXPECT_TRUE(is_farewell(message.data(), message.size()));
  const std::string one = announcement({guid_of(kJohn), kEndParameter});
  EXPECT_FALSE(is_farewell(reinterpret_cast<const std::uint8_t*>(one.data()), one.size()));
}

TEST(Announcement, IsAFarewellWithoutDataAndKey) {
  // As Fast DDS 2.9 writes it: inline QoS alone.
  const std::string qos = number(0x70, 2) + number(16, 2) + kJohn + std::string("\0\0\1\xc1", 4) +
                          number(0x71, 2) + number(4, 2) + std::string("\0\0\0\3", 4) +
                          number(1, 2) + number(0, 2);
  const std::string end =
      header(kJohn) +
      submessage(0x15, 0x03,
                 number(0, 2) + number(16, 2) + std::string("\0\1\0\xc7", 4) +
                     std::string("\0\1\0\xc2", 4) + number(0, 4) + number(1, 4) + qos);
  const auto* const message = reinterpret_cast<const std::uint8_t*>(end.data());
  EXPECT_TRUE(is_announcement(message, end.size()));
  EXPECT_TRUE(is_farewell(message, end.size()));
  EXPECT_FALSE(speaks_for_itself(message, end.size()));
}

TEST(Announcement, NobodySpeaksForAnother) {
  EXPECT_FALSE(good(header(kJohn) +
                    submessage(0x0c, 0x01, number(0, 4) + std::string("\2\2\1\x0f") + kKate)));
}

/// A token of a handshake, field by field.
struct Handshake {
  std::string source = kJohn;
  std::string kind = "dds.sec.auth";
  std::size_t tokens = 1;
  std::vector<std::pair<std::string, std::string>> values{
      {"c.id", "a certificate"},
      {"c.perm", "permissions"},
      {"c.pdata", list({kLeaseParameter, guid_of(kJohn), kEndParameter}, false)},
      {"hash_c1", "odd"}};
  bool little = true;

  std::string payload() const {
    std::string text = source + std::string("\0\0\1\xc1", 4) + std::string(8 + 24 + 48, '\0');
    const auto put = [&](const std::string& value) {
      text += number(value.size(), 4, little) + value;
    };
    const auto align = [&] { text.resize((text.size() + 3) / 4 * 4); };
    const auto put_text = [&](const std::string& value) {
      put(value + '\0');
      align();
    };
    put_text(kind);
    text += number(tokens, 4, little);
    put_text("DDS:Auth:PKI-DH:1.0+Req");
    text += number(1, 4, little);
    put_text("a property");
    put_text("and its value");
    text += number(values.size(), 4, little);
    for (const auto& [name, value] : values) {
      put_text(name);
      put(value);
      align();
    }
    return std::string{'\0', static_cast<char>(little ? 1 : 0), '\0', '\0'} + text;
  }
  std::string message(const std::string& writer = kHandshaker,
                      const std::string& reader = kHandshakeListener) const {
    return header(kJohn) + submessage(0x15, kDataFlags, data_of(writer, payload(), reader));
  }
};

TEST(Handshake, IsOfItsSender) {
  Handshake handshake;
  EXPECT_TRUE(good(handshake.message()));
  handshake.little = false;
  EXPECT_TRUE(good(handshake.message()));
  handshake.source = kKate;
  EXPECT_FALSE(good(handshake.message()));
}

TEST(Handshake, ItsLastPartHasNoCertificate) {
  Handshake handshake;
  handshake.values = {{"hash_c1", "some"}, {"signature", "some"}};
  EXPECT_TRUE(good(handshake.message()));
}

TEST(Handshake, NamesItsSenderOnce) {
  const auto with = [](const std::vector<std::pair<std::string, std::string>>& values) {
    Handshake handshake;
    handshake.values = values;
    return good(handshake.message());
  };
  const auto data_of_all = [](const Parameters& all) -> std::pair<std::string, std::string> {
    return {"c.pdata", list(all, false)};
  };
  const std::pair<std::string, std::string> permissions{"c.perm", "permissions"};
  const auto johns = data_of_all({guid_of(kJohn), kEndParameter});
  const auto kates = data_of_all({guid_of(kKate), kEndParameter});
  EXPECT_TRUE(with({permissions, johns}));
  EXPECT_TRUE(with({johns, permissions}));
  EXPECT_FALSE(with({permissions, kates}));
  EXPECT_FALSE(with({permissions, johns, kates}));
  EXPECT_FALSE(with({permissions, permissions, johns, johns}));
  EXPECT_FALSE(with({permissions, permissions, johns}));
  EXPECT_FALSE(with({permissions}));
  EXPECT_FALSE(with({johns}));
  EXPECT_FALSE(with({permissions, data_of_all({kEndParameter})}));
  EXPECT_FALSE(with({permissions, data_of_all({guid_of(kJohn)})}));
  EXPECT_FALSE(with({permissions, data_of_all({guid_of(kJohn), guid_of(kKate), kEndParameter})}));
  // Fast DDS takes this for the participant's GUID where it comes first.
  EXPECT_FALSE(with(
      {permissions, data_of_all({{0x70, guid_of(kKate).second}, guid_of(kJohn), kEndParameter})}));
  // A second name behind the zero of the first.
  EXPECT_FALSE(with({permissions, {std::string("c.pdata\0x", 9), kates.second}, johns}));
}

TEST(Handshake, IsPlainDataOfOneToken) {
  Handshake handshake;
  EXPECT_TRUE(good(handshake.message(kHandshaker, kNobody)));
  EXPECT_TRUE(good(handshake.message(kNobody, kHandshakeListener)));
  handshake.tokens = 2;
  EXPECT_FALSE(good(handshake.message()));
  handshake.tokens = 1;
  handshake.kind = "dds.sec.participant_crypto_tokens";
  EXPECT_FALSE(good(handshake.message()));
  handshake.kind = "dds.sec.auth";
  EXPECT_FALSE(good(header(kJohn) +
                    submessage(0x16, kDataFlags, data_of(kHandshaker, handshake.payload()))));
  // Of another pair of endpoints, and nobody's business here.
  handshake.source = kKate;
  EXPECT_FALSE(good(handshake.message(kNobody, kHandshakeListener)));
  EXPECT_TRUE(good(handshake.message(kNobody, kNobody)));
}

TEST(Handshake, IsRefusedWhereItIsCutOff) {
  const std::string whole = Handshake().payload();
  for (std::size_t size = 0; size < whole.size() - 1; ++size)  // but for one byte of alignment
    EXPECT_FALSE(good(header(kJohn) +
                      submessage(0x15, kDataFlags, data_of(kHandshaker, whole.substr(0, size)))))
        << size;
}

}  // namespace
}  // namespace saphira::bus::internal
