#include "pages.hpp"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "process.hpp"

namespace saphira::test {

std::vector<Block> blocks_of(const std::string& page) {
  const std::regex named("`([A-Za-z0-9_/.-]+[.][a-z]+)`");
  std::ifstream in(source(page));
  std::vector<Block> blocks;
  std::string file;
  std::size_t indent = 0;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    const std::size_t fence = line.find("```");
    if (fence != std::string::npos) {
      inside = !inside;
      indent = fence;
      if (inside)
        blocks.push_back({line.substr(fence + 3), file, ""});
      file.clear();
    } else if (inside) {
      blocks.back().text += line.substr(std::min(indent, line.size())) + "\n";
    } else {
      for (std::smatch found; std::regex_search(line, found, named); line = found.suffix())
        file = found[1];
    }
  }
  return blocks;
}

std::string block_of(const std::string& page, const std::string& language) {
  for (const Block& block : blocks_of(page))
    if (block.language == language)
      return block.text;
  throw std::runtime_error(page + " has no block in \"" + language + "\"");
}

std::vector<std::string> commands_of(const std::string& page) {
  std::vector<std::string> commands;
  for (const Block& block : blocks_of(page)) {
    if (block.language != "sh")
      continue;
    std::istringstream lines(replaced(block.text, "\\\n", ""));
    for (std::string line; std::getline(lines, line);)
      if (!line.empty() && !line.starts_with("#"))
        commands.push_back(line.substr(0, line.find(" #")));
  }
  return commands;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace saphira::test
