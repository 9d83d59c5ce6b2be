#include "saphira/security/documents.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace saphira::security
