#include <cstdio>
#include <exception>
#include <thread>

#include "gateway.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/security/pair.hpp"
#include "screenshot.hpp"

namespace {

using namespace saphira;

/// Writes a picture of the present page to a file; then the program ends.
int picture(console::Gateway& gateway, const console::ScreenshotOptions& options) {
  bus::Stop done;
  std::exception_ptr failure;
  {
    const std::jthread photographer([&] {
      try {
        console::make_screenshot(gateway.address(), options);
      } catch (...) {
        failure = std::current_exception();
      }
      done.request();
    });
    gateway.run(done);
  }
  if (failure)
    std::rethrow_exception(failure);
  std::printf("%s\n", options.file.c_str());
  return bus::kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  console::GatewayOptions options;
  console::ScreenshotOptions screenshot;
  std::string dial;
  std::string token_file;
  return bus::run_program(
      argc, argv, "console", "Shows the robot in a browser, and lets people drive it from there.",
      [&](CommandLine& app) {
        app.add_option("--listen", options.server.place.address,
                       "address to listen on; 0.0.0.0: every one of IPv4, :: of IPv6, too");
        app.add_option("--port", options.server.place.port,
                       "the first port to try, of 20; 0: any that is free")
            .in_range(0, 65500);
        const Option key = app.add_option("--certificate-key", options.server.place.certificate_key,
                                          "PEM file, of the certificate")
                               .existing_file();
        const Option certificate = app.add_option("--certificate", options.server.place.certificate,
                                                  "PEM file: the page is served by HTTPS")
                                       .existing_file()
                                       .needs(key);
        key.needs(certificate);
        app.add_option("--host-name", options.names,
                       "a further name of this machine, or of a proxy before it");
        app.add_flag("--always-key", options.always_key,
                     "the key is needed for watching from this machine, too: where a tunnel ends "
                     "here that says nothing of who comes by it");
        const Option token =
            app.add_option("--dial-token-file", token_file,
                           "file with the token that the relay knows this robot by")
                .existing_file();
        app.add_option("--dial", dial,
                       "wss://HOST[:PORT]/ROBOT of a relay (saphira-relay) by which the page is "
                       "reached, too, where this machine has no address of its own")
            .needs(token)
            .needs(certificate);
        app.add_option("--dial-authority", options.dial_authority,
                       "PEM file that the relay's certificate is checked by, in the place of the "
                       "system's authorities")
            .placeholder("TEXT:FILE");
        app.add_option("--simulator", options.simulator,
                       "socket of a simulator's own view (saphira-sim --view-socket), for the page "
                       "/simulator.html");
        app.add_option("--box", options.box,
                       "folder for the last minute after a stop, a failed goal, or the loss of a "
                       "program, the robot or its place");
        app.add_option("--key-file", options.key_file,
                       "keeps key and port over a restart, so that open pages go on");
        app.add_option("--person-keys", options.person_keys,
                       "file with the keys of persons (saphira keys); several: the first that "
                       "exists");
        app.add_option("--screenshot", screenshot.file,
                       "makes a picture of the page, and ends; needs Chromium, and no display");
        app.add_option("--width", screenshot.width, "[pixels] of the picture");
        app.add_option("--height", screenshot.height, "[pixels]");
        app.add_flag("--dark", screenshot.dark, "the picture in dark colours");
        app.add_flag("--narrow", screenshot.narrow, "the picture as on a telephone");
        app.add_option("--tab", screenshot.tab, "what is open in the picture")
            .one_of({"Goals", "Why", "Behaviors", "Intentions", "Programs", "Messages"});
      },
      [&](const bus::NodeOptions& node, const bus::Stop& stop) {
        if (!dial.empty()) {
          options.dial = relay::parse_address(dial);
          options.dial_token = console::read_secret(token_file);
        }
        if (!options.dial_authority.empty())
          security::check_dial_authority(options.dial_authority);
        if (!options.server.place.certificate.empty()) {
          const std::string trouble =
              security::check_pair(options.server.place.certificate,
                                   options.server.place.certificate_key, unix_seconds());
          if (!trouble.empty())
            std::fprintf(stderr, "saphira-console: %s\n", trouble.c_str());
        }
        if (const std::string exposed = web::exposure(options.server.place); !exposed.empty())
          std::fprintf(stderr, "saphira-console: %s\n", exposed.c_str());
        if (node.dry_run) {  // its files were checked; its role says what it may write
          options.server.place.port = 0;
          options.key_file.clear();
          options.box.clear();
          options.simulator.clear();
          options.dial.reset();
          const console::Gateway gateway(node, options);
          return static_cast<int>(bus::kExitOk);
        }
        if (!screenshot.file.empty())
          options.server.place.port = 0;
        else
          options.stop = &stop;
        console::Gateway gateway(node, options);
        if (!screenshot.file.empty())
          return picture(gateway, screenshot);
        std::printf("open %s\n", gateway.address().c_str());
        std::fflush(stdout);
        return gateway.run(stop);
      });
}
