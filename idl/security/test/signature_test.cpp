// Whose signature under a document counts for Fast DDS: its call of OpenSSL, with forged documents.
#include <gtest/gtest.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>

#include <string>
#include <vector>

#include "crypto.hpp"
#include "saphira/security/documents.hpp"
#include "site.hpp"

namespace saphira::security::test {
namespace {

X509* certificate_of(const KeyPair& pair) {
  BIO* const in = BIO_new_mem_buf(pair.certificate.data(), -1);
  X509* const read = PEM_read_bio_X509(in, nullptr, nullptr, nullptr);
  BIO_free(in);
  return read;
}

EVP_PKEY* key_of(const KeyPair& pair) {
  BIO* const in = BIO_new_mem_buf(pair.key.data(), -1);
  EVP_PKEY* const read = PEM_read_bio_PrivateKey(in, nullptr, nullptr, nullptr);
  BIO_free(in);
  return read;
}

std::string content(BIO* from) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(from, &data);
  std::string text(data, static_cast<std::size_t>(size));
  BIO_free(from);
  return text;
}

/// The content of a document as Fast DDS 2.9 reads it (Permissions.cpp); empty where it refuses it.
std::string taken(const std::string& document, const KeyPair& authority) {
  X509_STORE* const store = X509_STORE_new();
  X509* const trusted = certificate_of(authority);
  X509_STORE_add_cert(store, trusted);
  BIO* const in = BIO_new_mem_buf(document.data(), static_cast<int>(document.size()));
  BIO* text = nullptr;
  BIO* const out = BIO_new(BIO_s_mem());
  PKCS7* const found = SMIME_read_PKCS7(in, &text);
  const int good = PKCS7_verify(found, nullptr, store, text, out, PKCS7_TEXT);
  PKCS7_free(found);
  BIO_free(text);
  BIO_free(in);
  X509_free(trusted);
  X509_STORE_free(store);
  const std::string plain = content(out);
  return good == 1 ? plain : std::string();
}

/// Signs with several, in one document. `flags`: 0 puts the text into the signature.
std::string sign_as(const std::string& text, const std::vector<KeyPair>& signers, int flags,
                    const std::vector<KeyPair>& beside = {}) {
  flags |= PKCS7_TEXT | PKCS7_STREAM;
  BIO* const in = BIO_new_mem_buf(text.data(), static_cast<int>(text.size()));
  BIO* const out = BIO_new(BIO_s_mem());
  PKCS7* const made = PKCS7_sign(nullptr, nullptr, nullptr, in, flags);
  for (const KeyPair& signer : signers) {
    X509* const certificate = certificate_of(signer);
    EVP_PKEY* const key = key_of(signer);
    PKCS7_sign_add_signer(made, certificate, key, nullptr, flags);
    EVP_PKEY_free(key);
    X509_free(certificate);
  }
  for (const KeyPair& other : beside) {
    X509* const certificate = certificate_of(other);
    PKCS7_add_certificate(made, certificate);
    X509_free(certificate);
  }
  SMIME_write_PKCS7(out, made, in, flags);
  PKCS7_free(made);
  BIO_free(in);
  return content(out);
}

class SignatureTest : public testing::Test {
 protected:
  SignatureTest() { only_authorities_sign(); }

  // OpenSSL looks at the clock: certificates that hold for long.
  static constexpr Validity kAlways{0, 4'000'000'000};
  const KeyPair authority_ = make_authority("office", kAlways);
  const KeyPair john_ = make_member({"john", 1, "observer", "office"}, kAlways, authority_);
  const std::string wish_ = "john may drive\r\n";
};

TEST_F(SignatureTest, TheAuthoritysCounts) {
  only_authorities_sign();  // once more
  EXPECT_EQ(taken(sign(wish_, authority_), authority_), wish_);
  EXPECT_EQ(taken(sign_as(wish_, {authority_}, 0), authority_), wish_);
}

TEST_F(SignatureTest, AMembersOwnDoesNot) {
  EXPECT_EQ(taken(sign(wish_, john_), authority_), "");
  EXPECT_EQ(taken(sign_as(wish_, {john_}, 0), authority_), "");
  EXPECT_EQ(taken(sign_as(wish_, {john_}, PKCS7_DETACHED, {authority_}), authority_), "");
}

TEST_F(SignatureTest, AMembersBesideTheAuthoritysDoesNot) {
  EXPECT_EQ(taken(sign_as(wish_, {john_, authority_}, PKCS7_DETACHED), authority_), "");
  EXPECT_EQ(taken(sign_as(wish_, {authority_, john_}, PKCS7_DETACHED), authority_), "");
}

TEST_F(SignatureTest, AMembersAroundTheAuthoritysDoesNot) {
  const std::string genuine = sign("john may watch\r\n", authority_);
  EXPECT_EQ(taken(sign(genuine, john_), authority_), "");
  EXPECT_EQ(taken(sign(sign(wish_, john_), john_), authority_), "");
}

TEST_F(SignatureTest, ThatOfAnotherSiteDoesNot) {
  const KeyPair other = make_authority("office", kAlways);  // of the same name
  const KeyPair bob = make_member({"john", 1, "observer", "office"}, kAlways, other);
  EXPECT_EQ(taken(sign(wish_, other), authority_), "");
  EXPECT_EQ(taken(sign(wish_, bob), authority_), "");
  EXPECT_EQ(taken(sign_as(wish_, {bob}, PKCS7_DETACHED, {other}), authority_), "");
}

TEST_F(SignatureTest, AChangedTextDoesNot) {
  std::string changed = sign(wish_, authority_);
  changed.replace(changed.find("drive"), 5, "watch");
  EXPECT_EQ(taken(changed, authority_), "");
}

}  // namespace
}  // namespace saphira::security::test
