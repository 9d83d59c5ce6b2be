#pragma once

// Keys, certificates and signatures by libcrypto.

#include <array>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string>

#include "saphira/base/text.hpp"
#include "saphira/security/subject.hpp"

namespace saphira::security {

struct KeyPair {
  std::string key;          ///< PEM
  std::string certificate;  ///< PEM
};

/// A period of validity [s since 1970].
struct Validity {
  std::int64_t from = 0;
  std::int64_t until = 0;
};

struct CertificateText {
  std::string subject;  ///< as RFC 2253 writes it
  Validity validity;
};

/// Of an authority: signs certificates and documents.
KeyPair make_authority(const std::string& site, Validity validity);
KeyPair make_member(const Subject& subject, Validity validity, const KeyPair& authority);

/// S/MIME, as DDS Security wants its documents.
std::string sign(const std::string& text, const KeyPair& authority);

// All of these throw std::runtime_error with the reason, without the file.

/// Calls f(). Its error is a std::invalid_argument that names the file and the remedy.
template <class F>
auto checked(const std::string& file, const std::string& todo, F&& f) {
  try {
    return f();
  } catch (const std::invalid_argument&) {
    throw;
  } catch (const UnusableFile& error) {
    throw std::invalid_argument(error.what());
  } catch (const std::exception& error) {
    throw std::invalid_argument(file + ": " + error.what() + "; " + todo);
  }
}

/// The text of a document that this authority has signed.
std::string verified(const std::string& document, const std::string& authority_certificate);
CertificateText read_certificate(const std::string& pem);
/// std::runtime_error unless the authority has signed the certificate.
void check_signed(const std::string& certificate, const std::string& authority_certificate);
/// std::runtime_error unless the private key is that of the certificate.
void check_key(const std::string& key, const std::string& certificate);

/// As prefix_head().
std::array<std::uint8_t, 6> name_hash_head(const Subject& subject);

}  // namespace saphira::security
