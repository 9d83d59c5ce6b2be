#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/bus/introspect.hpp"
#include "saphira/situation/situation.hpp"

namespace saphira::watch {

/// An option of the bus, and where its value is from, in words.
struct Setting {
  std::string value;
  std::string from;
};

/// A network interface that the bus may use.
struct NetworkInterface {
  std::string name;
  std::string address;
  bool multicast_returns = false;     ///< a packet to the group of discovery came back
  std::vector<std::string> others{};  ///< addresses whose packets to that group came
};

/// A peer of the profile wan.
struct PeerFact {
  std::string name;
  std::string address;  ///< empty: its name was not found
  bool silent = false;
};

/// The credentials of this user or machine.
struct CredentialsFact {
  std::string folder;   ///< empty: none, an open bus
  std::string trouble;  ///< the reason why they are unusable, in words
  std::string member;
  std::string role;
  std::string site;
  std::int64_t days = 0;  ///< until they expire
};

/// Another domain on this machine with programs.
struct OtherDomain {
  std::uint32_t domain = 0;
  std::string what;  ///< what runs there, in words; empty: unknown
};

/// The facts about the bus, as one program of this machine sees them.
struct BusFacts {
  Setting robot;
  Setting domain;
  bus::Profile profile = bus::Profile::host;
  std::string trouble;  ///< the reason why this program is not on the bus
  CredentialsFact credentials;
  std::vector<NetworkInterface> interfaces;  ///< that the bus uses, loopback first
  std::vector<std::string> waits;            ///< of Node::network_waits()
  std::vector<PeerFact> peers;
  std::string contract;  ///< of this program
  std::vector<bus::ProgramEntry> programs;
  std::vector<bus::OtherProgram> others;  ///< of other robots
  std::vector<bus::EndpointEntry> endpoints;
  std::vector<std::string> refused;  ///< of Node::take_refused()
  std::vector<situation::Program> statuses;
  std::vector<OtherDomain> domains;
};

enum class Verdict { ok, note, wrong };

/// The result of one check.
struct Finding {
  Verdict verdict = Verdict::ok;
  std::string code;    ///< such as multicast
  std::string is;      ///< what was found
  std::string remedy;  ///< empty where nothing is wrong
};

/// All checks, in the order in which a person goes through them.
std::vector<Finding> diagnose(const BusFacts& facts);
/// Why two programs do not talk, by their names; without `other`: the one with each other program.
std::vector<Finding> diagnose(const BusFacts& facts, const std::string& one,
                              const std::string& other);

/// In words, which of these programs have not let a member in, though they are of its site by name.
/// Empty: none. A handshake lasts a moment, so this counts where nobody is heard.
std::string why_kept_out(const std::vector<bus::ProgramEntry>& found, const std::string& member);

/// The domains with programs on this machine, from the text of /proc/net/udp.
std::vector<std::uint32_t> domains_in(std::string_view sockets);
/// The port of a domain at which programs announce themselves, on loopback or on a network.
std::uint16_t discovery_port(std::uint32_t domain, bool loopback);

}  // namespace saphira::watch
