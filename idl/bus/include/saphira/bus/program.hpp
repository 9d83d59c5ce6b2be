#pragma once

#include <functional>
#include <string>

#include "saphira/bus/node.hpp"
#include "saphira/command_line/command_line.hpp"

namespace saphira::bus {

using enum Exit;

/// The text of --version: "saphira 0.1.0, contract 0f1e2d3c". Programs with another
/// contract (its types and topics, as a digest) do not understand each other.
const char* version();

/// The main() of a service: parses the options that every program has (--robot, --domain,
/// --profile, --peer, --interface, --lockstep, --name, --log-level; defaults from SAPHIRA_ROBOT,
/// SAPHIRA_DOMAIN, SAPHIRA_PROFILE, SAPHIRA_PEERS, SAPHIRA_INTERFACE) and those that `add_options`
/// adds, sets up logging and signals, runs `body`, and turns exceptions into a message and an exit
/// code. With --dry-run the stop is requested before `body` begins, whose nodes join nothing: it
/// reads what it was given, and ends.
int run_program(int argc, char** argv, const std::string& name, const std::string& description,
                const std::function<void(CommandLine&)>& add_options,
                const std::function<int(const NodeOptions&, const Stop&)>& body);

/// The profile of a word: host, lan or wan. std::out_of_range: it is no such word.
Profile profile_of(const std::string& word);

/// The options of a program without a command line, from the environment variables.
/// std::invalid_argument: one of them cannot be.
NodeOptions options_of_environment();

}  // namespace saphira::bus
