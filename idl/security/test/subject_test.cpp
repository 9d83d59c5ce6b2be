#include "saphira/security/subject.hpp"

#include <gtest/gtest.h>

namespace saphira::security {
namespace {

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
