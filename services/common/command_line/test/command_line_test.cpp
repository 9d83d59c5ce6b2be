#include "saphira/command_line/command_line.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "lines.hpp"
#include "saphira/base/text.hpp"

namespace saphira {
namespace {

struct Parsed {
  std::optional<int> code;
  std::string out;
  std::string err;
};

Parsed parse(CommandLine& line, std::vector<const char*> words) {
  words.insert(words.begin(), "gauge");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const std::optional<int> code = line.parse(static_cast<int>(words.size()), words.data());
  return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

TEST(CommandLine, WritesEachKindOfValue) {
  std::string text;
  std::vector<std::string> list;
  double number = 1.5;
  std::optional<double> maybe;
  int count = 3;
  std::uint16_t port = 0;
  bool flag = false;
  bool kept = true;
  std::string acted;
  CommandLine line("measures", "gauge");
  line.add_option("text", text, "a text");
  line.add_option("--list", list, "texts").separated_by(',');
  line.add_option("--number", number, "a number").in_range(0.0, 3.0);
  line.add_option("--maybe", maybe, "a number or none");
  line.add_option("--count", count, "how many").in_range(1, 9);
  line.add_option("--port", port, "a port");
  line.add_flag("--flag", flag, "sets");
  line.add_flag("!--no-kept", kept, "clears");
  line.add_action(
      "--act", [&](const std::string& word) { acted = word; }, "does something");
  EXPECT_EQ(parse(line, {"word", "--list", "a,b", "--number", "2.5", "--maybe=-1", "--port", "80",
                         "--flag", "--no-kept", "--act", "now"})
                .code,
            std::nullopt);
  EXPECT_EQ(text, "word");
  EXPECT_EQ(list, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(number, 2.5);
  EXPECT_EQ(maybe, -1.0);
  EXPECT_EQ(count, 3);
  EXPECT_EQ(port, 80);
  EXPECT_TRUE(flag);
  EXPECT_FALSE(kept);
  EXPECT_EQ(acted, "now");
  EXPECT_TRUE(line.option("--count").given() == false && line.option("--port").given());
  EXPECT_THROW(line.option("--nothing"), std::out_of_range);
}

TEST(CommandLine, HelpShowsDefaultsThatSaySomething) {
  std::string empty;
  std::string full = "office";
  double speed = 0.3;
  std::string file;
  std::string secret = "hush";
  CommandLine line("measures", "gauge");
  line.add_option("--empty", empty, "without");
  line.add_option("--full", full, "with");
  line.add_option("--speed", speed, "with").in_range(0.0, 2.0);
  line.add_option("--file", file, "to read").required();
  line.add_option("--secret", secret, "is not shown").hidden();
  const Parsed help = parse(line, {"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("--empty TEXT "), std::string::npos) << help.out;
  EXPECT_NE(help.out.find("--full TEXT=office"), std::string::npos) << help.out;
  EXPECT_NE(help.out.find("in [0 - 2]=0.3"), std::string::npos) << help.out;
  EXPECT_NE(help.out.find("--file TEXT REQUIRED"), std::string::npos) << help.out;
  EXPECT_EQ(help.out.find("secret"), std::string::npos) << help.out;
}

/// The message of "gauge" with these options, for these words.
std::string mistake(const std::string& options, std::vector<const char*> given) {
  std::string text[4];
  std::vector<std::string> pair;
  std::optional<std::uint16_t> port;
  std::uint16_t domain = 0;
  unsigned long seed = 0;
  double number[2] = {};
  bool flag = false;
  long count = 0;
  int few = 0;
  CommandLine line("measures", "gauge");
  if (options == "kinds") {
    line.add_option("--kind", text[0], "one").one_of({"laser", "sonar"});
    line.add_option("--speed", number[0], "[m/s]").positive();
    const Option first = line.add_option("--key", text[1], "a file").existing_file();
    line.add_option("--even", text[2], "two letters").needs(first).check([](const auto& letters) {
      return letters.size() == 2 ? std::string() : "expected two letters, found " + letters;
    });
  } else if (options == "usual") {
    line.add_option("file", text[0], "to read").required();
    const Option first = line.add_option("--place", text[1], "");
    line.add_option("--both", text[2], "").excludes(first);
    line.add_option("--address", text[3], "").ipv4();
    line.add_option("--pair", pair, "X Y").values(2);
    line.add_option("--count", few, "").in_range(1, 9);
    line.add_flag("--flag", flag, "sets");
  } else if (options == "variables") {
    line.add_option("--domain", domain, "").in_range(0, 231).environment("GAUGE_DOMAIN");
    line.add_action(
            "--kind,--sort", [&](const std::string& word) { text[0] = word; }, "")
        .environment("GAUGE_KIND")
        .one_of({"laser", "sonar"});
  } else {
    line.add_option("length", number[0], "[m]");
    line.add_option("--count,-n", count, "how many");
    line.add_option("--seed", seed, "of the noise");
    line.add_option("--port", port, "to listen on");
    line.add_option("--part", number[1], "of the whole").in_range(0.0, 0.5);
  }
  const Parsed parsed = parse(line, std::move(given));
  EXPECT_EQ(parsed.code, 2);
  EXPECT_EQ(parsed.out, "");
  return parsed.err;
}

TEST(CommandLine, MistakesAreNamed) {
  ::setenv("GAUGE_DOMAIN", "abc", 1);
  ::setenv("GAUGE_KIND", "radar", 1);
  const std::string file = "services/common/command_line/test/mistakes.txt";
  const int mistakes = test::each_line(file, '#', [](const std::string& line) {
    const std::size_t arrow = line.find(" => ");
    std::istringstream in(line.substr(0, arrow));
    std::string options;
    in >> options;
    std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
    std::vector<const char*> given;
    for (const std::string& word : words)
      given.push_back(word.c_str());
    EXPECT_EQ(mistake(options.substr(0, options.size() - 1), given),
              "gauge: " + line.substr(arrow + 4) + "\n");
  });
  EXPECT_EQ(mistakes, 36);
  ::unsetenv("GAUGE_DOMAIN");
  ::unsetenv("GAUGE_KIND");
}

TEST(ExitCodeOf, AMistakeOfAPersonIsTwoAndOtherErrorsAreThree) {
  const auto of = [](const auto& error) {
    testing::internal::CaptureStderr();
    const int code = exit_code_of("gauge", [&]() -> int { throw error; });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), std::string("gauge: ") + error.what() + "\n");
    return code;
  };
  EXPECT_EQ(of(FileError("a.p", 1, 1, "expected a word")), kExitUsage);
  EXPECT_EQ(of(UnusableFile("a.p: cannot be read")), kExitUsage);
  EXPECT_EQ(of(std::invalid_argument("--rate: expected a number")), kExitUsage);
  EXPECT_EQ(of(std::runtime_error("no memory")), kExitBroken);
  EXPECT_EQ(exit_code_of("gauge", [] { return 1; }), kExitFailed);
}

}  // namespace
}  // namespace saphira
