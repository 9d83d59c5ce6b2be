#include "saphira/security/credentials.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "crypto.hpp"
#include "files.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/documents.hpp"
#include "saphira/security/seal.hpp"

namespace saphira::security {

namespace fs = std::filesystem;

namespace {

// Which of its roles a program has that the site's roles do not name.
constexpr std::array<const char*, 4> kOfPeople{"operator", "agent", "observer", "recorder"};

constexpr const char* kCopy = "copy the folder anew from the authority";

[[noreturn]] void fail(const std::string& file, const std::string& what, const std::string& todo) {
  throw std::invalid_argument(file + ": " + what + "; " + todo);
}

std::string read(const std::string& file) {
  try {
    return read_bytes(file);
  } catch (const std::exception& error) {
    throw std::invalid_argument(
        std::string(error.what()) +
        "; a folder of credentials is made by `saphira security add` and copied whole, by and for "
        "the user who runs the program");
  }
}

std::string role_for(const std::string& folder, const std::string& program, const Roles& roles) {
  const std::vector<std::string> there = roles_in(folder);
  const auto has = [&](const std::string& role) {
    return std::find(there.begin(), there.end(), role) != there.end();
  };
  const std::string all = joined(there);
  const Role* const named = roles.of_program(program);
  if (named != nullptr) {
    if (has(named->name))
      return named->name;
    fail(folder,
         "has credentials of " + (all.empty() ? "no role" : all) + ", and " + program +
             " needs those of " + named->name,
         "`saphira security add NAME --role " + named->name + "` makes them");
  }
  for (const char* const role : kOfPeople)
    if (has(role))
      return role;
  // The robot's own machine may have no person's: its commands look with those of its programs.
  if (!there.empty())
    return has("services") ? "services" : there.front();
  fail(folder, "has no credentials of an operator, agent, observer or recorder",
       "`saphira security add NAME --role operator` makes them");
}

/// The part that all roles of a folder have in common: the authority and the list of roles.
Credentials load_shared(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    fail(folder, "there is no such folder of credentials",
         "`saphira security add` makes one on the machine of the authority; copy it here. "
         "For a simulator on this machine alone, --security none runs without");
  Credentials found;
  found.files.authority = folder + "/" + kAuthority;
  found.authority = read(found.files.authority);
  const std::string roles_file = folder + "/" + kRoles;
  const std::string roles_text = read(roles_file);
  found.roles = checked(roles_file, kCopy, [&] {
    return parse_signed_roles(verified(roles_text, found.authority), roles_file);
  });
  return found;
}

}  // namespace

PrefixHead prefix_head(const Subject& subject) {
  return name_hash_head(subject);
}

std::vector<std::string> roles_in(const std::string& folder) {
  std::vector<std::string> roles;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_directory(error) && is_name(entry.path().filename().string()) &&
        fs::exists(entry.path() / kCertificate, error))
      roles.push_back(entry.path().filename().string());
  std::sort(roles.begin(), roles.end());
  return roles;
}

Credentials load_credentials(const std::string& folder, const std::string& program,
                             std::int64_t now) {
  return load_role(folder, role_for(folder, program, load_shared(folder).roles), now);
}

Credentials load_role(const std::string& folder, const std::string& role, std::int64_t now) {
  Credentials found = load_shared(folder);
  const std::string own = folder + "/" + role + "/";
  found.files.governance = folder + "/" + kGovernance;
  found.files.certificate = own + kCertificate;
  found.files.key = own + kKey;
  found.files.permissions = own + kPermissions;

  const std::string certificate = read(found.files.certificate);
  std::int64_t from = 0;
  checked(found.files.certificate, kCopy, [&] {
    check_signed(certificate, found.authority);
    const CertificateText text = read_certificate(certificate);
    const auto subject = parse_subject(text.subject);
    if (!subject)
      throw std::runtime_error("\"" + text.subject + "\" is no member of a site");
    from = text.validity.from;
    if (now >= text.validity.until)
      fail(found.files.certificate, "it has expired on " + day_text(text.validity.until),
           "`saphira security renew " + subject->name +
               "` makes a new one (the clock of this machine says " + day_text(now) + ")");
    found.subject = *subject;
    found.until = text.validity.until;
  });
  if (now < from)
    throw NotYet(found.files.certificate + ": it holds from " + day_text(from) +
                 " on; the clock of this machine says " + day_text(now) +
                 ": is that right? A board without a clock gets the time from the network");
  if (const std::string file = folder + "/" + kSiteKey; fs::exists(file)) {
    found.files.site_key = file;
    const std::string text = read(file);
    found.site_keys = checked(file, kCopy, [&] { return parse_site_keys(text); });
  } else if (found.roles.seal_required) {
    fail(file, "there is no key of the site, which its roles require",
         "`saphira security renew " + found.subject.name + "` makes one");
  }
  const std::string key = read(found.files.key);
  checked(found.files.key, kCopy, [&] { check_key(key, certificate); });
  const auto document = [&](const std::string& file) {
    const std::string text = read(file);
    return checked(file, kCopy, [&] { return verified(text, found.authority); });
  };
  document(found.files.governance);
  const std::string permissions = document(found.files.permissions);
  if (subject_of(permissions) != to_text(found.subject))
    fail(found.files.permissions,
         "they are of " + subject_of(permissions) + ", and the certificate beside them is of " +
             to_text(found.subject),
         kCopy);
  found.robot = robot_of(permissions);
  const std::string revoked_file = folder + "/" + kRevoked;
  const Revoked revoked =
      checked(revoked_file, kCopy, [&] { return load_revoked(folder, found.authority); });
  if (revoked.members.contains(common_name(found.subject)))
    fail(found.files.certificate, common_name(found.subject) + " was revoked",
         "`saphira security add " + found.subject.name + " --role " + found.subject.role +
             "` makes a new one, if it should have one");
  return found;
}

std::string trouble_of_key(const Credentials& credentials) {
  const auto is_open = [](const std::string& path) {
    struct stat file {};
    return !path.empty() && ::stat(path.c_str(), &file) == 0 &&
           (file.st_mode & (S_IRWXG | S_IRWXO)) != 0;
  };
  const CredentialFiles& files = credentials.files;
  if (is_open(files.key))
    return files.key + ": other users of this machine may read it, and be " +
           credentials.subject.name + " then; chmod 600 " + files.key;
  if (is_open(files.site_key))
    return files.site_key + ": other users of this machine may read it, and announce programs in " +
           "the name of the site then; chmod 600 " + files.site_key;
  const fs::path own = fs::path(files.key).parent_path();
  for (const fs::path& folder : {own, own.parent_path()})
    if (struct stat state{};
        ::stat(folder.c_str(), &state) == 0 && (state.st_mode & (S_IWGRP | S_IWOTH)) != 0)
      return folder.string() +
             ": other users of this machine may put other keys there; chmod go-w " +
             folder.string();
  return {};
}

std::string to_text(const Revoked& revoked) {
  std::string text = "revoked " + std::to_string(revoked.number) + "\n";
  for (const std::string& member : revoked.members)
    text += member + "\n";
  return text;
}

Revoked load_revoked(const std::string& folder, const std::string& authority_certificate) {
  const std::string file = folder + "/" + kRevoked;
  const std::string text = verified(read_bytes(file), authority_certificate);
  Revoked revoked;
  bool first = true;
  for (const Line& line : split_lines(text)) {
    if (!std::exchange(first, false)) {
      revoked.members.insert(std::string(line.words.front().text));
      continue;
    }
    LineReader words(file, line);
    if (words.word("revoked") != "revoked")
      words.fail("expected revoked and the number of the list");
    revoked.number =
        static_cast<std::uint64_t>(words.integer("the number of the list", 0, 1L << 40));
  }
  if (first)
    throw std::runtime_error("expected a list of revoked members");
  return revoked;
}

}  // namespace saphira::security
