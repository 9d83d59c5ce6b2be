#include "dds_discovery.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "dds_convert.hpp"
#include "fleet.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/printable.hpp"

namespace saphira::bus::internal {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using Clock = std::chrono::steady_clock;

namespace {

// After this time a mismatch is told by its policy alone. The endpoint is usually known sooner.
constexpr std::chrono::seconds kUnexplained{2};
// After this time a program that is not let in is told.
constexpr std::chrono::seconds kSlowHandshake{5};
// Maximum number of logged mistakes. A larger number is forged.
constexpr std::size_t kMostProgramsTold = 1000;
// The same for programs that are not let in: anybody can announce them.
constexpr int kMostRefusedTold = 20;

const char* policy_name(fdds::QosPolicyId_t id) {
  static constexpr std::pair<fdds::QosPolicyId_t, const char*> kNames[]{
      {fdds::DURABILITY_QOS_POLICY_ID, "durability"},
      {fdds::PRESENTATION_QOS_POLICY_ID, "presentation"},
      {fdds::DEADLINE_QOS_POLICY_ID, "deadline"},
      {fdds::LATENCYBUDGET_QOS_POLICY_ID, "latency budget"},
      {fdds::OWNERSHIP_QOS_POLICY_ID, "ownership"},
      {fdds::LIVELINESS_QOS_POLICY_ID, "liveliness"},
      {fdds::RELIABILITY_QOS_POLICY_ID, "reliability"},
      {fdds::DESTINATIONORDER_QOS_POLICY_ID, "destination order"},
      {fdds::DATAREPRESENTATION_QOS_POLICY_ID, "data representation"},
      {fdds::TYPECONSISTENCYENFORCEMENT_QOS_POLICY_ID, "type consistency"}};
  for (const auto& [policy, name] : kNames)
    if (policy == id)
      return name;
  return "another policy";
}

std::string announced_subject(const rtps::IdentityToken& token) {
  for (const auto& property : token.properties())
    if (property.name() == "dds.cert.sn")
      return property.value();
  return {};
}

std::string to_text(const rtps::GuidPrefix_t& prefix) {
  return {reinterpret_cast<const char*>(prefix.value), sizeof prefix.value};
}

Peers::Program program_of(const rtps::GuidPrefix_t& prefix) {
  Peers::Program program{};
  static_assert(sizeof prefix.value == std::tuple_size_v<Peers::Program>);
  std::copy(std::begin(prefix.value), std::end(prefix.value), program.begin());
  return program;
}

std::string owner(const EndpointEntry& endpoint) {
  return (endpoint.program.empty() ? "an unknown program" : endpoint.program) +
         (endpoint.host.empty() ? "" : " at " + endpoint.host);
}

/// An endpoint by its program and host, for people.
std::string name(const EndpointEntry& endpoint) {
  return std::string(endpoint.writer ? "the writer of " : "the reader of ") + owner(endpoint);
}

}  // namespace

Discovery::~Discovery() {
  for (const auto& [prefix, program] : programs_)
    if (program.pid != 0)
      peers_.leave(program_of(prefix));
}

template <class Proxy>
void Discovery::put(const Proxy& proxy, bool writer, bool removed) {
  const std::scoped_lock lock(mutex_);
  if (removed) {
    endpoints_.erase(proxy.guid());
  } else {
    EndpointEntry endpoint;
    endpoint.topic = printable(proxy.topicName().to_string());
    endpoint.type = printable(proxy.typeName().to_string());
    endpoint.writer = writer;
    for (const auto& partition : proxy.m_qos.m_partition.names())
      endpoint.robot += (endpoint.robot.empty() ? "" : ",") + partition;
    endpoint.reliable = proxy.m_qos.m_reliability.kind == fdds::RELIABLE_RELIABILITY_QOS;
    static constexpr const char* durability[] = {"volatile", "transient_local", "transient",
                                                 "persistent"};
    endpoint.durability = durability[proxy.m_qos.m_durability.kind & 3U];
    endpoint.deadline = seconds(proxy.m_qos.m_deadline.period);
    static constexpr const char* liveliness[] = {"automatic", "manual_by_participant",
                                                 "manual_by_topic", "automatic"};
    endpoint.liveliness = liveliness[proxy.m_qos.m_liveliness.kind & 3U];
    if (const double lease = seconds(proxy.m_qos.m_liveliness.lease_duration); lease > 0.0) {
      std::ostringstream text;
      text << " " << lease << " s";
      endpoint.liveliness += text.str();
    }
    endpoint.ownership =
        proxy.m_qos.m_ownership.kind == fdds::EXCLUSIVE_OWNERSHIP_QOS ? "exclusive" : "shared";
    endpoint.id = hex_text(to_id(proxy.guid()));
    endpoint.denied = why_denied(proxy.guid(), endpoint);
    endpoints_[proxy.guid()] = endpoint;
    tell_forbidden(proxy.guid(), endpoint);
    for (const auto& own : own_)
      if (own.topic == endpoint.topic && own.type != endpoint.type) {
        type_check_due_ = true;
        wake_->signal();
      }
    if (!incompatible_.empty())
      wake_->signal();
  }
  changed();
}

void Discovery::on_participant_discovery(fdds::DomainParticipant* /*participant*/,
                                         rtps::ParticipantDiscoveryInfo&& info) {
  using Info = rtps::ParticipantDiscoveryInfo;
  const std::scoped_lock lock(mutex_);
  const auto& prefix = info.info.m_guid.guidPrefix;
  Program& program = programs_[prefix];
  if (info.status == Info::REMOVED_PARTICIPANT || info.status == Info::DROPPED_PARTICIPANT) {
    if (entrance_)
      entrance_->forget(Entrance::prefix_at(prefix.value), BootClock::now());
    // Fast DDS may report that a program was found again before it reports that it was dropped.
    if (--program.discovered <= 0) {
      if (machines_)
        machines_->forget(to_text(prefix));
      if (program.pid != 0)
        peers_.leave(program_of(prefix));
      programs_.erase(prefix);
      std::erase_if(endpoints_, [&](const auto& item) { return item.first.guidPrefix == prefix; });
    }
  } else {
    if (info.status == Info::DISCOVERED_PARTICIPANT) {
      ++program.discovered;
      if (entrance_)
        entrance_->found(Entrance::prefix_at(prefix.value));
      // Later announcements do not count: the handshake checked the certificate with the first one.
      const std::string subject = announced_subject(info.info.identity_token_);
      program.subject = printable(subject);
      if (guard_)
        program.identity = guard_->identify(prefix, subject);
      if (const auto member = security::parse_subject(subject);
          member && (!guard_ || member->site != guard_->site()))
        other_site_ = member->site;
    }
    program.name = printable(info.info.m_participantName.to_string());
    const auto& bytes = info.info.m_userData.data_vec();
    const std::string data = printable({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    program.host = field(data, "host");
    program.robot = field(data, "robot");
    program.contract = field(data, "contract");
    tell_contract(program);
    program.program = field(data, "program");
    if (machines_)
      machines_->tell(to_text(prefix), field(data, "hears"));
    const bool joins = program.pid == 0;
    const std::string pid = field(data, "pid");
    std::from_chars(pid.data(), pid.data() + pid.size(), program.pid);
    if (joins && program.pid != 0)
      peers_.join(program_of(prefix));
    count_programs_here();
  }
  changed();
}

void Discovery::onParticipantAuthentication(fdds::DomainParticipant* /*participant*/,
                                            rtps::ParticipantAuthenticationInfo&& info) {
  const auto prefix = Entrance::prefix_at(info.guid.guidPrefix.value);
  if (info.status == rtps::ParticipantAuthenticationInfo::AUTHORIZED_PARTICIPANT) {
    entrance_->let_in(prefix);
    return;
  }
  entrance_->refuse(prefix);
  const std::scoped_lock lock(mutex_);
  const auto found = programs_.find(info.guid.guidPrefix);
  if (found == programs_.end())
    return;
  tell_refused(found->first, found->second);
  wake_->signal();
}

void Discovery::tell_refused(const rtps::GuidPrefix_t& prefix, const Program& program) {
  if (refused_told_ >= kMostRefusedTold ||
      !told_.insert({"refused", program.name + " " + program.host + " " + program.subject}).second)
    return;
  ++refused_told_;
  refusals_.texts.push_back(
      "a program at the address " + entrance_->address_of(Entrance::prefix_at(prefix.value)) +
      " is not let in that calls itself " + program.name +
      (program.host.empty() ? "" : " at " + program.host) +
      (program.subject.empty() ? "" : " and announces " + program.subject) +
      ": it has not proved that it is a member of this site, or its permissions are not signed by "
      "the site's authority");
}

std::string Discovery::bar() const {
  const std::scoped_lock lock(mutex_);
  if (other_site_.empty())
    return {};
  const std::string text = "its programs are of the site " + other_site_;
  if (guard_)
    return text + ", and the credentials of " + guard_->own().name + " are of " + guard_->site();
  return text +
         ", and this one has no credentials of it: on the machine of the site's authority, "
         "`saphira security add NAME --role operator` makes them; copy that folder to "
         "~/.config/saphira/credentials";
}

std::shared_ptr<const Identity> Discovery::identity_of(const rtps::GUID_t& writer) const {
  if (!guard_)
    return nullptr;
  static const auto stranger = std::make_shared<const Identity>();
  const std::scoped_lock lock(mutex_);
  const auto found = programs_.find(writer.guidPrefix);
  return found == programs_.end() || !found->second.identity ? stranger : found->second.identity;
}

// Their topics have the same names, and perhaps types of the same names.
void Discovery::tell_contract(const Program& program) {
  if (program.contract.empty() || program.contract == SAPHIRA_CONTRACT ||
      told_.size() >= kMostProgramsTold ||
      !told_.insert({"contract", program.name + " " + program.host}).second)
    return;
  troubles_.push_back(program.name + " at " + program.host + " has the contract " +
                      program.contract +
                      ", and this program " SAPHIRA_CONTRACT
                      ": they do not understand each other; both sides need one version");
  wake_->signal();
}

std::string Discovery::why_denied(const rtps::GUID_t& guid, const EndpointEntry& endpoint) const {
  const auto program = programs_.find(guid.guidPrefix);
  if (!guard_ || program == programs_.end() || !program->second.identity)
    return {};
  const Identity& identity = *program->second.identity;
  std::string why = guard_->why_not(identity, endpoint.topic, endpoint.writer);
  const std::string robot = entrance_->robot_of(Entrance::prefix_at(guid.guidPrefix.value));
  if (why.empty() && !robot.empty() && endpoint.robot != robot)
    why = identity.text() + " may not have it of " + endpoint.robot +
          ": its permissions are for the robot " + robot + " alone";
  return why;
}

// Fast DDS refuses the match, without naming the endpoint or the reason.
void Discovery::tell_forbidden(const rtps::GUID_t& guid, const EndpointEntry& endpoint) {
  const bool ours = std::any_of(own_.begin(), own_.end(), [&](const EndpointEntry& own) {
    return own.topic == endpoint.topic && own.writer != endpoint.writer;
  });
  if (endpoint.denied.empty() || !ours || told_.size() >= kMostProgramsTold ||
      !told_.insert({"forbidden", endpoint.denied}).second)
    return;
  refusals_.texts.push_back("topic " + endpoint.topic + ": " + name(with_program(guid, endpoint)) +
                            " is refused: " + endpoint.denied);
  wake_->signal();
}

void Discovery::count_programs_here() {
  const auto here = static_cast<std::size_t>(
      std::count_if(programs_.begin(), programs_.end(),
                    [](const auto& item) { return item.second.host == host_name(); }));
  if (most_here_ == 0 || here < most_here_ || !told_.insert({"programs", "here"}).second)
    return;
  troubles_.push_back("other machines look for " + std::to_string(most_here_) +
                      " programs on this one, and there are " + std::to_string(here + 1) +
                      ": some are not found unless this machine's --peer names the others");
  wake_->signal();
}

void Discovery::on_subscriber_discovery(fdds::DomainParticipant* /*participant*/,
                                        rtps::ReaderDiscoveryInfo&& info) {
  put(info.info, false, info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER);
}

void Discovery::on_publisher_discovery(fdds::DomainParticipant* /*participant*/,
                                       rtps::WriterDiscoveryInfo&& info) {
  put(info.info, true, info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER);
}

void Discovery::add_incompatible(const std::string& topic, bool own_writes,
                                 fdds::QosPolicyId_t policy) {
  const std::scoped_lock lock(mutex_);
  incompatible_.try_emplace({topic, own_writes, policy_name(policy)}, Clock::now());
  wake_->signal();
}

void Discovery::add_malformed(const std::string& topic, const rtps::GUID_t& writer) {
  const std::scoped_lock lock(mutex_);
  ++refusals_.samples;
  if (told_.size() >= kMostProgramsTold ||
      !told_.insert({"malformed " + topic, hex_text(to_id(writer))}).second)
    return;
  EndpointEntry from;
  from.writer = true;
  refusals_.texts.push_back("topic " + topic + ": refused a malformed sample of " +
                            name(with_program(writer, from)) +
                            "; further ones are only counted (refused_samples)");
  wake_->signal();
}

Refusals Discovery::take_refusals() {
  const std::scoped_lock lock(mutex_);
  // Fast DDS does not report that it has refused a program's permissions.
  if (entrance_) {
    const std::vector<std::string> strangers = entrance_->take_new_strangers();
    refusals_.texts.insert(refusals_.texts.end(), strangers.begin(), strangers.end());
    for (const auto& [prefix, program] : programs_)
      if (Clock::now() - program.found > kSlowHandshake &&
          !entrance_->is_in(Entrance::prefix_at(prefix.value)))
        tell_refused(prefix, program);
  }
  return std::exchange(refusals_, {});
}

void Discovery::add_own(const EndpointEntry& own) {
  const std::scoped_lock lock(mutex_);
  own_.push_back(own);
  type_check_due_ = true;
}

void Discovery::remove_own(const std::string& id) {
  const std::scoped_lock lock(mutex_);
  std::erase_if(own_, [&](const EndpointEntry& own) { return own.id == id; });
}

std::vector<EndpointEntry> Discovery::endpoints() const {
  const std::scoped_lock lock(mutex_);
  std::vector<EndpointEntry> result;
  result.reserve(endpoints_.size());
  for (const auto& [guid, endpoint] : endpoints_)
    if (!peers_.absent(Peers::program_of(to_id(guid))))
      result.push_back(with_program(guid, endpoint));
  return result;
}

std::vector<ProgramEntry> Discovery::programs() const {
  const std::scoped_lock lock(mutex_);
  std::vector<ProgramEntry> result;
  for (const auto& [prefix, program] : programs_) {
    const auto of_it = [&prefix = prefix](const auto& item) {
      return item.first.guidPrefix == prefix;
    };
    const Peers::Program id = program_of(prefix);
    result.push_back({.id = id,
                      .name = program.name,
                      .program = program.program,
                      .host = program.host,
                      .pid = program.pid,
                      .robot = program.robot,
                      .contract = program.contract,
                      .subject = program.subject,
                      .let_in = !entrance_ || entrance_->is_in(Entrance::prefix_at(prefix.value)),
                      .refused = entrance_ && entrance_->is_refused(id),
                      .silent = peers_.absent(id),
                      .known = std::chrono::duration<double>(Clock::now() - program.found).count(),
                      .endpoints = static_cast<std::size_t>(
                          std::count_if(endpoints_.begin(), endpoints_.end(), of_it))});
  }
  return result;
}

std::vector<std::string> Discovery::take_troubles() {
  const std::scoped_lock lock(mutex_);
  std::vector<std::string> texts = std::exchange(troubles_, {});
  std::erase_if(incompatible_, [&](const auto& item) {
    return tell_incompatible(item.first, Clock::now() - item.second > kUnexplained, texts);
  });
  // Fast DDS says nothing where only the names of the types differ.
  if (std::exchange(type_check_due_, false)) {
    for (const auto& own : own_)
      for (const auto& [guid, other] : endpoints_)
        if (other.writer != own.writer && other.topic == own.topic && other.type != own.type &&
            partitions_meet(other.robot, own.robot) && told_.insert({own.id, other.id}).second)
          texts.push_back("topic " + own.topic + ": " + name(with_program(guid, other)) +
                          " has type " + other.type + ", expected " + own.type);
  }
  return texts;
}

EndpointEntry Discovery::with_program(const rtps::GUID_t& guid, EndpointEntry endpoint) const {
  if (const auto found = programs_.find(guid.guidPrefix); found != programs_.end()) {
    endpoint.program = found->second.name;
    endpoint.host = found->second.host;
    endpoint.pid = found->second.pid;
  }
  return endpoint;
}

bool Discovery::tell_incompatible(const Incompatible& found, bool late,
                                  std::vector<std::string>& texts) {
  bool explained = false;
  for (const auto& own : own_) {
    if (own.topic != found.topic || own.writer != found.own_writes)
      continue;
    for (const auto& [guid, other] : endpoints_) {
      const auto text = mismatch_text(own, other, owner(with_program(guid, other)));
      explained = explained || text;
      if (text && !text->empty() && told_.insert({own.id, other.id}).second)
        texts.push_back(*text);
    }
  }
  if (!explained && late &&
      told_.insert({found.topic + (found.own_writes ? " out" : " in"), found.policy}).second)
    texts.push_back("topic " + found.topic + ": " + (found.own_writes ? "a reader" : "a writer") +
                    " of a program that ended at once did not match, " + found.policy +
                    "; while it runs, saphira list names it");
  return explained || late;
}

void Discovery::changed() {
  if (watched_)
    wake_->signal();
}

}  // namespace saphira::bus::internal
