// An agent that answers requests: it knows from a calendar where people are.
//   calendar karen=library john=EJ-245
//   saphira ask place_of person=karen place=?
// The bus comes from the environment: SAPHIRA_ROBOT, SAPHIRA_DOMAIN, SAPHIRA_PROFILE.

#include <chrono>
#include <map>
#include <saphira/base/text.hpp>
#include <saphira/bus/agent.hpp>
#include <saphira/bus/program.hpp>
#include <saphira/command_line/command_line.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace bus = saphira::bus;
namespace v1 = saphira::v1;

namespace {

/// The places of the people. std::invalid_argument says what is wrong with an entry.
std::map<std::string, std::string> read_entries(const std::vector<std::string>& entries) {
  std::map<std::string, std::string> places;
  for (const std::string& entry : entries) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == entry.size())
      throw std::invalid_argument("expected PERSON=PLACE, found \"" + entry + "\"");
    const std::string person = saphira::lowered(entry.substr(0, equals));
    if (!places.emplace(person, entry.substr(equals + 1)).second)
      throw std::invalid_argument("expected one place for each person, found two for " + person);
  }
  return places;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> entries;
  const auto add_options = [&](saphira::CommandLine& app) {
    app.add_option("entries", entries, "PERSON=PLACE, for each that it knows").required();
  };
  const auto body = [&](const bus::NodeOptions& options, const bus::Stop& stop) -> int {
    const std::map<std::string, std::string> places = read_entries(entries);
    bus::Node node(options);
    bus::Agent agent(node, "calendar", "knows from a calendar where people are");
    agent.can(
        bus::capability(
            "place_of", "where a person is",
            {bus::text_slot("person", "a name", true), bus::text_slot("place", "of the map")}),
        [&](const v1::Request& request) {
          const std::string person = saphira::lowered(bus::text_of(request.arguments, "person"));
          if (person.empty()) {
            return v1::Answer{.code = v1::ANSWER_BAD_ARGUMENT,
                              .text = "person: expected a name as text, such as person=karen"};
          }
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
