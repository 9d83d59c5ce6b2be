#include "saphira/security/credentials.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "saphira/base/durable.hpp"
#include "site.hpp"

namespace saphira::security::test {
namespace {

namespace fs = std::filesystem;

class CredentialsTest : public testing::Test {
 protected:
  Folder folder_;
  std::string made_ = folder_.authority().add("karen", {"operator"}, "", 365, kNow);

  std::string loading(std::int64_t now = kNow, const std::string& program = "cli") const {
    return trouble([&] { load_credentials(made_, program, now); });
  }
  void change(const std::string& file, const std::string& what, const std::string& by) const {
    std::string text = read_file(made_ + "/" + file);
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos);
    ASSERT_TRUE(replace_file(made_ + "/" + file, text.replace(at, what.size(), by)));
  }
};

TEST_F(CredentialsTest, TimesAreTold) {
  EXPECT_EQ(loading(), "");
  EXPECT_TRUE(says(loading(kNow + 365 * kDay), "has expired on 2028-01-15"));
  EXPECT_TRUE(says(loading(kNow + 365 * kDay), "saphira security renew karen"));
  EXPECT_TRUE(says(loading(kNow - 2 * kDay), "holds from"));
  EXPECT_TRUE(says(loading(kNow - 2 * kDay), "clock of this machine"));
  EXPECT_THROW(load_credentials(made_, "cli", kNow - 2 * kDay), NotYet) << "no mistake of a person";
}

TEST_F(CredentialsTest, EachMissingFileIsNamed) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(made_))
    if (entry.is_regular_file() && entry.path().filename() != "site.key")
      files.push_back(entry.path().string());
  ASSERT_EQ(files.size(), 7U);
  for (const std::string& file : files) {
    fs::rename(file, file + ".away");
    // Without its certificate a folder has no role.
    const std::string named = says(file, "certificate") ? made_ : file;
    EXPECT_TRUE(says(loading(), named)) << file << ": " << loading();
    fs::rename(file + ".away", file);
  }
  EXPECT_EQ(loading(), "");
}

TEST_F(CredentialsTest, TheKeyOfTheSiteIsCheckedAndForItsUserAlone) {
  const std::string file = made_ + "/site.key";
  EXPECT_EQ(trouble_of_key(load_credentials(made_, "cli", kNow)), "");
  fs::permissions(file, fs::perms::group_read, fs::perm_options::add);
  EXPECT_TRUE(says(trouble_of_key(load_credentials(made_, "cli", kNow)), file));
  ASSERT_TRUE(replace_file(file, "no key\n"));
  EXPECT_TRUE(says(loading(), file));
  fs::remove(file);
  EXPECT_EQ(loading(), "") << "of a site from before";
}

TEST_F(CredentialsTest, ChangedDocumentsAreTold) {
  change("roles.signed", "drive/teleop: {write: [operator]", "drive/teleop: {write: [observer]");
  EXPECT_TRUE(says(loading(), "roles.signed: the signature is not that of")) << loading();
  change("roles.signed", "drive/teleop: {write: [observer]", "drive/teleop: {write: [operator]");
  EXPECT_EQ(loading(), "");
  change("operator/permissions.signed", "<topic>goals</topic>", "<topic>robot/state</topic>");
  EXPECT_TRUE(says(loading(), "permissions.signed: the signature is not that of")) << loading();
}

TEST_F(CredentialsTest, FilesOfOthersAreTold) {
  Authority other = folder_.authority("office", "other");
  const std::string theirs = other.add("karen", {"operator"}, "", 365, kNow);
  const auto copy = [&](const std::string& file) {
    fs::copy(theirs + "/" + file, made_ + "/" + file, fs::copy_options::overwrite_existing);
  };
  copy("operator/key.pem");
  EXPECT_TRUE(says(loading(), "key of another certificate")) << loading();
  copy("operator/certificate.pem");
  EXPECT_TRUE(says(loading(), "another authority has signed it")) << loading();
}

TEST_F(CredentialsTest, PermissionsOfAnotherMemberAreTold) {
  Authority authority(folder_.path());
  const std::string robots = authority.add("flakey", {"bridge"}, "", 365, kNow);
  fs::copy(robots + "/bridge/permissions.signed", made_ + "/operator/permissions.signed",
           fs::copy_options::overwrite_existing);
  EXPECT_TRUE(says(loading(), "they are of CN=flakey.1,OU=bridge,O=office")) << loading();
}

TEST_F(CredentialsTest, AKeyThatOthersMayReadIsTold) {
  const Credentials good = load_credentials(made_, "cli", kNow);
  EXPECT_EQ(trouble_of_key(good), "");
  for (const fs::perms others : {fs::perms::group_read, fs::perms::others_read}) {
    fs::permissions(good.files.key, fs::perms::owner_read | others);
    EXPECT_TRUE(says(trouble_of_key(good), "chmod 600 " + good.files.key));
  }
}

TEST_F(CredentialsTest, AFolderThatOthersMayWriteIsTold) {
  const Credentials good = load_credentials(made_, "cli", kNow);
  for (const std::string& folder : {made_, made_ + "/operator"})
    for (const fs::perms others : {fs::perms::group_write, fs::perms::others_write}) {
      fs::permissions(folder, others, fs::perm_options::add);
      EXPECT_EQ(
          trouble_of_key(good),
          folder + ": other users of this machine may put other keys there; chmod go-w " + folder);
      fs::permissions(folder, others, fs::perm_options::remove);
    }
  EXPECT_EQ(trouble_of_key(good), "");
}

TEST_F(CredentialsTest, AProgramNeedsItsRole) {
  const std::string text = loading(kNow, "bridge");
  EXPECT_TRUE(says(text, "has credentials of operator, and bridge needs those of bridge")) << text;
  EXPECT_TRUE(
      says(trouble([&] { load_credentials("/nowhere", "cli", kNow); }), "saphira security add"));
}

TEST(PrefixHead, IsOfTheSubjectAlone) {
  const Subject karen{"karen", 1, "operator", "office"};
  EXPECT_EQ(prefix_head(karen), prefix_head(karen));
  EXPECT_NE(prefix_head(karen), prefix_head({"karen", 2, "operator", "office"}));
  EXPECT_NE(prefix_head(karen), prefix_head({"karen", 1, "observer", "office"}));
  EXPECT_NE(prefix_head(karen)[0] & 0x80, 0);
}

}  // namespace
}  // namespace saphira::security::test
