#include "saphira/intentions/journal.hpp"

#include <exception>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "saphira/base/archive.hpp"
#include "saphira/base/durable.hpp"

namespace saphira::intentions {
namespace {

/// A line: one of the two.
struct Entry {
  std::optional<Placement> placed{};
  std::optional<Ending> ended{};
};

}  // namespace

std::string write_line(const Ending& ending) {
  return sealed(saved(Entry{.ended = ending}));
}

std::string write_line(const Placement& placement) {
  return sealed(saved(Entry{.placed = placement}));
}

Memory read_journal(const std::string& file, std::string_view content,
                    std::vector<FileError>& damaged) {
  std::map<GoalId, Placement> placements;
  Memory memory;
  for (int number = 1; !content.empty(); ++number) {
    const std::string_view text = content.substr(0, content.find('\n') + 1);
    content.remove_prefix(text.empty() ? content.size() : text.size());
    try {
      const auto line = unsealed(text);
      if (!line)
        throw std::runtime_error("the line is not whole, or its sum is wrong");
      auto entry = restored<Entry>(*line);
      if (entry.placed)
        placements[entry.placed->id] = std::move(*entry.placed);
      if (entry.ended) {
        placements.erase(entry.ended->id);
        memory.endings.push_back(std::move(*entry.ended));
      }
    } catch (const std::exception& error) {
      damaged.emplace_back(file, number, 1, error.what(), text.substr(0, text.find('\n')));
    }
  }
  for (auto& [id, placement] : placements)
    memory.placements.push_back(std::move(placement));
  return memory;
}

}  // namespace saphira::intentions
