// Journeys from any place in a room of the office floor to another room by its name, and their
// results.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "places/places.hpp"
#include "saphira/base/places.hpp"

namespace {

using namespace saphira;

int run(int pairs, int seeds, int only, int draw, bool json) {
  const maps::Map map =
      maps::load_map(find_file(config_folder() + "/maps", "office-floor", ".map"));
  const sim::World world =
      sim::load_world(find_file(config_folder() + "/worlds", "office-floor", ".wld"));
  const auto journeys = test::random_journeys(map, world, pairs, static_cast<std::uint64_t>(draw));
  int runs = 0;
  int arrived = 0;
  int contacts = 0;
  int unexplained = 0;
  int passages = 0;
  int stopped = 0;
  std::uint64_t cycles = 0;
  for (int i = 0; i < pairs; ++i) {
    if (only >= 0 && only != i)
      continue;
    const test::Journey& journey = journeys[static_cast<std::size_t>(i)];
    for (int seed = 1; seed <= seeds; ++seed) {
      const test::Arrival arrival =
          test::travel(journey, static_cast<std::uint64_t>(seed), 6000, "office-floor", only >= 0);
      const bool good = arrival.succeeded && arrival.there && arrival.at_rest;
      ++runs;
      arrived += good ? 1 : 0;
      contacts += arrival.contacts;
      unexplained += good || (arrival.ended && !arrival.succeeded && arrival.at_rest &&
                              !arrival.reason.empty())
                         ? 0
                         : 1;
      passages += arrival.passages;
      stopped += arrival.stopped;
      cycles += arrival.cycles;
      for (const std::string& line : arrival.talk)
        std::printf("%s\n", line.c_str());
      if (!json)
        std::printf("%2d seed %d %s (%.2f, %.2f, %.0f) to %s: %s in %.0f s, %d contacts%s%s%s%s\n",
                    i, seed, journey.from.c_str(), journey.start_in_world.x,
                    journey.start_in_world.y, degrees(journey.start_in_world.th),
                    journey.to.c_str(), good ? "arrived" : "DID NOT ARRIVE",
                    0.1 * static_cast<double>(arrival.cycles), arrival.contacts,
                    good ? "" : (": " + arrival.reason).c_str(),
                    arrival.stopped > 0 ? ", a stop at the door" : "",
                    arrival.trouble.empty() ? "" : "; trouble: ", arrival.trouble.c_str());
      std::fflush(stdout);
    }
  }
  const double robot_hours = static_cast<double>(cycles) / 36000.0;
  if (json)
    std::printf(
        "{\"bench\": \"places\", \"journeys\": %d, \"arrived\": %d, \"without_reason\": %d, "
        "\"contacts\": %d, \"passages\": %d, \"passages_with_stop\": %d, \"robot_hours\": %.3f}\n",
        runs, arrived, unexplained, contacts, passages, stopped, robot_hours);
  else
    std::printf(
        "%d of %d arrived, %d of the others without a reason or not at rest, %d contacts; %d "
        "passages from a corridor through a door, %d with a stop; %.1f h of robot time\n",
        arrived, runs, unexplained, contacts, passages, stopped, robot_hours);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  int pairs = 20;
  int seeds = 5;
  int only = -1;
  int draw = 1;
  bool json = false;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const bool value = i + 1 < argc;
    if (option == "--json") {
      json = true;
    } else if (option == "--pairs" && value) {
      pairs = std::atoi(argv[++i]);
    } else if (option == "--seeds" && value) {
      seeds = std::atoi(argv[++i]);
    } else if (option == "--only" && value) {
      only = std::atoi(argv[++i]);
    } else if (option == "--draw" && value) {
      draw = std::atoi(argv[++i]);
    } else {
      std::fprintf(
          stderr,
          "usage: saphira-bench-places [--pairs N] [--seeds N] [--draw SEED] [--only PAIR] "
          "[--json]\n");
      return option == "--help" ? 0 : 2;
    }
  }
  try {
    return run(pairs, seeds, only, draw, json);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "saphira-bench-places: %s\n", error.what());
    return 1;
  }
}
