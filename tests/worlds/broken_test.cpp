// Each shipped world and map with one mistake in it, of ten kinds and more: the error gives the
// line and the column of the mistake.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "floor_plan.hpp"
#include "saphira/base/text.hpp"

namespace saphira {
namespace {

struct Text {
  std::vector<std::string> lines;

  std::string joined() const {
    std::string out;
    for (const std::string& line : lines)
      out += line + "\n";
    return out;
  }
};

Text text_of(const std::string& path) {
  Text text;
  std::string all = read_file(path);
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find('\n', begin), all.size());
    text.lines.push_back(all.substr(begin, end - begin));
    begin = end + 1;
  }
  return text;
}

struct Place {
  std::size_t line;  ///< from 0
  std::size_t column;
};

/// A word of a line, without its comment.
struct Found {
  std::string text;
  std::size_t column;
};

std::vector<Found> words(const std::string& line) {
  std::vector<Found> found;
  const std::size_t end = std::min(line.find(';'), line.size());
  for (std::size_t at = 0; at < end;) {
    if (std::isspace(static_cast<unsigned char>(line[at])) != 0) {
      ++at;
      continue;
    }
    const std::size_t begin = at;
    while (at < end && std::isspace(static_cast<unsigned char>(line[at])) == 0)
      ++at;
    found.push_back({line.substr(begin, at - begin), begin});
  }
  return found;
}

/// The first line, from a third of the text on and then from its top, whose first word is `first`
/// ("#": a number) and that has `count` words (0: any number of them).
std::optional<std::size_t> line_with(const Text& text, const std::string& first,
                                     std::size_t count) {
  const std::size_t n = text.lines.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t line = (i + n / 3) % n;
    const auto found = words(text.lines[line]);
    if (found.empty() || (count != 0 && found.size() != count))
      continue;
    const char c = found[0].text[0];
    const bool number = std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '-';
    if (first == "#" ? number : found[0].text == first)
      return line;
  }
  return std::nullopt;
}

/// Makes one mistake and returns its place.
using Mistake = Place (*)(Text&);

Place replace_word(Text& text, std::size_t line, std::size_t word, const std::string& by) {
  const Found found = words(text.lines[line]).at(word);
  text.lines[line].replace(found.column, found.text.size(), by);
  return {line, found.column};
}

std::size_t segment(const Text& text) {
  return line_with(text, "#", 4).value();
}

std::size_t start(const Text& text) {
  return line_with(text, "position", 4).value();
}

struct Kind {
  const char* name;
  Mistake make;
};

const Kind kWorldMistakes[] = {
    {"a letter in a number", [](Text& t) { return replace_word(t, segment(t), 2, "12O00"); }},
    {"a number too few",
     [](Text& t) {
       const std::size_t line = segment(t);
       const auto found = words(t.lines[line]);
       t.lines[line].resize(found[2].column + found[2].text.size());
       return Place{line, t.lines[line].size()};
     }},
    {"a number too many",
     [](Text& t) {
       const std::size_t line = segment(t);
       t.lines[line] = "1 2 3 4 5";
       return Place{line, 9};
     }},
    {"a number too large", [](Text& t) { return replace_word(t, segment(t), 1, "300000000000"); }},
    {"an unknown directive",
     [](Text& t) {
       t.lines.insert(t.lines.begin() + static_cast<std::ptrdiff_t>(segment(t)), "  plop 1 2 3");
       return Place{segment(t) - 1, 2};
     }},
    {"a pop too many",
     [](Text& t) {
       t.lines.emplace_back(" pop");
       return Place{t.lines.size() - 1, 1};
     }},
    {"a push without its angle",
     [](Text& t) {
       t.lines.emplace_back("push 100 200");
       return Place{t.lines.size() - 1, 12};
     }},
    {"the width twice",
     [](Text& t) {
       const std::size_t line = segment(t);
       t.lines[line] = "width 10000";
       return Place{line, 0};
     }},
    {"a comma in a number", [](Text& t) { return replace_word(t, start(t), 2, "1,000"); }},
    {"the height left out",
     [](Text& t) {
       // On the line of the width, or on its own: the following word reveals the missing one.
       for (std::string& line : t.lines) {
         const std::size_t at = line.find("height");
         if (at != std::string::npos && at < line.find(';')) {
           line.resize(at);
           break;
         }
       }
       for (std::size_t i = 0; i < t.lines.size(); ++i)
         if (const auto found = words(t.lines[i]); !found.empty() && found[0].text != "width")
           return Place{i, found[0].column};
       return Place{0, 0};
     }},
};

std::size_t entry(const Text& text) {
  for (const char* type : {"OFFICE", "CORRIDOR", "OBJECT"})
    if (const auto line = line_with(text, type, 0))
      return *line;
  throw std::runtime_error("a map without rooms");
}

std::size_t place(const Text& text) {
  return line_with(text, "POS", 0).value();
}

const Kind kMapMistakes[] = {
    {"an unknown type", [](Text& t) { return replace_word(t, entry(t), 0, "ROOM"); }},
    {"no id",
     [](Text& t) {
       const std::size_t line = entry(t);
       const Found id = words(t.lines[line]).at(1);
       t.lines[line].erase(id.column, id.text.size() + 1);
       return Place{line, id.column};
     }},
    {"an id that is not a number",
     [](Text& t) {
       Place at = replace_word(t, entry(t), 1, "(one)");
       return Place{at.line, at.column + 1};
     }},
    {"an id that is not positive",
     [](Text& t) {
       Place at = replace_word(t, entry(t), 1, "(-3)");
       return Place{at.line, at.column + 1};
     }},
    {"an id twice",
     [](Text& t) {
       t.lines.push_back(t.lines[place(t)]);
       return Place{t.lines.size() - 1, t.lines.back().find('(') + 1};
     }},
    {"a wall with an id",
     [](Text& t) {
       t.lines.emplace_back("WALL (1) 0, 0, 0, 1000");
       return Place{t.lines.size() - 1, 5};
     }},
    {"a letter in a number", [](Text& t) { return replace_word(t, entry(t), 3, "1O00,"); }},
    {"a value too few",
     [](Text& t) {
       const std::size_t line = entry(t);
       const auto found = words(t.lines[line]);
       t.lines[line].resize(found[4].column + found[4].text.size() - 1);
       return Place{line, t.lines[line].size()};
     }},
    {"a width of nothing",
     [](Text& t) {
       Place at = replace_word(t, entry(t), 6, "0");
       return at;
     }},
    {"a value too many",
     [](Text& t) {
       const std::size_t line = place(t);
       const std::size_t end = t.lines[line].find('"');
       t.lines[line].resize(end);
       t.lines[line] += ", 5";
       return Place{line, end};
     }},
    {"an angle out of all turns", [](Text& t) { return replace_word(t, entry(t), 4, "36000,"); }},
    {"a name that does not end",
     [](Text& t) {
       const std::size_t line = place(t);
       const std::size_t open = t.lines[line].find('"');
       t.lines[line].resize(t.lines[line].rfind('"'));
       return Place{line, open};
     }},
};

template <class Parse>
void expect_error(const std::string& path, const Kind& kind, const Parse& parse) {
  SCOPED_TRACE(path + ": " + kind.name);
  Text text = text_of(path);
  ASSERT_NO_THROW(parse(text.joined(), path));
  const Place mistake = kind.make(text);
  try {
    parse(text.joined(), path);
    ADD_FAILURE() << "no error";
  } catch (const FileError& error) {
    EXPECT_EQ(error.file(), path);
    EXPECT_EQ(error.line(), static_cast<int>(mistake.line) + 1) << error.what();
    EXPECT_EQ(error.column(), static_cast<int>(mistake.column) + 1) << error.what();
    EXPECT_NE(std::string(error.what()).find("expected"), std::string::npos) << error.what();
  }
}

TEST(BrokenFiles, EachWorldWithEachMistakeSaysWhere) {
  static_assert(std::size(kWorldMistakes) >= 10);
  for (const std::string& stem : test::stems("config/worlds", ".wld"))
    for (const Kind& kind : kWorldMistakes)
      expect_error(test::source("config/worlds/" + stem + ".wld"), kind, sim::parse_world);
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> found;
  for (const Line& line : split_lines(text))
    for (const Word& word : line.words)
      found.push_back(std::to_string(line.number) + " " + std::string(word.text));
  return found;
}

// A world file that is cut off between two lines may still be valid, without the rest. But no line
// is read in part.
TEST(BrokenFiles, EachWorldThatIsCutOffWithinALineIsRefused) {
  const std::string path = ::testing::TempDir() + "cut-off-" + std::to_string(getpid()) + ".wld";
  for (const std::string& stem : test::stems("config/worlds", ".wld")) {
    const std::string text = read_file(test::source("config/worlds/" + stem + ".wld"));
    ASSERT_TRUE(text.ends_with('\n')) << stem;
    const std::vector<std::string> whole = words_of(text);
    std::ofstream(path, std::ios::binary) << text;
    int refused = 0;
    for (std::size_t size = text.size(); size-- > 0;) {
      std::filesystem::resize_file(path, size);
      SCOPED_TRACE(stem + " cut to " + std::to_string(size) + " bytes");
      try {
        sim::load_world(path);
        const auto left = words_of(text.substr(0, size));
        ASSERT_LE(left.size(), whole.size());
        ASSERT_TRUE(std::equal(left.begin(), left.end(), whole.begin()));
        // The first missing word begins a line.
        EXPECT_TRUE(left.empty() || left.size() == whole.size() ||
                    std::atoi(left.back().c_str()) < std::atoi(whole[left.size()].c_str()));
      } catch (const FileError& error) {
        ++refused;
        EXPECT_EQ(error.file(), path);
        EXPECT_GE(error.line(), 1);
        EXPECT_NE(std::string(error.what()).find("expected"), std::string::npos) << error.what();
      }
    }
    EXPECT_GT(refused, 0);
  }
  std::filesystem::remove(path);
}

TEST(BrokenFiles, EachMapWithEachMistakeSaysWhere) {
  static_assert(std::size(kMapMistakes) >= 10);
  for (const std::string& stem : test::stems("config/maps", ".map"))
    for (const Kind& kind : kMapMistakes)
      expect_error(test::source("config/maps/" + stem + ".map"), kind, maps::parse_map);
}

}  // namespace
}  // namespace saphira
