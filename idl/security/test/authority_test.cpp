#include "saphira/security/authority.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "site.hpp"

namespace saphira::security::test {
namespace {

namespace fs = std::filesystem;

TEST(AuthorityTest, AMemberHasAFolderToCarry) {
  const Folder folder;
  const std::string made = folder.authority().add("flakey", {"bridge", "services"}, "", 365, kNow);
  EXPECT_EQ(roles_in(made), (std::vector<std::string>{"bridge", "services"}));
  const Credentials bridge = load_credentials(made, "bridge", kNow);
  EXPECT_EQ(bridge.subject, (Subject{"flakey", 1, "bridge", "office"}));
  EXPECT_EQ(bridge.until, kNow + 365 * kDay);
  EXPECT_EQ(load_credentials(made, "behaviors", kNow).subject.role, "services");
}

TEST(AuthorityTest, KeysAreForTheirUserAlone) {
  const Folder folder;
  const std::string made = folder.authority().add("karen", {"operator"}, "", 365, kNow);
  int keys = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path("")))
    if (says(entry.path().filename().string(), "key")) {
      ++keys;
      EXPECT_EQ(entry.status().permissions(), fs::perms::owner_read | fs::perms::owner_write)
          << entry.path();
    }
  EXPECT_EQ(keys, 4) << "of the authority, the site (in both) and the member";
  EXPECT_EQ(fs::status(made).permissions(), fs::perms::owner_all);
}

TEST(AuthorityTest, IsFoundAgainAsItWas) {
  const Folder folder;
  folder.authority().add("karen", {"operator"}, "flakey", 10, kNow);
  const Authority again(folder.path());
  EXPECT_EQ(again.site(), "office");
  ASSERT_EQ(again.members().count("karen"), 1U);
  const Authority::Member& karen = again.members().at("karen");
  EXPECT_EQ(karen.robot, "flakey");
  EXPECT_EQ(karen.roles, std::vector<std::string>{"operator"});
  EXPECT_EQ(karen.until, kNow + 10 * kDay);
  EXPECT_FALSE(karen.revoked);
}

TEST(AuthorityTest, IsNotMadeOverAnother) {
  const Folder folder;
  folder.authority();
  EXPECT_TRUE(says(trouble([&] { folder.authority("other"); }), "holds an authority already"));
  EXPECT_EQ(Authority(folder.path()).site(), "office");
}

TEST(AuthorityTest, MistakesAreTold) {
  const Folder folder;
  EXPECT_TRUE(says(trouble([&] { Authority none(folder.path()); }), "saphira security init"));
  EXPECT_TRUE(says(trouble([&] { folder.authority("Office"); }), "no name of a site"));
  Authority authority = folder.authority();
  const auto adding = [&](const std::string& name, const std::string& role,
                          const std::string& robot = "", int days = 1) {
    return trouble([&] { authority.add(name, {role}, robot, days, kNow); });
  };
  EXPECT_TRUE(says(adding("../karen", "operator"), "no name of a member"));
  EXPECT_TRUE(says(adding("karen", "operater"), "did you mean operator?"));
  EXPECT_TRUE(says(adding("karen", "operator", "*"), "name of one robot"));
  EXPECT_TRUE(says(adding("karen", "operator", "", 0), "expected 1 to"));
  EXPECT_EQ(adding("karen", "operator"), "");
  EXPECT_TRUE(says(adding("karen", "operator"), "renew karen"));
  EXPECT_TRUE(says(trouble([&] { authority.renew("karn", 1, kNow); }), "did you mean karen?"));
  EXPECT_TRUE(says(trouble([&] { authority.revoke("john"); }), "no member \"john\""));
}

TEST(AuthorityTest, WhatIsRenewedHoldsBesideTheOld) {
  const Folder folder;
  Authority authority = folder.authority();
  const std::string made = authority.add("karen", {"operator"}, "flakey", 10, kNow);
  fs::copy(made, folder.path("old"), fs::copy_options::recursive);
  authority.renew("karen", 365, kNow + 9 * kDay);
  const std::int64_t later = kNow + 9 * kDay;
  EXPECT_EQ(load_credentials(made, "cli", later).subject.issue, 2U);
  EXPECT_EQ(load_credentials(made, "cli", later).until, later + 365 * kDay);
  EXPECT_EQ(load_credentials(folder.path("old"), "cli", later).subject.issue, 1U);
}

TEST(AuthorityTest, WhatIsRevokedDoesNotStartAgain) {
  const Folder folder;
  Authority authority = folder.authority();
  const std::string karen = authority.add("karen", {"operator"}, "", 365, kNow);
  const std::string john = authority.add("john", {"operator"}, "", 365, kNow);
  authority.renew("karen", 365, kNow);
  authority.revoke("karen");
  EXPECT_TRUE(says(trouble([&] { load_credentials(karen, "cli", kNow); }), "karen.2 was revoked"));
  EXPECT_EQ(load_credentials(john, "cli", kNow).subject.name, "john");
  const Revoked list = load_revoked(john, load_credentials(john, "cli", kNow).authority);
  EXPECT_EQ(list.number, 1U);
  EXPECT_EQ(list.members, (std::set<std::string>{"karen.1", "karen.2"}));
  EXPECT_TRUE(says(trouble([&] { authority.renew("karen", 1, kNow); }), "was revoked"));
  authority.add("karen", {"observer"}, "", 365, kNow);
  const Credentials again = load_credentials(karen, "cli", kNow);
  EXPECT_EQ(again.subject, (Subject{"karen", 3, "observer", "office"}));
}

TEST(AuthorityTest, NoCertificateIsMadeThatARevocationWouldNotList) {
  const Folder folder;
  Authority authority = folder.authority();
  const std::string karen = authority.add("karen", {"operator"}, "", 365, kNow);
  // No file can take the place of a folder with something in it.
  const std::string members = folder.path() + "/members.txt";
  fs::rename(members, folder.path("kept"));
  fs::create_directories(members + "/in the way");
  EXPECT_TRUE(says(trouble([&] { authority.renew("karen", 365, kNow); }), "members.txt"));
  EXPECT_TRUE(
      says(trouble([&] { authority.add("john", {"operator"}, "", 365, kNow); }), "members.txt"));
  EXPECT_EQ(load_credentials(karen, "cli", kNow).subject.issue, 1U);
  EXPECT_FALSE(fs::exists(folder.path() + "/members/john"));
  const auto repaired = [&] {
    fs::remove_all(members);
    fs::copy(folder.path("kept"), members);
    return Authority(folder.path());
  };
  Authority again = repaired();
  fs::remove_all(members);
  fs::create_directories(members + "/in the way");
  EXPECT_TRUE(says(trouble([&] { again.revoke("karen"); }), "members.txt"));
  repaired().revoke("karen");
  EXPECT_TRUE(says(trouble([&] { load_credentials(karen, "cli", kNow); }), "karen.1 was revoked"));
  EXPECT_EQ(load_revoked(karen, read_bytes(karen + "/authority.pem")).number, 2U)
      << "a list with the number of one before would not be taken";
}

TEST(AuthorityTest, ARevocationMakesANewKeyOfTheSite) {
  const Folder folder;
  Authority authority = folder.authority();
  std::map<std::string, std::string> made;
  for (const char* const name : {"karen", "john", "gone"})
    made[name] = authority.add(name, {"operator"}, "", 365, kNow);
  const auto keys = [&](const char* name) {
    return load_credentials(made[name], "cli", kNow).site_keys;
  };
  const std::vector<std::string> old = keys("karen");
  ASSERT_EQ(old.size(), 1U);
  EXPECT_EQ(keys("john"), old);
  authority.revoke("gone");
  EXPECT_EQ(keys("karen"), old) << "until it is renewed";
  authority.renew("karen", 365, kNow);
  const std::vector<std::string> both = keys("karen");
  ASSERT_EQ(both.size(), 2U);
  EXPECT_NE(both[0], old[0]);
  EXPECT_EQ(both[1], old[0]) << "john has no other one yet";
  authority.renew("john", 365, kNow);
  EXPECT_EQ(keys("john"), both);
  Authority again(folder.path());
  again.renew("karen", 365, kNow);
  EXPECT_EQ(keys("karen"), std::vector<std::string>{both[0]}) << "all have the new one";
  made["new"] = again.add("new", {"operator"}, "", 365, kNow);
  EXPECT_EQ(keys("new"), std::vector<std::string>{both[0]});
}

TEST(AuthorityTest, ASiteFromBeforeTheSealGetsAKey) {
  const Folder folder;
  Authority authority = folder.authority();
  const std::string karen = authority.add("karen", {"operator"}, "", 365, kNow);
  const std::string john = authority.add("john", {"operator"}, "", 365, kNow);
  for (const std::string& file :
       {folder.path() + "/site.key", karen + "/site.key", john + "/site.key"})
    fs::remove(file);
  EXPECT_TRUE(load_credentials(karen, "cli", kNow).site_keys.empty());
  authority.renew("karen", 365, kNow);
  authority.renew("john", 365, kNow);
  EXPECT_EQ(load_credentials(karen, "cli", kNow).site_keys.size(), 1U);
  EXPECT_EQ(load_credentials(karen, "cli", kNow).site_keys,
            load_credentials(john, "cli", kNow).site_keys);
}

}  // namespace
}  // namespace saphira::security::test
