#include "saphira/situation/sentence.hpp"

#include <algorithm>

namespace saphira::situation {

void Sentence::add(int rank, std::string text, std::string brief) {
  if (!text.empty())
    parts_.push_back({rank, std::move(text), std::move(brief)});
}

std::string Sentence::text() const {
  std::vector<Part> parts = parts_;
  const auto joined = [&parts] {
    std::string text;
    for (const Part& part : parts)
      text += part.text;
    return text;
  };
  const auto fits = [&] { return joined().size() + 1 < kLongestSentence; };
  int most = 0;
  for (const Part& part : parts)
    most = std::max(most, part.rank);
  // Among equal ranks, the last part is less important.
  for (int rank = most; rank >= 0 && !fits(); --rank)
    for (std::size_t i = parts.size(); i-- > 0 && !fits();)
      if (parts[i].rank == rank && !parts[i].brief.empty())
        parts[i].text = parts[i].brief;
  for (int rank = most; rank > 0 && !fits(); --rank)
    for (std::size_t i = parts.size(); i-- > 0 && !fits();)
      if (parts[i].rank == rank)
        parts[i].text.clear();
  return cut(joined(), kLongestSentence - 2) + ".";
}

std::string cut(const std::string& text, std::size_t most) {
  constexpr std::size_t kDots = 3;
  if (text.size() <= most || most <= kDots)
    return text;
  std::size_t end = text.rfind(' ', most - kDots);
  if (end == std::string::npos || end < most / 2)
    end = most - kDots;
  // Not within a character of several bytes.
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    --end;
  return text.substr(0, end) + "...";
}

}  // namespace saphira::situation
