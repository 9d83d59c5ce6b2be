// An agent that answers requests: it knows from a calendar where people are.
//   calendar karen=library john=EJ-245
//   saphira ask place_of person=karen place=?
// The bus comes from the environment: SAPHIRA_ROBOT, SAPHIRA_DOMAIN, SAPHIRA_PROFILE.

#include <chrono>
#include <map>
#include <saphira/bus/agent.hpp>
#include <saphira/bus/program.hpp>
#include <saphira/command_line/command_line.hpp>

namespace bus = saphira::bus;
namespace v1 = saphira::v1;

int main(int argc, char** argv) {
  std::vector<std::string> entries;
  const auto add_options = [&](saphira::CommandLine& app) {
    app.add_option("entries", entries, "PERSON=PLACE, for each that it knows").required();
  };
  const auto body = [&](const bus::NodeOptions& options, const bus::Stop& stop) -> int {
    std::map<std::string, std::string> places;
    for (const std::string& entry : entries)
      places[entry.substr(0, entry.find('='))] = entry.substr(entry.find('=') + 1);

    bus::Node node(options);
    bus::Agent agent(node, "calendar", "knows from a calendar where people are");
    agent.can(bus::capability("place_of", "where a person is",
                              {bus::text_slot("person", "a name, in small letters", true),
                               bus::text_slot("place", "of the map")}),
              [&](const v1::Request& request) {
                const std::string person = bus::text_of(request.arguments(), "person");
                const auto found = places.find(person);
                if (found == places.end())
                  return bus::refused("the calendar has no " + person);
                return bus::done({bus::text("place", found->second)});
              });
    while (!stop.requested()) {
      node.wait(std::chrono::milliseconds(500), &stop);
      agent.poll();
      node.publish_status();
    }
    return bus::kExitOk;
  };
  return bus::run_program(argc, argv, "calendar", "Knows where people are", add_options, body);
}
