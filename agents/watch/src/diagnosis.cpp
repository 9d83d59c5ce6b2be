#include "saphira/watch/diagnosis.hpp"

#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>

#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/subject.hpp"
#include "saphira/situation/words.hpp"
#include "saphira/watch/processes.hpp"

namespace saphira::watch {
namespace {

using situation::listed;

constexpr std::int64_t kExpiresSoon = 30;  // [days] a certificate that expires
constexpr double kExchanged = 3.0;         // [s] by then the endpoints of a program are known
constexpr double kHandshake = 5.0;         // [s] by then a member is let in
constexpr std::size_t kMostTopics = 6;     // that are named
constexpr std::size_t kMostPrograms = 3;   // likewise
constexpr const char* kNoProof = "of another authority, expired, revoked, or a wrong clock";
// idl/bus/README.md, Network.
constexpr std::uint32_t kFirstPort = 7400;
constexpr std::uint32_t kLoopbackPorts = 125;
constexpr std::uint32_t kPortsPerDomain = 250;
constexpr std::uint32_t kMaxDomain = 231;

Finding ok(std::string code, std::string is) {
  return {Verdict::ok, std::move(code), std::move(is), {}};
}
Finding note(std::string code, std::string is, std::string remedy = {}) {
  return {Verdict::note, std::move(code), std::move(is), std::move(remedy)};
}
Finding wrong(std::string code, std::string is, std::string remedy) {
  return {Verdict::wrong, std::move(code), std::move(is), std::move(remedy)};
}

std::string title(const bus::ProgramEntry& program) {
  return program.name + (program.pid == 0 ? "" : "[" + std::to_string(program.pid) + "]") +
         (program.host.empty() ? "" : " at " + program.host);
}

bool is_of(const bus::EndpointEntry& endpoint, const bus::ProgramEntry& program) {
  return endpoint.program == program.name && endpoint.host == program.host &&
         endpoint.pid == program.pid;
}

std::string ports(const BusFacts& facts) {
  std::uint32_t domain = 0;
  std::from_chars(facts.domain.value.data(), facts.domain.value.data() + facts.domain.value.size(),
                  domain);
  const std::uint32_t first = discovery_port(domain, false);
  return "UDP ports " + std::to_string(first) + " and " + std::to_string(first + 10) + " to " +
         std::to_string(first + 49);
}

Finding of_credentials(const BusFacts& facts) {
  const CredentialsFact& own = facts.credentials;
  if (!own.trouble.empty())
    return wrong("credentials", own.trouble,
                 "saphira security check names each fault; docs/security.md");
  if (own.folder.empty())
    return ok("credentials", "none: this side is open to all");
  const std::string whose = own.member + " (" + own.role + ") of the site " + own.site + ", " +
                            std::to_string(own.days) + " days left (" + own.folder + ")";
  return own.days >= kExpiresSoon
             ? ok("credentials", whose)
             : note("credentials", whose, "saphira security renew " + own.member);
}

void add_network(const BusFacts& facts, std::vector<Finding>& all) {
  for (const std::string& wait : facts.waits)
    all.push_back(wrong("address", wait,
                        "ip addr shows this machine's; --interface ADDRESS names one of them"));
  for (const NetworkInterface& each : facts.interfaces) {
    const std::string where = each.name + " (" + each.address + ")";
    const bool loopback = each.address.starts_with("127.");
    if (!each.multicast_returns && (loopback || facts.profile == bus::Profile::lan))
      all.push_back(
          wrong("multicast", where + ": a packet to the group of discovery does not come back",
                loopback ? "this machine's programs do not find each other: a firewall has to "
                           "let UDP through on loopback"
                         : "a firewall here drops it, or the interface has no multicast: let " +
                               ports(facts) + " in, or use profile wan on both sides"));
    else if (loopback)
      all.push_back(ok("loopback", where + ": programs of this machine can find each other"));
    else if (facts.profile == bus::Profile::wan)
      all.push_back(ok("interface", where));
    else if (each.others.empty())
      all.push_back(
          note("multicast", where + ": works here; no announcement of another machine came",
               "where one is on, the network drops multicast (much WiFi), or its firewall "
               "does: profile wan on both sides, and one side's address (--peer)"));
    else
      all.push_back(
          ok("multicast", where + ": works; announcements came of " + listed(each.others)));
  }
  for (const PeerFact& peer : facts.peers) {
    const std::string name =
        peer.name +
        (peer.address.empty() || peer.address == peer.name ? "" : " (" + peer.address + ")");
    if (peer.address.empty())
      all.push_back(wrong("peer", name + ": no host of this name was found",
                          "give its address, or put the name in /etc/hosts"));
    else if (peer.silent)
      all.push_back(wrong("peer", name + ": nothing was heard of it",
                          "is it on (ping), do its programs run with profile wan and domain " +
                              facts.domain.value + ", and do both firewalls let " + ports(facts) +
                              " in?"));
    else
      all.push_back(ok("peer", name + ": is heard"));
  }
}

std::string described(const bus::ProgramEntry& program) {
  return title(program) + ": robot " + (program.robot.empty() ? "not said" : program.robot) + ", " +
         (program.subject.empty() ? "open" : program.subject) +
         (program.contract.empty() ? "" : ", contract " + program.contract);
}

Finding of_program(const BusFacts& facts, const bus::ProgramEntry& program) {
  const bool secured = !facts.credentials.folder.empty();
  const std::string is = described(program);
  if (!secured && !program.subject.empty())
    return wrong("secured", is + "; it is secured, and this side is open",
                 "this side needs credentials of its site: saphira security add, on the machine of "
                 "the site's authority (docs/security.md)");
  if (secured && program.subject.empty() && !program.let_in)
    return wrong("open", is + "; this side is secured, and it has no credentials",
                 "give it credentials of the site " + facts.credentials.site +
                     ", or leave security out on both sides (--security none)");
  if (!program.let_in && program.known >= kHandshake)
    return wrong(
        "not-let-in",
        is + "; it has not proved that it is a member of the site " + facts.credentials.site,
        std::string("saphira security check on both sides: credentials ") + kNoProof);
  if (!program.contract.empty() && program.contract != facts.contract)
    return wrong("contract", is + "; this side has the contract " + facts.contract,
                 "install one version on both sides (saphira --version)");
  if (program.endpoints == 0 && program.known >= kExchanged)
    return wrong(
        "one-way", is + "; its announcements come, and no answer to ours",
        "packets get through in one direction only: let " + ports(facts) + " in on both machines");
  if (program.silent)
    return wrong("silent", is + "; it is not heard any more",
                 "it hangs, was killed, or is cut off: saphira status");
  return program.pid == 0 ? note("program", is + "; of another DDS") : ok("program", is);
}

std::string what_of(const OtherDomain& other) {
  return "domain " + std::to_string(other.domain) +
         (other.what.empty() ? "" : " (" + other.what + ")");
}

void add_others(const BusFacts& facts, std::vector<Finding>& all) {
  std::map<std::string, std::vector<std::string>> robots;
  for (const bus::OtherProgram& other : facts.others)
    robots[other.robot].push_back(other.name);
  // The commands of other people are no program that somebody looks for.
  const bool alone = std::ranges::none_of(
      facts.programs, [](const bus::ProgramEntry& program) { return program.name != "cli"; });
  std::vector<std::string> elsewhere;
  for (const auto& [robot, names] : robots)
    elsewhere.push_back("--robot " + robot);
  for (const OtherDomain& other : facts.domains)
    elsewhere.push_back("--domain " + std::to_string(other.domain));
  if (alone)
    all.push_back(wrong(
        "nobody",
        "no program of robot " + facts.robot.value + " is heard in domain " + facts.domain.value,
        elsewhere.empty() ? "is it up (saphira up office), with this robot, domain and profile?"
                          : "it may be another one's: " + listed(elsewhere, " or ")));
  for (const auto& [robot, names] : robots)
    all.push_back(note("other-robot", "robot " + robot + " is in this domain: " + listed(names),
                       "programs of different robots do not exchange anything; --robot " + robot));
  for (const OtherDomain& other : facts.domains)
    all.push_back(note(
        "other-domain", what_of(other) + " has programs on this machine",
        "programs of different domains do not meet; --domain " + std::to_string(other.domain)));
}

/// Why the samples of a writer do not reach a reader of its topic; empty: they do.
std::string why_apart(const bus::EndpointEntry& writer, const bus::EndpointEntry& reader) {
  if (!writer.denied.empty() || !reader.denied.empty())
    return writer.denied.empty() ? reader.denied : writer.denied;
  return bus::why_incompatible(writer, reader);
}

std::string remedy_of(const std::string& why) {
  if (why.find(" may not ") != std::string::npos)
    return "a role of the site that may (config/security/roles.yaml), or other credentials";
  return why.starts_with("reliability") || why.starts_with("durability")
             ? "run both programs with --lockstep, or neither"
             : "are both programs of one version?";
}

void add_pair(const BusFacts& facts, const bus::ProgramEntry& one, const bus::ProgramEntry& other,
              std::vector<Finding>& all) {
  std::set<std::string> good;
  const std::size_t before = all.size();
  const std::string names = title(one) + " and " + title(other);
  if (!one.robot.empty() && !other.robot.empty() && one.robot != other.robot && one.robot != "*" &&
      other.robot != "*") {
    all.push_back(wrong("robots", names + " are of the robots " + one.robot + " and " + other.robot,
                        "give both one --robot"));
    return;
  }
  for (const bus::EndpointEntry& writer : facts.endpoints)
    for (const bus::EndpointEntry& reader : facts.endpoints) {
      if (!writer.writer || reader.writer || writer.topic != reader.topic ||
          writer.topic == bus::topics::kPresence.name)
        continue;
      const bool there = is_of(writer, one) && is_of(reader, other);
      if (!there && !(is_of(writer, other) && is_of(reader, one)))
        continue;
      const std::string why = why_apart(writer, reader);
      if (why.empty())
        good.insert((there ? "-> " : "<- ") + writer.topic);
      else
        all.push_back(wrong("topic",
                            writer.topic + " of " + writer.program + " does not reach " +
                                reader.program + ": " + why,
                            remedy_of(why)));
    }
  std::vector<std::string> some(good.begin(), good.end());
  if (some.size() > kMostTopics) {
    const std::size_t more = some.size() - kMostTopics;
    some.resize(kMostTopics);
    some.push_back(std::to_string(more) + " more");
  }
  if (!some.empty())
    all.push_back(ok("pair", names + ": " + joined(some, ", ")));
  else if (all.size() == before)
    all.push_back(note("pair", names + ": neither reads what the other writes"));
}

}  // namespace

std::vector<Finding> diagnose(const BusFacts& facts) {
  std::vector<Finding> all;
  all.push_back(ok("robot", facts.robot.value + " (" + facts.robot.from + ")"));
  all.push_back(ok("domain", facts.domain.value + " (" + facts.domain.from + ")"));
  all.push_back(
      ok("profile", std::string(name_of(facts.profile)) +
                        (facts.profile == bus::Profile::host
                             ? ": this machine alone; others need lan or wan on both sides"
                             : "")));
  all.push_back(of_credentials(facts));
  add_network(facts, all);
  if (!facts.trouble.empty()) {
    all.push_back(
        wrong("bus", facts.trouble, "no program of this user gets on the bus before that"));
    return all;
  }
  for (const bus::ProgramEntry& program : facts.programs)
    all.push_back(of_program(facts, program));
  for (const std::string& refused : facts.refused)
    all.push_back(wrong("refused", refused, "docs/security.md"));
  for (const situation::Program& program : facts.statuses)
    if (program.status.incompatible > 0)
      all.push_back(wrong("reported",
                          program.status.name + " at " + program.status.host + " found " +
                              std::to_string(program.status.incompatible) +
                              " endpoints or programs that do not fit",
                          "saphira log -n 200 names them; saphira doctor " + program.status.name));
  for (const bus::ProgramEntry& one : facts.programs)
    for (const bus::ProgramEntry& other : facts.programs) {
      std::vector<Finding> pair;
      if (&one < &other)
        add_pair(facts, one, other, pair);
      std::ranges::copy_if(pair, std::back_inserter(all),
                           [](const Finding& each) { return each.code == "topic"; });
    }
  if (std::string apart = situation::clocks_apart(facts.statuses); !apart.empty())
    all.push_back(
        wrong("clock", apart.substr(7, apart.size() - 8), "a time server (NTP) on both sides"));
  add_others(facts, all);
  return all;
}

std::vector<Finding> diagnose(const BusFacts& facts, const std::string& one,
                              const std::string& other) {
  std::vector<Finding> all;
  std::vector<std::string> names;
  for (const bus::ProgramEntry& program : facts.programs)
    names.push_back(program.name);
  for (const std::string& wanted : {one, other})
    if (!wanted.empty() && std::ranges::find(names, wanted) == names.end()) {
      const auto elsewhere = std::ranges::find(facts.others, wanted, &bus::OtherProgram::name);
      all.push_back(wrong(
          "absent",
          "no program " + wanted + " of robot " + facts.robot.value + " is heard" +
              did_you_mean(wanted, names),
          elsewhere != facts.others.end()
              ? "one of robot " + elsewhere->robot + " is: give both one --robot"
              : "does it run? Without a name, saphira doctor checks the way to other programs"));
    }
  if (!all.empty())
    return all;
  for (const bus::ProgramEntry& program : facts.programs)
    if (program.name == one || program.name == other)
      all.push_back(of_program(facts, program));
  for (const bus::ProgramEntry& first : facts.programs)
    for (const bus::ProgramEntry& second : facts.programs)
      if (first.name == one && &first != &second &&
          (other.empty() ? second.name != "cli" : second.name == other))
        add_pair(facts, first, second, all);
  return all;
}

std::string why_kept_out(const std::vector<bus::ProgramEntry>& found, const std::string& member) {
  std::string site;
  std::vector<std::string> names;
  for (const bus::ProgramEntry& program : found)
    if (const auto subject = security::parse_subject(program.subject);
        subject && !program.let_in && std::ranges::find(names, program.name) == names.end()) {
      site = subject->site;
      names.push_back(program.name);
    }
  if (names.empty())
    return {};
  std::ranges::sort(names);
  if (names.size() > kMostPrograms) {
    const std::size_t more = names.size() - kMostPrograms;
    names.resize(kMostPrograms);
    names.push_back(std::to_string(more) + " more");
  }
  return listed(names) + " of the site " + site + (names.size() == 1 ? " has" : " have") +
         " not let " + member + " in: credentials " + kNoProof +
         ": saphira security check on both sides, saphira doctor";
}

std::vector<std::uint32_t> domains_in(std::string_view sockets) {
  std::set<std::uint32_t> found;
  std::istringstream lines{std::string(sockets)};
  for (std::string line; std::getline(lines, line);) {
    // "  12: 0100007F:1D65 00000000:0000 ...": the local port is hexadecimal.
    const std::size_t number = line.find(':');
    const std::size_t port = line.find(':', number == std::string::npos ? number : number + 1);
    if (port == std::string::npos || port + 5 > line.size())
      continue;
    std::uint32_t value = 0;
    std::from_chars(line.data() + port + 1, line.data() + port + 5, value, 16);
    const std::uint32_t first = kFirstPort + kLoopbackPorts;
    if (value >= first && (value - first) % kPortsPerDomain == 0 &&
        (value - first) / kPortsPerDomain <= kMaxDomain)
      found.insert((value - first) / kPortsPerDomain);
  }
  return {found.begin(), found.end()};
}

std::uint16_t discovery_port(std::uint32_t domain, bool loopback) {
  return static_cast<std::uint16_t>(kFirstPort + kPortsPerDomain * domain +
                                    (loopback ? kLoopbackPorts : 0));
}

}  // namespace saphira::watch
