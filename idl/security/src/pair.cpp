#include "saphira/security/pair.hpp"

#include "crypto.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/documents.hpp"

namespace saphira::security {

std::string check_pair(const std::string& certificate_file, const std::string& key_file,
                       std::int64_t now) {
  std::string certificate;
  const CertificateText text =
      checked(certificate_file, "give the file that begins with -----BEGIN CERTIFICATE-----", [&] {
        certificate = read_bytes(certificate_file);
        return read_certificate(certificate);
      });
  checked(key_file, "give the private key that " + certificate_file + " was made for, unencrypted",
          [&] { check_key(read_bytes(key_file), certificate); });
  if (now < text.validity.from)
    return certificate_file + ": it holds from " + day_text(text.validity.from) +
           " on; the clock of this machine says " + day_text(now) + ": is that right?";
  if (now >= text.validity.until)
    return certificate_file + ": it has expired on " + day_text(text.validity.until) +
           "; browsers refuse it: get a new one (the clock of this machine says " + day_text(now) +
           ")";
  return {};
}

void check_dial_authority(const std::string& file) {
  try {
    read_certificate(read_bytes(file));
  } catch (const std::exception& error) {
    const std::string why = error.what();
    throw std::invalid_argument("--dial-authority: " + (why.starts_with(file) ? "" : file + ": ") +
                                why +
                                "; give the certificate (PEM) of the authority that signed the "
                                "relay's, or the relay's own (saphira-relay --certificate)");
  }
}

}  // namespace saphira::security
