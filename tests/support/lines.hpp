#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <sstream>
#include <string>

#include "process.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {

/// Gives each line of a file of the source tree to `use`, without empty lines and comments. A
/// failure in it tells file and line.
template <class Use>
void each_line(const std::string& file, char comment, const Use& use) {
  std::istringstream lines(read_file(source(file)));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    SCOPED_TRACE(file + ":" + std::to_string(++number));
    if (!line.empty() && line[0] != comment)
      use(line);
  }
}

/// Plays a file of cases, each with a player of its own: "== its name" begins one, and " ; " parts
/// lines that are written as one. Returns how many cases there are.
template <class Player>
int play(const std::string& file, char comment = '#') {
  std::unique_ptr<Player> player;
  int cases = 0;
  const auto finish = [&] {
    if constexpr (requires { player->finish(); })
      if (player)
        player->finish();
  };
  each_line(file, comment, [&](const std::string& line) {
    if (line.starts_with("== ")) {
      finish();
      player = std::make_unique<Player>();
      ++cases;
      return;
    }
    ASSERT_TRUE(player);
    for (std::size_t at = 0, end = 0; at < line.size(); at = end + 3) {
      end = std::min(line.find(" ; ", at), line.size());
      const std::string part = line.substr(at, end - at);
      try {
        player->take(part);
      } catch (const std::exception& trouble) {
        ADD_FAILURE() << part << ": " << trouble.what();
      }
    }
  });
  SCOPED_TRACE("the end of " + file);
  finish();
  return cases;
}

}  // namespace saphira::test
