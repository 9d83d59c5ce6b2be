#pragma once

#include <cstdint>
#include <string>

#include "saphira/security/roles.hpp"
#include "saphira/security/subject.hpp"

namespace saphira::security {

/// A time [s since 1970], such as "2027-01-25 10:00 UTC".
std::string day_text(std::int64_t seconds);

/// The rules that every program of a site demands of every other (DDS Security 1.1, 9.4.1.2).
/// Participants without authentication are not heard. Every topic has its readers and writers.
/// Discovery and all messages are encrypted; only the permitted readers of a topic have its key.
std::string governance();

/// The permissions of a member, until when [s since 1970, UTC] (DDS Security 1.1, 9.4.1.3).
/// `robot`: the only one whose topics it may write and read [empty: those of all].
struct Grant {
  Subject subject;
  std::string robot;
  std::int64_t from = 0;
  std::int64_t until = 0;
};
std::string permissions(const Grant& grant, const Roles& roles);
/// Whose signature counts in this process, from the first call on: that of an authority alone, not
/// that of a member whom the authority has certified. Fast DDS 2.9 takes permissions from any
/// certificate of the site (CVE-2023-24010). It asks OpenSSL for the purpose of the signer's
/// certificate (S/MIME), and there this is decided, for all users of OpenSSL in the process: before
/// the first participant is made. From any thread.
void only_authorities_sign();
/// The robot of a grant that permissions() wrote, and its subject as RFC 2253 writes it.
std::string robot_of(const std::string& permissions);
std::string subject_of(const std::string& permissions);

}  // namespace saphira::security
