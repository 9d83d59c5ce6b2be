#include "saphira/speech/reading.hpp"

#include <array>
#include <map>
#include <stdexcept>

#include "saphira/speech/voice.hpp"

namespace saphira::speech {
namespace {

constexpr const char* kRobot = "kal16";
constexpr std::array kPeople{"slt", "rms", "awb"};
constexpr double kPause = 0.5;  // [s]

}  // namespace

std::vector<Passage> read_aloud(std::string_view dialogue, const std::string& robot) {
  std::vector<Passage> passages;
  std::map<std::string, Voice, std::less<>> voices;
  voices.emplace(robot, kRobot);
  std::size_t number = 0;
  while (!dialogue.empty()) {
    const std::string_view line = dialogue.substr(0, dialogue.find('\n'));
    dialogue.remove_prefix(std::min(dialogue.size(), line.size() + 1));
    ++number;
    if (line.empty())
      continue;
    const std::size_t colon = line.find(": ");
    if (colon == std::string_view::npos || colon == 0)
      throw std::invalid_argument("line " + std::to_string(number) +
                                  ": expected \"speaker: words\"");
    const std::string speaker(line.substr(0, colon));
    const Voice& voice =
        voices.try_emplace(speaker, kPeople[(voices.size() - 1) % kPeople.size()]).first->second;
    passages.push_back({speaker, voice.say(std::string(line.substr(colon + 2)))});
  }
  return passages;
}

Sound joined(const std::vector<Passage>& passages) {
  Sound all;
  for (const Passage& passage : passages) {
    all.insert(all.end(), passage.sound.begin(), passage.sound.end());
    all.resize(all.size() + static_cast<std::size_t>(kPause * kRate));
  }
  return all;
}

}  // namespace saphira::speech
