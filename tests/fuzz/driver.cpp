// Drives a fuzzer without libFuzzer: a number of inputs, made from the seeds (and
// from nothing) by random changes. The same inputs in every run.
//
//     fuzz_x COUNT [SEED_FILE...]    or, to see a failure again:    fuzz_x - FILE...

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "fuzz.hpp"
#include "saphira/base/random.hpp"

namespace {

const char* const kTokens[] = {"\xFA\xFB", "-",    "1e999", "nan",          "\n",       ";",
                               "0",        "push", "pop",   "999999999999", "SonarUnit"};

std::string mutate(std::string text, saphira::Random& random) {
  const std::uint32_t changes = 1 + random.next() % 8;
  for (std::uint32_t i = 0; i < changes; ++i) {
    const std::size_t at = text.empty() ? 0 : random.next() % (text.size() + 1);
    const std::size_t length = std::min<std::size_t>(random.next() % 20, text.size() - at);
    switch (random.next() % 6) {
      case 0:
        text.insert(at, 1, static_cast<char>(random.next()));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        if (at < text.size())
          text[at] = static_cast<char>(random.next());
        break;
      case 3:
        text.insert(at, text.substr(at, length));
        break;
      case 4:
        text.insert(at, kTokens[random.next() % std::size(kTokens)]);
        break;
      default:
        if (random.chance(0.1))
          text.resize(at);
        break;
    }
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2)
    return 2;
  std::vector<std::string> seeds{""};
  for (int i = 2; i < argc; ++i)
    seeds.push_back(saphira::read_bytes(argv[i]));
  for (const std::string& seed : seeds)
    saphira::fuzz::run(seed);
  const long count = std::strtol(argv[1], nullptr, 10);
  saphira::Random random(1);
  for (long i = 0; i < count; ++i) {
    std::string input = seeds[random.next() % seeds.size()];
    if (input.empty()) {
      input.resize(random.next() % 600);
      for (char& c : input)
        c = static_cast<char>(random.next());
    }
    saphira::fuzz::run(mutate(input, random));
  }
  std::printf("%ld inputs\n", count);
  return 0;
}
