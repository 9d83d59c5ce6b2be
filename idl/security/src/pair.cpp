#include "saphira/security/pair.hpp"

#include <stdexcept>

#include "crypto.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/documents.hpp"

namespace saphira::security {
namespace {

/// Calls f(), and adds the name of the file and the remedy to its error.
template <class F>
auto checked(const std::string& file, const std::string& todo, F&& f) {
  try {
    return f();
  } catch (const UnusableFile& error) {
    throw std::invalid_argument(error.what());
  } catch (const std::exception& error) {
    throw std::invalid_argument(file + ": " + error.what() + "; " + todo);
  }
}

std::string day(std::int64_t seconds) {
  return utc_text(seconds, "%Y-%m-%d %H:%M UTC");
}

}  // namespace

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
    return certificate_file + ": it holds from " + day(text.validity.from) +
           " on; the clock of this machine says " + day(now) + ": is that right?";
  if (now >= text.validity.until)
    return certificate_file + ": it has expired on " + day(text.validity.until) +
           "; browsers refuse it: get a new one (the clock of this machine says " + day(now) + ")";
  return {};
}

}  // namespace saphira::security
