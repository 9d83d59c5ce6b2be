#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "process.hpp"

/// The manual's own programs, as printed, if the manual is there. Tables, and nothing else, correct
/// the errors of the scan.
namespace saphira::test {

struct Mend {
  std::string printed;
  std::string meant;
};

/// $SAPHIRA_MANUAL, or the file beside the source tree.
inline std::string manual() {
  const char* const given = std::getenv("SAPHIRA_MANUAL");
  std::ifstream in(given != nullptr ? given : source("../shared/seeds/saphira-manual-5.3.txt"));
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The manual's code blocks from one heading to another, corrected by `mends`.
inline std::string printed(const std::string& from, const std::string& to,
                           const std::vector<Mend>& mends) {
  const std::string text = manual();
  const std::size_t begin = text.rfind("\n" + from);
  const std::string section = text.substr(begin, text.find("\n" + to, begin) - begin);
  std::string code;
  for (std::size_t at = section.find("```"); at != std::string::npos;
       at = section.find("```", at)) {
    const std::size_t end = section.find("```", at + 3);
    code += section.substr(at + 3, end - at - 3);
    at = end + 3;
  }
  for (const Mend& mend : mends) {
    const std::size_t at = code.find(mend.printed);
    EXPECT_NE(at, std::string::npos) << "not printed: " << mend.printed;
    for (std::size_t i = code.find(mend.printed); i != std::string::npos;
         i = code.find(mend.printed, i + mend.meant.size()))
      code.replace(i, mend.printed.size(), mend.meant);
  }
  return code;
}

// The scan has put the call into the comment beside it.
inline const Mend kStartup{"/* start up the Saphira OS,\n sfStartup(1);",
                           "sfStartup(1); /* the OS,"};
inline const Mend kMain{"void main(", "int main("};
inline const Mend kBrace{"Ł", "{"};
inline const Mend kSmallBrace{"ł", "{"};

/// 4.3.4.
inline std::string printed_saphira() {
  return printed(
      "4.3.4. The Saphira", "4.3.5.",
      {kMain,
       kBrace,
       kSmallBrace,
       {"sffloat", "sfFLOAT"},
       {"void myConnectFn(void);", "void myConnectFn(void);\nvoid test_control_proc(void);"},
       {"\"User Process\");\n", "\"User Process\");\n}\n"},
       {"\"Resumed\");\n      break;\n    }\n", "\"Resumed\");\n      break;\n    }\n}\n"},
       {"void test_control_proc(void)\n", "void test_control_proc(void)\n{"},
       {"  return 0;\n", "  return 0;\n}\n"},
       {"return 1:\n    3\n", "return 1;\n    }\n"}});
}

}  // namespace saphira::test
