#include "saphira/security/authority.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "crypto.hpp"
#include "files.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/robot_name.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/documents.hpp"
#include "saphira/security/seal.hpp"

namespace saphira::security {

namespace fs = std::filesystem;

namespace {

constexpr const char* kAuthorityKey = "authority.key";
constexpr const char* kRolesFile = "roles.yaml";
constexpr const char* kMembers = "members";
constexpr const char* kMembersFile = "members.txt";

constexpr std::int64_t kDay = 86400;
constexpr std::int64_t kYear = 365 * kDay;
constexpr std::int64_t kAuthorityYears = 20;
constexpr int kMostDays = 3650;
// The clock of a machine that is switched on may be somewhat behind.
constexpr std::int64_t kEarlier = kDay;

/// While it lives, new files are for this user alone.
class Private {
 public:
  Private() : before_(::umask(0077)) {}
  ~Private() { ::umask(before_); }
  Private(const Private&) = delete;
  Private& operator=(const Private&) = delete;

 private:
  const mode_t before_;
};

void write(const std::string& file, const std::string& text) {
  if (!replace_file(file, text, true))
    throw UnusableFile(cannot_be(file, "written"));
}

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw UnusableFile(folder + ": cannot be made: " + error.message());
}

KeyPair key_pair(const std::string& key, const std::string& certificate) {
  return {key, certificate};
}

void check_days(int days) {
  if (days < 1 || days > kMostDays)
    throw std::invalid_argument("--days " + std::to_string(days) + ": expected 1 to " +
                                std::to_string(kMostDays));
}

constexpr const char* kRestore = "take the file from the copy of this folder";

}  // namespace

Authority Authority::make(const std::string& folder, const std::string& site,
                          const std::string& roles, const std::string& roles_file,
                          std::int64_t now) {
  if (!is_name(site))
    throw std::invalid_argument(
        "\"" + site +
        "\" is no name of a site: expected up to 32 lower-case letters, digits and hyphens");
  if (fs::exists(folder + "/" + kAuthorityKey))
    throw std::invalid_argument(folder + " holds an authority already: saphira security list");
  parse_roles(roles, roles_file, topics_of_contract());
  const Private mode;
  make_folder(folder);
  const KeyPair pair = make_authority(site, {now - kEarlier, now + kAuthorityYears * kYear});
  write(folder + "/" + kRolesFile, roles);
  write(folder + "/" + kMembersFile, "site " + site + "\nrevocations 0\n");
  write(folder + "/" + kAuthority, pair.certificate);
  write(folder + "/" + kRevoked, sign(to_text(Revoked{}), pair));
  write(folder + "/" + kSiteKey, site_keys_text({new_site_key()}));
  write(folder + "/" + kAuthorityKey, pair.key);
  return Authority(folder);
}

Authority::Authority(const std::string& folder) : folder_(folder) {
  if (!fs::exists(folder_ + "/" + kAuthorityKey))
    throw std::invalid_argument(folder_ +
                                " holds no authority: `saphira security init SITE` makes one");
  const std::string key_file = folder_ + "/" + kAuthorityKey;
  const std::string certificate_file = folder_ + "/" + kAuthority;
  key_ = read_bytes(key_file);
  certificate_ = read_bytes(certificate_file);
  checked(certificate_file, kRestore, [&] { read_certificate(certificate_); });
  checked(key_file, kRestore, [&] { check_key(key_, certificate_); });
  const std::string roles_file = folder_ + "/" + kRolesFile;
  roles_ = parse_roles(read_file(roles_file), roles_file, topics_of_contract());
  load_members();
  checked(folder_ + "/" + kRevoked, kRestore, [&] {
    // The list is written before the number is on record.
    Revoked list = load_revoked(folder_, certificate_);
    revoked_ = {std::max(list.number, revoked_.number), std::move(list.members)};
  });
}

void Authority::load_members() {
  const std::string file = folder_ + "/" + kMembersFile;
  const std::string text = read_file(file);
  expect_last_line_break(text, file);
  for (const Line& line : split_lines(text)) {
    LineReader words(file, line);
    const std::string_view kind = words.word("site, revocations or member");
    if (kind == "site") {
      site_ = words.word("the name of the site");
    } else if (kind == "revocations") {
      revoked_.number = static_cast<std::uint64_t>(words.integer("their number", 0, 1L << 40));
    } else if (kind == "member") {
      const std::string name(words.word("the name of a member"));
      Member member;
      member.issue = static_cast<unsigned>(words.integer("which certificate", 1, 1000000));
      member.until = words.integer("until when, in seconds since 1970", 0, 1L << 40);
      const std::string_view state = words.word("holds or revoked");
      if (state != "holds" && state != "revoked")
        words.fail("expected holds or revoked");
      member.revoked = state == "revoked";
      const std::string_view robot = words.word("the robot, or *");
      member.robot = robot == "*" ? "" : robot;
      while (!words.at_end())
        member.roles.emplace_back(words.word("a role"));
      members_[name] = member;
    } else {
      words.fail("expected site, revocations or member");
    }
    words.expect_end();
  }
}

void Authority::save_members() const {
  std::string text = "site " + site_ + "\nrevocations " + std::to_string(revoked_.number) + "\n";
  for (const auto& [name, member] : members_) {
    text += "member " + name + " " + std::to_string(member.issue) + " " +
            std::to_string(member.until) + (member.revoked ? " revoked " : " holds ") +
            (member.robot.empty() ? "*" : member.robot);
    for (const std::string& role : member.roles)
      text += " " + role;
    text += "\n";
  }
  write(folder_ + "/" + kMembersFile, text);
}

std::string Authority::folder_of(const std::string& member) const {
  return folder_ + "/" + kMembers + "/" + member;
}

std::string Authority::revoked_list() const {
  return folder_ + "/" + kRevoked;
}

Authority::Member& Authority::known(const std::string& name) {
  const auto found = members_.find(name);
  if (found != members_.end())
    return found->second;
  std::vector<std::string> names;
  for (const auto& [other, member] : members_)
    names.push_back(other);
  throw std::invalid_argument("there is no member \"" + name + "\" of " + site_ +
                              did_you_mean(name, names, "; saphira security list names them"));
}

std::string Authority::add(const std::string& name, const std::vector<std::string>& roles,
                           const std::string& robot, int days, std::int64_t now) {
  check_days(days);
  if (!is_name(name))
    throw std::invalid_argument("\"" + name +
                                "\" is no name of a member: expected up to 32 lower-case letters, "
                                "digits and hyphens, a letter first");
  if (!robot.empty())
    if (const std::string trouble = trouble_of_robot(robot); !trouble.empty())
      throw std::invalid_argument("--robot: " + trouble);
  std::vector<std::string> known_roles;
  for (const Role& role : roles_.roles)
    known_roles.push_back(role.name);
  for (const std::string& role : roles)
    if (roles_.find(role) == nullptr)
      throw std::invalid_argument("there is no role \"" + role + "\" in " + folder_ + "/" +
                                  kRolesFile + did_you_mean(role, known_roles));
  if (roles.empty())
    throw std::invalid_argument("a member needs a role: --role operator");
  Member member;
  if (const auto before = members_.find(name); before != members_.end()) {
    if (!before->second.revoked)
      throw std::invalid_argument(name + " is a member already: `saphira security renew " + name +
                                  "` makes new certificates, `revoke " + name + "` ends it");
    member.issue = before->second.issue + 1;
  }
  member.roles = roles;
  member.robot = robot;
  member.until = now + days * kDay;
  fs::remove_all(folder_of(name));  // roles that it had before
  issue(name, member, now);
  return folder_of(name);
}

std::string Authority::renew(const std::string& name, int days, std::int64_t now) {
  check_days(days);
  Member member = known(name);
  if (member.revoked)
    throw std::invalid_argument(name + " was revoked: `saphira security add " + name +
                                " --role ROLE` makes it a member again");
  ++member.issue;
  member.until = now + days * kDay;
  issue(name, member, now);
  return folder_of(name);
}

std::string Authority::revoke(const std::string& name) {
  Member& member = known(name);
  member.revoked = true;
  // Also those that were renewed, and may still be somewhere.
  for (unsigned issue = 1; issue <= member.issue; ++issue)
    revoked_.members.insert(common_name({name, issue, {}, {}}));
  ++revoked_.number;
  write(revoked_list(), sign(to_text(revoked_), key_pair(key_, certificate_)));
  save_members();
  const Private mode;
  write(folder_ + "/" + kSiteKey, site_keys_text({new_site_key(), site_keys().front()}));
  const std::string list = read_bytes(revoked_list());
  for (const auto& [other, its] : members_)
    if (fs::is_directory(folder_of(other)))
      write(folder_of(other) + "/" + kRevoked, list);
  return revoked_list();
}

/// The newest first. Since a revoked member knows the keys of before, a revocation makes a new one;
/// the one before holds until all members have the new one.
std::vector<std::string> Authority::site_keys() const {
  const std::string file = folder_ + "/" + kSiteKey;
  std::vector<std::string> keys;
  if (fs::exists(file))
    keys = checked(file, kRestore, [&] { return parse_site_keys(read_bytes(file)); });
  else  // of an earlier version
    keys = {new_site_key()};
  const bool all_have_it = std::all_of(members_.begin(), members_.end(), [&](const auto& one) {
    const std::string its = folder_of(one.first) + "/" + kSiteKey;
    return one.second.revoked ||
           (fs::exists(its) && read_bytes(its).starts_with(keys.front() + "\n"));
  });
  if (all_have_it)
    keys.resize(1);
  return keys;
}

void Authority::write_shared(const std::string& folder) const {
  const KeyPair pair = key_pair(key_, certificate_);
  write(folder + "/" + kAuthority, certificate_);
  write(folder + "/" + kRoles, sign(roles_.text, pair));
  write(folder + "/" + kGovernance, sign(governance(), pair));
  write(folder + "/" + kRevoked, read_bytes(revoked_list()));
  const std::string keys = site_keys_text(site_keys());
  write(folder_ + "/" + kSiteKey, keys);
  write(folder + "/" + kSiteKey, keys);
}

/// The number of a certificate is on record before the certificate is there: a revocation lists
/// those up to that number.
void Authority::issue(const std::string& name, const Member& member, std::int64_t now) {
  const Private mode;
  write(folder_ + "/" + kSiteKey, site_keys_text(site_keys()));  // as the members before need it
  members_[name] = member;
  save_members();
  const KeyPair authority = key_pair(key_, certificate_);
  const Validity validity{now - kEarlier, member.until};
  for (const std::string& role : member.roles) {
    const Subject subject{name, member.issue, role, site_};
    const std::string folder = folder_of(name) + "/" + role;
    make_folder(folder);
    const KeyPair pair = make_member(subject, validity, authority);
    write(folder + "/" + kKey, pair.key);
    write(folder + "/" + kCertificate, pair.certificate);
    write(folder + "/" + kPermissions,
          sign(permissions({subject, member.robot, validity.from, validity.until}, roles_),
               authority));
  }
  write_shared(folder_of(name));
}

}  // namespace saphira::security
