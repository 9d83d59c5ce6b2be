#include "saphira/security/pair.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "site.hpp"

namespace saphira::security::test {
namespace {

class PairTest : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path(name)) << text;
    return folder_.path(name);
  }
  /// The error of two files, or the warning about them.
  std::string checking(const std::string& certificate, const std::string& key,
                       std::int64_t now = kNow) const {
    std::string said;
    const std::string error = trouble([&] { said = check_pair(certificate, key, now); });
    return error + said;
  }

  Folder folder_;
  Authority authority_ = folder_.authority();
  std::string karens_ = authority_.add("karen", {"operator"}, "", 10, kNow) + "/operator/";
  std::string johns_ = authority_.add("john", {"operator"}, "", 10, kNow) + "/operator/";
  std::string certificate_ = karens_ + "certificate.pem";
  std::string key_ = karens_ + "key.pem";
};

TEST_F(PairTest, ItsPeriodIsToldWithTheFile) {
  EXPECT_EQ(checking(certificate_, key_), "");
  const std::string expired = checking(certificate_, key_, kNow + 11 * kDay);
  EXPECT_TRUE(expired.starts_with(certificate_ + ": it has expired on 2027-01-25")) << expired;
  const std::string early = checking(certificate_, key_, kNow - 11 * kDay);
  EXPECT_TRUE(early.starts_with(certificate_ + ": it holds from 2027-01-1")) << early;
}

TEST_F(PairTest, EachMistakeNamesTheFileAndTheRemedy) {
  const std::string empty = write("empty.pem", "");
  const std::string nothing = folder_.path("nothing.pem");
  const std::string wants_certificate = "expected a certificate in PEM";
  for (const std::string& wrong : {empty, key_, write("bytes.pem", "\xFF\xFE\n")}) {
    const std::string said = checking(wrong, key_);
    EXPECT_TRUE(said.starts_with(wrong + ": " + wants_certificate)) << said;
    EXPECT_TRUE(says(said, "give the file that begins with")) << said;
  }
  for (const std::string& wrong : {empty, certificate_}) {
    const std::string said = checking(certificate_, wrong);
    EXPECT_TRUE(said.starts_with(wrong + ": expected a private key in PEM")) << said;
  }
  const std::string other = checking(certificate_, johns_ + "key.pem");
  EXPECT_TRUE(other.starts_with(johns_ + "key.pem: it is the key of another certificate")) << other;
  EXPECT_TRUE(says(other, certificate_)) << other;
  EXPECT_EQ(checking(nothing, key_), nothing + ": cannot be read: No such file or directory");
  EXPECT_EQ(checking(certificate_, nothing),
            nothing + ": cannot be read: No such file or directory");
}

TEST_F(PairTest, AnAuthorityOfADialNamesOptionFileAndRemedy) {
  EXPECT_EQ(trouble([&] { check_dial_authority(certificate_); }), "");
  const std::string remedy =
      "; give the certificate (PEM) of the authority that signed the relay's, or the relay's own "
      "(saphira-relay --certificate)";
  const std::string nothing = folder_.path("nothing.pem");
  EXPECT_EQ(
      trouble([&] { check_dial_authority(nothing); }),
      "--dial-authority: " + nothing + ": cannot be read: No such file or directory" + remedy);
  const std::string said = trouble([&] { check_dial_authority(key_); });
  EXPECT_TRUE(said.starts_with("--dial-authority: " + key_ + ": expected a certificate in PEM"))
      << said;
  EXPECT_TRUE(said.ends_with(remedy)) << said;
}

// Each file of an authority's folder.
TEST_F(PairTest, ADamagedAuthorityNamesTheFile) {
  const std::string folder = folder_.path();
  const auto opening = [&](const std::string& file, const std::string& text) {
    const std::string path = folder + "/" + file;
    const std::string before = read_bytes(path);
    std::ofstream(path) << text;
    const std::string said = trouble([&] { Authority found(folder); });
    std::ofstream(path) << before;
    EXPECT_TRUE(said.starts_with(path + ": ")) << said;
    return said;
  };
  EXPECT_TRUE(says(opening("authority.pem", ""), "expected a certificate in PEM"));
  EXPECT_TRUE(says(opening("authority.key", ""), "expected a private key in PEM"));
  EXPECT_TRUE(says(opening("authority.key", read_bytes(key_)), "the key of another certificate"));
  EXPECT_TRUE(says(opening("revoked.signed", ""), "expected a document"));
  EXPECT_EQ(trouble([&] { Authority found(folder); }), "");
}

}  // namespace
}  // namespace saphira::security::test
