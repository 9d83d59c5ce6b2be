#include "crypto.hpp"

#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <cstring>
#include <ctime>
#include <memory>

#include "saphira/security/documents.hpp"

namespace saphira::security {
namespace {

template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};
template <class T, auto Free>
using Owned = std::unique_ptr<T, Freed<Free>>;
using Key = Owned<EVP_PKEY, EVP_PKEY_free>;
using Certificate = Owned<X509, X509_free>;
using Name = Owned<X509_NAME, X509_NAME_free>;
using Signature = Owned<PKCS7, PKCS7_free>;
using Memory = Owned<BIO, BIO_free_all>;

[[noreturn]] void fail(const std::string& what) {
  const char* const reason = ERR_reason_error_string(ERR_peek_last_error());
  ERR_clear_error();
  throw std::runtime_error(what + (reason == nullptr ? "" : std::string(" (") + reason + ")"));
}

Memory memory(const std::string& text) {
  return Memory(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

Memory memory() {
  return Memory(BIO_new(BIO_s_mem()));
}

std::string content(const Memory& from) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(from.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

Key new_key() {
  Key key(EVP_EC_gen("P-256"));
  if (!key)
    fail("no key could be made");
  return key;
}

std::string to_pem(const Key& key) {
  const Memory out = memory();
  if (PEM_write_bio_PrivateKey(out.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1)
    fail("a key could not be written");
  return content(out);
}

std::string to_pem(const Certificate& certificate) {
  const Memory out = memory();
  if (PEM_write_bio_X509(out.get(), certificate.get()) != 1)
    fail("a certificate could not be written");
  return content(out);
}

Key key_of(const std::string& pem) {
  const auto no_password = [](char*, int, int, void*) { return 0; };  // else it asks the terminal
  Key key(PEM_read_bio_PrivateKey(memory(pem).get(), nullptr, no_password, nullptr));
  if (!key)
    fail("expected a private key in PEM");
  return key;
}

Certificate certificate_of(const std::string& pem) {
  Certificate certificate(PEM_read_bio_X509(memory(pem).get(), nullptr, nullptr, nullptr));
  if (!certificate)
    fail("expected a certificate in PEM");
  return certificate;
}

void add(X509_NAME* name, const char* part, const std::string& value) {
  if (X509_NAME_add_entry_by_txt(name, part, MBSTRING_ASC,
                                 reinterpret_cast<const unsigned char*>(value.data()),
                                 static_cast<int>(value.size()), -1, 0) != 1)
    fail("\"" + value + "\" cannot be part of a certificate's subject");
}

// RFC 2253 writes the last part first.
Name name_of(const Subject& subject) {
  Name name(X509_NAME_new());
  add(name.get(), "O", subject.site);
  add(name.get(), "OU", subject.role);
  add(name.get(), "CN", common_name(subject));
  return name;
}

void extend(X509* certificate, X509* issuer, int kind, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const Owned<X509_EXTENSION, X509_EXTENSION_free> extension(
      X509V3_EXT_conf_nid(nullptr, &context, kind, value));
  if (!extension || X509_add_ext(certificate, extension.get(), -1) != 1)
    fail("a certificate could not be made");
}

Certificate new_certificate(const X509_NAME* subject, EVP_PKEY* key, Validity validity) {
  Certificate made(X509_new());
  std::array<unsigned char, 8> serial{};
  if (!made || RAND_bytes(serial.data(), serial.size()) != 1)
    fail("a certificate could not be made");
  std::uint64_t number = 0;
  std::memcpy(&number, serial.data(), sizeof number);
  X509_set_version(made.get(), X509_VERSION_3);
  ASN1_INTEGER_set_uint64(X509_get_serialNumber(made.get()), number >> 1U);
  ASN1_TIME_set(X509_getm_notBefore(made.get()), validity.from);
  ASN1_TIME_set(X509_getm_notAfter(made.get()), validity.until);
  X509_set_subject_name(made.get(), subject);
  X509_set_pubkey(made.get(), key);
  return made;
}

std::int64_t seconds(const ASN1_TIME* time) {
  std::tm utc{};
  if (ASN1_TIME_to_tm(time, &utc) != 1)
    fail("a certificate has no time that can be read");
  return timegm(&utc);
}

}  // namespace

KeyPair make_authority(const std::string& site, Validity validity) {
  const Key key = new_key();
  const Name name(X509_NAME_new());
  add(name.get(), "O", site);
  add(name.get(), "CN", site + " authority");
  const Certificate made = new_certificate(name.get(), key.get(), validity);
  X509_set_issuer_name(made.get(), name.get());
  extend(made.get(), made.get(), NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
  extend(made.get(), made.get(), NID_key_usage, "critical,keyCertSign,cRLSign,digitalSignature");
  extend(made.get(), made.get(), NID_subject_key_identifier, "hash");
  if (X509_sign(made.get(), key.get(), EVP_sha256()) == 0)
    fail("a certificate could not be signed");
  return {to_pem(key), to_pem(made)};
}

KeyPair make_member(const Subject& subject, Validity validity, const KeyPair& authority) {
  const Key signer = key_of(authority.key);
  const Certificate issuer = certificate_of(authority.certificate);
  const Key key = new_key();
  const Certificate made = new_certificate(name_of(subject).get(), key.get(), validity);
  X509_set_issuer_name(made.get(), X509_get_subject_name(issuer.get()));
  extend(made.get(), issuer.get(), NID_basic_constraints, "critical,CA:FALSE");
  extend(made.get(), issuer.get(), NID_key_usage, "critical,digitalSignature,keyAgreement");
  if (X509_sign(made.get(), signer.get(), EVP_sha256()) == 0)
    fail("a certificate could not be signed");
  return {to_pem(key), to_pem(made)};
}

void only_authorities_sign() {
  static const bool once = [] {
    static const auto before =
        X509_PURPOSE_get0(X509_PURPOSE_get_by_id(X509_PURPOSE_SMIME_SIGN))->check_purpose;
    // ca: 0 for the signer, 1 for those that vouch for it. A self-signed certificate is trusted
    // only where it is the authority's own.
    const auto check = [](const X509_PURPOSE* purpose, const X509* certificate, int ca) {
      return ca == 0 && X509_self_signed(const_cast<X509*>(certificate), 1) != 1
                 ? 0
                 : before(purpose, certificate, ca);
    };
    std::string name = "S/MIME signing by an authority";
    std::string short_name = "smimesign";
    if (X509_PURPOSE_add(X509_PURPOSE_SMIME_SIGN, X509_TRUST_EMAIL, 0, check, name.data(),
                         short_name.data(), nullptr) != 1)
      fail("the signers of permissions cannot be restricted");
    return true;
  }();
  static_cast<void>(once);
}

std::string sign(const std::string& text, const KeyPair& authority) {
  constexpr int kFlags = PKCS7_DETACHED | PKCS7_TEXT | PKCS7_STREAM;
  const Memory in = memory(text);
  const Memory out = memory();
  const Signature made(PKCS7_sign(certificate_of(authority.certificate).get(),
                                  key_of(authority.key).get(), nullptr, in.get(), kFlags));
  if (!made || SMIME_write_PKCS7(out.get(), made.get(), in.get(), kFlags) != 1)
    fail("a document could not be signed");
  return content(out);
}

std::string verified(const std::string& document, const std::string& authority_certificate) {
  BIO* detached = nullptr;
  const Signature found(SMIME_read_PKCS7(memory(document).get(), &detached));
  const Memory text(detached);
  if (!found || !text)
    fail("expected a document that an authority has signed");
  const Certificate authority = certificate_of(authority_certificate);
  STACK_OF(X509)* const signers = sk_X509_new_null();
  sk_X509_push(signers, authority.get());
  const Memory out = memory();
  const int good = PKCS7_verify(found.get(), signers, nullptr, text.get(), out.get(),
                                PKCS7_TEXT | PKCS7_NOVERIFY | PKCS7_NOINTERN);
  sk_X509_free(signers);
  if (good != 1)
    fail("the signature is not that of this site's authority, or the document was changed");
  std::string plain = content(out);
  std::erase(plain, '\r');
  return plain;
}

CertificateText read_certificate(const std::string& pem) {
  const Certificate certificate = certificate_of(pem);
  const Memory out = memory();
  X509_NAME_print_ex(out.get(), X509_get_subject_name(certificate.get()), 0, XN_FLAG_RFC2253);
  return {content(out),
          {seconds(X509_get0_notBefore(certificate.get())),
           seconds(X509_get0_notAfter(certificate.get()))}};
}

void check_signed(const std::string& certificate, const std::string& authority_certificate) {
  const Certificate authority = certificate_of(authority_certificate);
  if (X509_verify(certificate_of(certificate).get(), X509_get0_pubkey(authority.get())) != 1)
    fail("another authority has signed it");
}

void check_key(const std::string& key, const std::string& certificate) {
  if (X509_check_private_key(certificate_of(certificate).get(), key_of(key).get()) != 1)
    fail("it is the key of another certificate");
}

std::array<std::uint8_t, 6> name_hash_head(const Subject& subject) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
  unsigned size = 0;
  if (X509_NAME_digest(name_of(subject).get(), EVP_sha256(), hash.data(), &size) != 1)
    fail("no hash of a subject");
  // A one, and the first 47 bits of the hash.
  std::array<std::uint8_t, 6> head{};
  unsigned carry = 1;
  for (std::size_t i = 0; i < head.size(); ++i) {
    head[i] = static_cast<std::uint8_t>((carry << 7U) | (hash[i] >> 1U));
    carry = hash[i] & 1U;
  }
  return head;
}

}  // namespace saphira::security
