#pragma once

#include <atomic>
#include <cstdint>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <fastdds/rtps/common/GuidPrefix_t.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "saphira/base/boot_clock.hpp"
#include "saphira/bus/endpoint.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/security/credentials.hpp"
#include "saphira/security/seal.hpp"

namespace saphira::bus::internal {

/// The security of a node: its credentials, the identities of the others, and the programs that are
/// revoked.
class Guard {
 public:
  /// None for an open bus. std::invalid_argument where the credentials are unusable.
  static std::shared_ptr<Guard> make(const NodeOptions& options);

  Guard(std::string folder, security::Credentials credentials);

  void secure(eprosima::fastdds::dds::DomainParticipantQos& qos) const;

  /// The identity of a participant, by the subject that it announced at discovery. Empty where the
  /// site is another one or the prefix is not that subject's. Fast DDS 2.9 takes samples only where
  /// the certificate has the announced subject. Its handshake checks that the prefix is the
  /// certificate's, but does not compare that prefix with the prefix of the samples.
  std::shared_ptr<const Identity> identify(const eprosima::fastrtps::rtps::GuidPrefix_t& prefix,
                                           const std::string& announced) const;

  /// The reason why a program may not write or read a topic, in words; empty where it may.
  std::string why_not(const Identity& identity, const std::string& topic, bool writes) const;
  /// Throws where this program may not: Fast DDS would refuse it without a word.
  void check_own(const char* topic, bool writes) const;
  const Identity& own() const { return own_; }
  const std::string& site() const { return credentials_.subject.site; }

  /// Of the site, for announcements.
  const security::Seal& seal() const { return seal_; }
  bool seal_required() const { return credentials_.roles.seal_required; }

  /// The member whose revoked certificate a packet's sender has; empty: none. From any thread.
  std::string revoked(const std::uint8_t* prefix) const;

  /// Looks for a newer list of revoked certificates, at intervals.
  void look(const std::string& program);

  /// A warning in words where the certificate expires soon; empty otherwise.
  std::string expiry() const;

 private:
  void take(const security::Revoked& list);

  const std::string folder_;
  const security::Credentials credentials_;
  const Identity own_;
  const security::Seal seal_;
  BootClock::time_point looked_;
  std::string trouble_;
  std::uint64_t number_ = 0;
  mutable std::mutex mutex_;
  std::map<security::PrefixHead, std::string> revoked_;  ///< and their members
  std::atomic<bool> any_{false};
};

}  // namespace saphira::bus::internal
