// Shows a running robot in Foxglove, Lichtblick and others of their protocol. README.md.
#include <cstdio>
#include <optional>
#include <string>

#include "foxglove_server.hpp"
#include "key.hpp"
#include "live.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/bus/audit.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/console/access.hpp"

namespace {

using namespace saphira;

int serve(const bus::NodeOptions& node_options, viewer::Server::Options options,
          const std::string& key_file, const bus::Stop& stop) {
  const console::AccessSettings access{console::keep(key_file).key, {}, 0, true};
  security::DoorKeysFile persons;
  const auto visitor_of = [&](const std::string& key) {
    return console::visitor_of(access, persons.keys(), key, unix_seconds());
  };
  options.admits = [&](const std::string& key) {
    return visitor_of(key).may(security::DoorRight::watch);
  };
  options.name = "saphira: robot " + node_options.robot;
  bus::Node node(node_options);
  bus::Audit audit(node);
  options.refused = [&](const std::string& key) {
    audit.wrong_key("the Foxglove door", BootClock::seconds(),
                    persons.keys().ended(key, unix_seconds()));
  };
  options.came = [&](const std::string& key) {
    if (const auto person = visitor_of(key).person)
      audit.write({.act = v1::AUDIT_LET_IN,
                   .who = person->name + " at the Foxglove door",
                   .text = "to watch"});
  };
  viewer::Live live(node);
  std::optional<viewer::Server> server;
  const auto look_at_keys = [&] {
    if (const std::string trouble = persons.reload(unix_seconds()); !trouble.empty())
      node.error(trouble);
  };
  look_at_keys();
  const auto poll = [&] {
    live.poll(
        unix_nanoseconds(), [&](std::size_t channel) { return server->wants(channel); },
        [&](std::size_t channel, const std::string& json) {
          server->offer(channel, unix_nanoseconds(), json);
        });
  };
  server.emplace(options, live.channels(),
                 viewer::Server::Events{[&](std::size_t channel) {
                                          if (const std::string why = live.subscribe(channel);
                                              !why.empty())
                                            node.warn("not shown: " + why);
                                        },
                                        [&] {
                                          node.clear_wake();
                                          poll();
                                        },
                                        [&] {
                                          poll();
                                          look_at_keys();
                                          audit.tend(BootClock::seconds());
                                          node.publish_status();
                                        }});
  server->watch(node.wake_fd());
  if (const std::string exposed = web::exposure(options.place); !exposed.empty())
    std::fprintf(stderr, "saphira-foxglove: %s\n", exposed.c_str());
  std::printf(
      "open %s://%s:%d/?key=%s in Foxglove or Lichtblick, as a Foxglove WebSocket; Ctrl-C "
      "ends it\n",
      options.place.certificate.empty() ? "ws" : "wss", web::name_of(options.place).c_str(),
      server->port(), access.key.c_str());
  std::fflush(stdout);
  node.status().state = v1::SERVICE_RUNNING;
  server->run(stop.fd());
  return bus::kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  viewer::Server::Options options;
  std::string key_file;
  return bus::run_program(
      argc, argv, "foxglove",
      "Shows the robot in Foxglove, Lichtblick and others that speak their protocol.",
      [&](CommandLine& app) {
        app.add_option("--listen", options.place.address,
                       "address to listen on; 0.0.0.0: every one of IPv4, :: of IPv6, too");
        app.add_option("--port", options.place.port, "0: any that is free").in_range(0, 65500);
        const Option key = app.add_option("--certificate-key", options.place.certificate_key,
                                          "PEM file, of the certificate")
                               .existing_file();
        const Option certificate = app.add_option("--certificate", options.place.certificate,
                                                  "PEM file: it is encrypted (wss)")
                                       .existing_file()
                                       .needs(key);
        key.needs(certificate);
        app.add_option("--key-file", key_file, "keeps the key over a restart");
      },
      [&](const bus::NodeOptions& node, const bus::Stop& stop) {
        return node.dry_run ? static_cast<int>(bus::kExitOk) : serve(node, options, key_file, stop);
      });
}
