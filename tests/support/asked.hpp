#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "saphira/base/text.hpp"
#include "trouble.hpp"

namespace saphira::test {

/// The player of a file of questions and answers: `VERB INPUT => ANSWER`, or on lines, where an
/// indented line goes on with the input, and `| LINE` is the next line of the answer. An answer
/// `!` is an error, `! PART` one with that in its message, `~PART` has that part, and (nothing) is
/// empty. Asked::answer(verb, input) is the answer; a std::invalid_argument or FileError is an
/// error. Asked::canonical(verb, wanted) is the written answer as that would be.
template <class Asked>
class Questions {
 public:
  void take(const std::string& line) {
    if (line.starts_with("  ")) {
      input_ += line.substr(1);
      return;
    }
    if (line.starts_with("|")) {
      ask();
      ASSERT_FALSE(lines_.empty()) << "nothing more is said";
      EXPECT_EQ(lines_.front(), line.substr(std::min<std::size_t>(2, line.size())));
      lines_.pop_front();
      return;
    }
    finish();
    const std::size_t arrow = line.find(" => ");
    const std::size_t space = line.find(' ');
    verb_ = line.substr(0, std::min(space, arrow));
    input_ = space < arrow ? line.substr(space + 1, arrow - space - 1) : "";
    if (arrow == std::string::npos)
      waits_ = true;
    else
      expect(line.substr(arrow + 4));
  }
  void finish() {
    ask();
    for (const std::string& line : std::exchange(lines_, {}))
      ADD_FAILURE() << "not written before this: " << line;
  }

 private:
  std::string said() const {
    try {
      return Asked::answer(verb_, input_);
    } catch (const std::invalid_argument& error) {
      return std::string("! ") + error.what();
    } catch (const FileError& error) {
      return std::string("! ") + error.what();
    }
  }
  void ask() {
    if (!std::exchange(waits_, false))
      return;
    std::istringstream in(said());
    for (std::string line; std::getline(in, line);)
      lines_.push_back(line);
  }
  void expect(const std::string& wanted) const {
    const std::string is = said();
    if (wanted == "!" || wanted.starts_with("! "))
      EXPECT_TRUE(is.starts_with("! ") &&
                  has(is, wanted.substr(std::min<std::size_t>(2, wanted.size()))))
          << input_ << ": " << is;
    else if (wanted.starts_with("~"))
      EXPECT_TRUE(has(is, wanted.substr(1))) << input_ << ": " << is;
    else
      EXPECT_EQ(is, wanted == "(nothing)" ? "" : Asked::canonical(verb_, wanted)) << input_;
  }

  std::string verb_;
  std::string input_;
  bool waits_ = false;  ///< for the lines of its answer
  std::deque<std::string> lines_;
};

}  // namespace saphira::test
