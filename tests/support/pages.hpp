#pragma once

#include <string>
#include <vector>

/// The documents, for tests that follow them to the letter. A page is a path from the root of the
/// sources, such as docs/deploy.md.
namespace saphira::test {

/// A fenced block, without its indent.
struct Block {
  std::string language;  ///< such as sh; empty: none
  std::string file;      ///< named in `...` by the paragraph before, the last one; empty: none
  std::string text;
};
std::vector<Block> blocks_of(const std::string& page);

/// The first block in that language; std::runtime_error where there is none.
std::string block_of(const std::string& page, const std::string& language);

/// The commands of all blocks in sh, in order, without comments.
std::vector<std::string> commands_of(const std::string& page);

/// The text with `to` in place of each `from`.
std::string replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace saphira::test
