#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace saphira::speech {

/// True for a code such as EJ-231, which is spelled.
bool is_code(const std::string& word);
/// "e j two three one"
std::string spelled(const std::string& word);

/// Phones of a word, such as "F L EY K IY", in those of the CMU dictionary.
using Phones = std::vector<std::string>;

/// The pronunciation of words: from a file, else from the dictionary, else by flite's rules.
class Pronunciations {
 public:
  /// All pronunciations of a word in the dictionary, or none.
  using Dictionary = std::function<Phones(const std::string& word)>;

  /// `text`: lines such as "flakey F L EY K IY"; several for a word are allowed, # begins a
  /// comment. FileError with line and column.
  Pronunciations(std::string_view text, const std::string& file, Dictionary dictionary);

  /// At least one, for a word in small letters as in the grammar.
  Phones of(const std::string& word) const;

 private:
  Phones of_code(const std::string& word) const;

  Dictionary dictionary_;
  std::map<std::string, Phones> own_;
};

/// All phones.
const std::vector<std::string>& phones();

}  // namespace saphira::speech
