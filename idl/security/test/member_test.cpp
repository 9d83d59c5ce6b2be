// A member is known by its subject, its documents and its seal.
#include <gtest/gtest.h>

#include <stdexcept>

#include "saphira/security/documents.hpp"
#include "saphira/security/seal.hpp"
#include "saphira/security/subject.hpp"

namespace saphira::security {
namespace {

Roles two_topics() {
  Roles roles;
  roles.roles = {{"operator", "a person", {}}, {"observer", "watches", {}}};
  roles.topics = {{"drive/teleop", {"operator"}, {}},
                  {"robot/state", {}, {"operator", "observer"}}};
  return roles;
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  if (begin == std::string::npos)
    return {};
  return text.substr(begin + from.size(), text.find(to, begin) - begin - from.size());
}

TEST(Documents, PermissionsSayWhatTheRoleMay) {
  const std::string text =
      permissions({{"karen", 2, "operator", "office"}, "", 0, 86400}, two_topics());
  EXPECT_EQ(between(text, "<subject_name>", "</"), "CN=karen.2,OU=operator,O=office");
  EXPECT_EQ(between(text, "<not_before>", "</"), "1970-01-01T00:00:00");
  EXPECT_EQ(between(text, "<not_after>", "</"), "1970-01-02T00:00:00");
  EXPECT_EQ(between(text, "<publish>", "<partitions>"),
            "<topics><topic>drive/teleop</topic>\n</topics>\n");
  EXPECT_EQ(between(text, "<subscribe>", "<partitions>"),
            "<topics><topic>robot/state</topic>\n</topics>\n");
  EXPECT_EQ(between(text, "<partition>", "</"), "*");
  EXPECT_EQ(between(text, "<default>", "</"), "DENY");
  EXPECT_EQ(robot_of(text), "");
  EXPECT_EQ(subject_of(text), "CN=karen.2,OU=operator,O=office");
}

TEST(Documents, WhoMayWriteNothingHasNothingToPublish) {
  const std::string text = permissions({{"john", 1, "observer", "office"}, "", 0, 1}, two_topics());
  EXPECT_EQ(text.find("<publish>"), std::string::npos);
  EXPECT_NE(text.find("<subscribe>"), std::string::npos);
}

TEST(Documents, ACredentialOfOneRobotHasItsPartitionAlone) {
  const std::string text =
      permissions({{"karen", 1, "operator", "office"}, "flakey", 0, 1}, two_topics());
  EXPECT_EQ(text.find("<partition>*<"), std::string::npos);
  EXPECT_NE(text.find("<partition>flakey</partition>"), std::string::npos);
  EXPECT_EQ(robot_of(text), "flakey");
}

TEST(Documents, GovernanceAdmitsNobodyWithoutAuthentication) {
  const std::string text = governance();
  EXPECT_EQ(between(text, "<allow_unauthenticated_participants>", "</"), "false");
  for (const char* const kind : {"enable_join_access_control", "enable_read_access_control",
                                 "enable_write_access_control", "enable_discovery_protection"})
    EXPECT_EQ(between(text, "<" + std::string(kind) + ">", "</"), "true") << kind;
  for (const char* const kind : {"discovery_protection_kind", "metadata_protection_kind"})
    EXPECT_EQ(between(text, "<" + std::string(kind) + ">", "</"), "ENCRYPT") << kind;
}

using Bytes = std::vector<std::uint8_t>;

const std::string kOld(64, 'a');
const std::string kNew(64, 'b');

Bytes message() {
  Bytes bytes{'R', 'T', 'P', 'S'};
  for (std::uint8_t i = 4; i < 120; ++i)
    bytes.push_back(i);
  return bytes;
}
Bytes sealed(const Seal& seal, std::int64_t time = 1'800'000'000) {
  Bytes bytes = message();
  seal.close(bytes, time);
  return bytes;
}
Seal::Opened opened(const Seal& seal, const Bytes& bytes) {
  return seal.open(bytes.data(), bytes.size());
}

TEST(Seal, ShowsThatTheSenderKnowsTheKeyAndWhen) {
  const Seal seal({kOld});
  const auto found = opened(seal, sealed(seal));
  EXPECT_EQ(found.size, message().size());
  EXPECT_EQ(found.sealed, 1'800'000'000);
  EXPECT_EQ(sealed(seal).size() % 4, 0U);
}

TEST(Seal, EachChangeShows) {
  const Seal seal({kOld});
  const Bytes whole = sealed(seal);
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      Bytes changed = whole;
      changed[at] = static_cast<std::uint8_t>(changed[at] ^ (1U << static_cast<unsigned>(bit)));
      EXPECT_EQ(opened(seal, changed).sealed, std::nullopt) << at << " " << bit;
    }
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(seal.open(whole.data(), size).sealed, std::nullopt) << size;
}

TEST(Seal, WithoutOneAMessageIsAsItWas) {
  const Seal seal({kOld});
  EXPECT_EQ(opened(seal, message()).size, message().size());
  EXPECT_EQ(opened(seal, message()).sealed, std::nullopt);
  EXPECT_EQ(opened(Seal({kNew}), sealed(seal)).sealed, std::nullopt) << "of another site";
  const Seal none({});
  EXPECT_EQ(sealed(none), message());
  const auto found = opened(none, sealed(seal));
  EXPECT_EQ(found.size, message().size()) << "a seal is no part of the message";
  EXPECT_EQ(found.sealed, std::nullopt);
}

TEST(Seal, DuringAChangeOfKeysOldAndNewKnowEachOther) {
  const Seal old({kOld});
  const Seal both({kNew, kOld});
  const Seal fresh({kNew});
  for (const Seal* const one : {&old, &both, &fresh})
    for (const Seal* const other : {&old, &both, &fresh}) {
      const bool share = one == other || one == &both || other == &both;
      EXPECT_EQ(opened(*other, sealed(*one)).sealed.has_value(), share);
    }
}

TEST(Seal, KeysAreReadFromAFile) {
  const std::string key = new_site_key();
  EXPECT_NE(key, new_site_key());
  EXPECT_EQ(parse_site_keys(site_keys_text({key, kOld})), (std::vector{key, kOld}));
  for (const std::string& text :
       {std::string(), std::string("abc\n"), key + " " + key + "\n", key + "\n" + key + "\n" + key})
    EXPECT_THROW(parse_site_keys(text), std::runtime_error) << text;
}

TEST(Subject, IsReadAsItIsWritten) {
  const Subject subject{"karen", 2, "operator", "office"};
  EXPECT_EQ(to_text(subject), "CN=karen.2,OU=operator,O=office");
  EXPECT_EQ(parse_subject(to_text(subject)), subject);
  EXPECT_EQ(parse_subject("O = office, OU = operator, CN = karen.2"), subject);
  EXPECT_EQ(parse_subject("/O=office/OU=operator/CN=karen.2"), subject);
}

TEST(Subject, WhatIsNoneOfOursIsNobody) {
  for (const char* const text :
       {"", ",", "=", "CN=karen.2", "CN=karen,OU=operator,O=office",
        "CN=karen.0,OU=operator,O=office", "CN=karen.02,OU=operator,O=office",
        "CN=karen.2x,OU=operator,O=office", "CN=karen.99999999999,OU=operator,O=office",
        "CN=Karen.2,OU=operator,O=office", "CN=.2,OU=operator,O=office",
        "CN=karen.,OU=operator,O=office", "CN=karen.2,OU=operator,O=office,O=other",
        "CN=karen.2,OU=operator,O=office,C=NO", "CN=karen.2,CN=john.1,O=office",
        "CN=karen.2,OU=,O=office", "/O=office/OU=operator/CN=karen.2/CN=john.1",
        "/O=office,OU=operator,CN=karen.2"})
    EXPECT_FALSE(parse_subject(text)) << text;
}

TEST(Subject, NamesNeedNoQuotes) {
  for (const char* const good : {"a", "karen", "base-station-2"})
    EXPECT_TRUE(is_name(good)) << good;
  for (const char* const bad : {"", "2nd", "-a", "Karen", "a b", "a.b", "a/b", "a<b", "ä",
                                "abcdefghijklmnopqrstuvwxyzabcdefg"})
    EXPECT_FALSE(is_name(bad)) << bad;
}

}  // namespace
}  // namespace saphira::security
