// saphira-relay: access to a robot without a reachable address. README.md.
#include <sys/stat.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "relay.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/stop_signals.hpp"
#include "saphira/base/text.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/security/pair.hpp"

namespace {

using namespace saphira;

std::vector<relay::Robot> read_robots(const std::string& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  struct stat state {};
  if (!in || stat(file.c_str(), &state) != 0)
    throw std::invalid_argument(cannot_be(file, "read"));
  if ((state.st_mode & 077U) != 0)
    throw std::invalid_argument(file + ": others may read the robots' tokens; chmod 600 it");
  return relay::parse_robots(file, text.str());
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app("Lets robots without a reachable address be watched and driven from a browser");
  relay::RelayOptions options;
  std::string robots;
  app.add_option("--robots", robots, "file with a line for each robot: NAME PORT TOKEN")
      .required()
      .existing_file();
  app.add_option("--dial-port", options.place.port, "where the robots' consoles dial in")
      .required()
      .in_range(1, 65535);
  app.add_option("--listen", options.place.address,
                 "address to listen on; 0.0.0.0: every one of IPv4, :: of IPv6, too");
  const Option key = app.add_option("--certificate-key", options.place.certificate_key,
                                    "PEM file, of the certificate")
                         .existing_file();
  const Option certificate =
      app.add_option("--certificate", options.place.certificate,
                     "PEM file, of the dial port; without it robots of this machine alone dial in")
          .existing_file()
          .needs(key);
  key.needs(certificate);
  if (const auto code = app.parse(argc, argv))
    return *code;
  return exit_code_of("saphira-relay", [&] {
    if (certificate.given()) {
      const std::string trouble = security::check_pair(
          options.place.certificate, options.place.certificate_key, unix_seconds());
      if (!trouble.empty())
        std::fprintf(stderr, "saphira-relay: %s\n", trouble.c_str());
    }
    const int stop = stop_on_signals();
    relay::Relay server(options, read_robots(robots));
    relay::say("listens for robots on port " + std::to_string(options.place.port));
    server.run(stop);
    return kExitOk;
  });
}
