#include "dds_guard.hpp"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <stdexcept>
#include <utility>

#include "log.hpp"
#include "saphira/security/documents.hpp"

namespace saphira::bus::internal {
namespace {

// Between two looks for a list of revoked certificates.
constexpr std::chrono::seconds kGuardLook{5};
constexpr std::int64_t kDay = 86400;
// The time before a certificate's end at which the end is told.
constexpr std::int64_t kSoon = 30;  // [days]

}  // namespace

std::shared_ptr<Guard> Guard::make(const NodeOptions& options) {
  if (options.security.empty() || options.security == kOpenBus)
    return nullptr;
  security::Credentials found = security::load_credentials(
      options.security, options.program.empty() ? options.name : options.program, unix_seconds());
  if (!found.robot.empty() && options.robot != found.robot)
    throw std::invalid_argument("the credentials of " + found.subject.name + " are for the robot " +
                                found.robot + " alone, not for \"" + options.robot +
                                "\": --robot " + found.robot);
  return std::make_shared<Guard>(options.security, std::move(found));
}

void check_credentials(const NodeOptions& options) {
  Guard::make(options);
}

void check_role(const NodeOptions& options, const char* topic, bool writes) {
  if (const auto guard = Guard::make(options))
    guard->check_own(topic, writes);
}

Guard::Guard(std::string folder, security::Credentials credentials)
    : folder_(std::move(folder)),
      credentials_(std::move(credentials)),
      own_{credentials_.subject.name, credentials_.subject.role},
      seal_(credentials_.site_keys),
      looked_(BootClock::now()) {
  security::only_authorities_sign();
  take(security::load_revoked(folder_, credentials_.authority));
}

void Guard::secure(eprosima::fastdds::dds::DomainParticipantQos& qos) const {
  auto& properties = qos.properties().properties();
  const auto add = [&](const char* name, const std::string& value) {
    properties.emplace_back(name, value);
  };
  const auto add_file = [&](const char* name, const std::string& file) {
    add(name, "file://" + file);
  };
  const security::CredentialFiles& files = credentials_.files;
  add("dds.sec.auth.plugin", "builtin.PKI-DH");
  add_file("dds.sec.auth.builtin.PKI-DH.identity_ca", files.authority);
  add_file("dds.sec.auth.builtin.PKI-DH.identity_certificate", files.certificate);
  add_file("dds.sec.auth.builtin.PKI-DH.private_key", files.key);
  add("dds.sec.access.plugin", "builtin.Access-Permissions");
  add_file("dds.sec.access.builtin.Access-Permissions.permissions_ca", files.authority);
  add_file("dds.sec.access.builtin.Access-Permissions.governance", files.governance);
  add_file("dds.sec.access.builtin.Access-Permissions.permissions", files.permissions);
  add("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
}

std::shared_ptr<const Identity> Guard::identify(
    const eprosima::fastrtps::rtps::GuidPrefix_t& prefix, const std::string& announced) const {
  const auto subject = security::parse_subject(announced);
  if (!subject || subject->site != credentials_.subject.site)
    return std::make_shared<Identity>();
  const security::PrefixHead head = security::prefix_head(*subject);
  if (!std::equal(head.begin(), head.end(), prefix.value))
    return std::make_shared<Identity>();
  return std::make_shared<Identity>(Identity{subject->name, subject->role});
}

std::string Guard::why_not(const Identity& identity, const std::string& topic, bool writes) const {
  const security::Roles& roles = credentials_.roles;
  if (writes ? roles.may_write(identity.role, topic) : roles.may_read(identity.role, topic))
    return {};
  return identity.text() + " may not " + (writes ? "write" : "read") + " the topic " + topic +
         ": that is for " + (writes ? roles.those_that_write(topic) : roles.those_that_read(topic));
}

void Guard::check_own(const char* topic, bool writes) const {
  if (const std::string why = why_not(own_, topic, writes); !why.empty())
    throw std::invalid_argument(why);
}

std::string Guard::revoked(const std::uint8_t* prefix) const {
  if (!any_)
    return {};
  security::PrefixHead head{};
  std::copy_n(prefix, head.size(), head.begin());
  const std::scoped_lock lock(mutex_);
  const auto found = revoked_.find(head);
  return found == revoked_.end() ? std::string() : found->second;
}

void Guard::take(const security::Revoked& list) {
  std::map<security::PrefixHead, std::string> heads;
  for (const std::string& member : list.members)
    for (const security::Role& role : credentials_.roles.roles)
      if (const auto subject = security::parse_subject("CN=" + member + ",OU=" + role.name +
                                                       ",O=" + credentials_.subject.site))
        heads.try_emplace(security::prefix_head(*subject), subject->name);
  number_ = list.number;
  const std::scoped_lock lock(mutex_);
  revoked_ = std::move(heads);
  any_ = !revoked_.empty();
}

void Guard::look(const std::string& program) {
  if (BootClock::now() - looked_ < kGuardLook)
    return;
  looked_ = BootClock::now();
  std::string trouble;
  try {
    const security::Revoked list = security::load_revoked(folder_, credentials_.authority);
    if (list.number > number_) {
      take(list);
      write_log(v1::LOG_WARNING, program,
                "takes list " + std::to_string(list.number) + " of revoked members");
      if (list.members.contains(security::common_name(credentials_.subject))) {
        write_log(v1::LOG_ERROR, program,
                  "the certificate of " + own_.text() + " was revoked; this program ends");
        ::kill(::getpid(), SIGTERM);
      }
    }
  } catch (const std::exception& error) {
    trouble = error.what();
  }
  if (!trouble.empty() && trouble != trouble_)
    write_log(
        v1::LOG_ERROR, program,
        "the list of revoked members cannot be read; the previous one stays in force: " + trouble);
  trouble_ = trouble;
}

std::string Guard::expiry() const {
  const std::int64_t days = (credentials_.until - unix_seconds()) / kDay;
  if (days >= kSoon)
    return {};
  if (credentials_.until <= unix_seconds())
    return "the certificate of " + own_.text() +
           " has expired: it cannot start again before saphira security renew " + own_.name;
  return "the certificate of " + own_.text() + " expires in " + std::to_string(days) +
         " days: saphira security renew " + own_.name;
}

}  // namespace saphira::bus::internal
