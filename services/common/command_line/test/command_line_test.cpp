#include "saphira/command_line/command_line.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

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

TEST(CommandLine, MistakesAreNamed) {
  std::string kind;
  double speed = 0.0;
  std::string key;
  std::string even;
  const auto words = [&](std::vector<const char*> given) {
    CommandLine line("measures", "gauge");
    line.add_option("--kind", kind, "one").one_of({"laser", "sonar"});
    line.add_option("--speed", speed, "[m/s]").positive();
    const Option first = line.add_option("--key", key, "a file").existing_file();
    line.add_option("--even", even, "two letters").needs(first).check([](const std::string& text) {
      return text.size() == 2 ? std::string() : "expected two letters, found " + text;
    });
    const Parsed parsed = parse(line, std::move(given));
    EXPECT_EQ(parsed.code, 2);
    return parsed.err;
  };
  EXPECT_EQ(words({"--sped", "1"}), "gauge: \"--sped\" is not understood: did you mean --speed?\n");
  EXPECT_EQ(words({"--kind", "radar"}), "gauge: --kind: expected laser or sonar, found radar\n");
  EXPECT_EQ(words({"--kind", "lazer"}),
            "gauge: --kind: expected laser or sonar, found lazer: did you mean laser?\n");
  EXPECT_EQ(words({"--kind"}), "gauge: --kind: expected a value (one), found none\n");
  EXPECT_EQ(words({"--speed", "-1"}), "gauge: --speed: expected a number above 0, found -1\n");
  EXPECT_EQ(words({"--speed", "nan"}), "gauge: --speed: expected a number above 0, found nan\n");
  EXPECT_EQ(words({"--speed", "inf"}), "gauge: --speed: expected a number above 0, found inf\n");
  EXPECT_EQ(words({"--key", "/nowhere/key"}),
            "gauge: --key: expected a file, found nothing at /nowhere/key\n");
  EXPECT_EQ(words({"--key", "/dev/nul"}),
            "gauge: --key: expected a file, found nothing at /dev/nul: did you mean /dev/null?\n");
  EXPECT_EQ(words({"--key", "/dev"}), "gauge: --key: expected a file, found the folder /dev\n");
  EXPECT_EQ(words({"--even", "ab"}),
            "gauge: --even: expected --key beside it (a file), found none\n");
  EXPECT_EQ(words({"--key", "/dev/null", "--even", "abc"}),
            "gauge: --even: expected two letters, found abc\n");
}

TEST(CommandLine, NoMistakeIsInTheWordsOfTheParser) {
  std::string file;
  std::string place;
  std::string address;
  std::string both;
  std::vector<std::string> pair;
  bool flag = false;
  int count = 0;
  const auto words = [&](std::vector<const char*> given) {
    CommandLine line("measures", "gauge");
    line.add_option("file", file, "to read").required();
    const Option first = line.add_option("--place", place, "");
    line.add_option("--both", both, "").excludes(first);
    line.add_option("--address", address, "").ipv4();
    line.add_option("--pair", pair, "X Y").values(2);
    line.add_option("--count", count, "").in_range(1, 9);
    line.add_flag("--flag", flag, "sets");
    const Parsed parsed = parse(line, std::move(given));
    EXPECT_EQ(parsed.code, 2);
    EXPECT_EQ(parsed.out, "");
    return parsed.err;
  };
  EXPECT_EQ(words({}), "gauge: file: expected a value (to read), found none\n");
  EXPECT_EQ(words({"f", "--place", "a", "--both", "b"}),
            "gauge: --place: expected no --both beside it, found both\n");
  EXPECT_EQ(words({"f", "--pair", "1"}), "gauge: --pair: expected 2 values (X Y), found 1\n");
  EXPECT_EQ(words({"f", "--place", "a", "--place", "b"}),
            "gauge: --place: expected one value, found 2\n");
  EXPECT_EQ(words({"f", "--address", "1.2.3"}),
            "gauge: --address: expected an IPv4 address, such as 192.168.1.7, found 1.2.3\n");
  EXPECT_EQ(words({"f", "--address", "1.2.3.400"}),
            "gauge: --address: expected an IPv4 address, such as 192.168.1.7, found 1.2.3.400\n");
  EXPECT_EQ(words({"f", "--flag=maybe"}),
            "gauge: --flag: expected true, false or no value, found maybe\n");
  EXPECT_EQ(words({"f", "--count", "10"}),
            "gauge: --count: expected a whole number between 1 and 9, found 10\n");
  EXPECT_EQ(words({"f", "--count", "1.5"}),
            "gauge: --count: expected a whole number between 1 and 9, found 1.5\n");
  EXPECT_EQ(words({"f", "--count", "99999999999"}),
            "gauge: --count: expected a whole number between 1 and 9, found 99999999999\n");
}

TEST(CommandLine, AMistakeInAVariableNamesTheVariable) {
  ::setenv("GAUGE_DOMAIN", "abc", 1);
  ::setenv("GAUGE_KIND", "radar", 1);
  std::uint16_t domain = 0;
  std::string kind;
  const auto words = [&](std::vector<const char*> given) {
    CommandLine line("measures", "gauge");
    line.add_option("--domain", domain, "").in_range(0, 231).environment("GAUGE_DOMAIN");
    line.add_action(
            "--kind,--sort", [&](const std::string& word) { kind = word; }, "")
        .environment("GAUGE_KIND")
        .one_of({"laser", "sonar"});
    const Parsed parsed = parse(line, std::move(given));
    EXPECT_EQ(parsed.code, 2);
    return parsed.err;
  };
  EXPECT_EQ(words({"--sort", "sonar"}),
            "gauge: GAUGE_DOMAIN: expected a whole number between 0 and 231, found abc\n");
  EXPECT_EQ(words({"--domain", "def"}),
            "gauge: --domain: expected a whole number between 0 and 231, found def\n");
  EXPECT_EQ(words({"--domain=232"}),
            "gauge: --domain: expected a whole number between 0 and 231, found 232\n");
  EXPECT_EQ(words({"--domain", "1"}), "gauge: GAUGE_KIND: expected laser or sonar, found radar\n");
  EXPECT_EQ(words({"--domain", "1", "--sort", "radar"}),
            "gauge: --kind: expected laser or sonar, found radar\n");
  ::unsetenv("GAUGE_DOMAIN");
  ::unsetenv("GAUGE_KIND");
}

TEST(CommandLine, ANumberIsExpectedInWords) {
  long count = 0;
  unsigned long seed = 0;
  std::optional<std::uint16_t> port;
  double part = 0.0;
  double length = 0.0;
  const auto words = [&](std::vector<const char*> given) {
    CommandLine line("measures", "gauge");
    line.add_option("length", length, "[m]");
    line.add_option("--count,-n", count, "how many");
    line.add_option("--seed", seed, "of the noise");
    line.add_option("--port", port, "to listen on");
    line.add_option("--part", part, "of the whole").in_range(0.0, 0.5);
    const Parsed parsed = parse(line, std::move(given));
    EXPECT_EQ(parsed.code, 2);
    return parsed.err;
  };
  EXPECT_EQ(words({"--count", "x"}), "gauge: --count: expected a whole number, found x\n");
  EXPECT_EQ(words({"--seed", "x"}),
            "gauge: --seed: expected a whole number of 0 or more, found x\n");
  EXPECT_EQ(words({"--seed", "-3"}),
            "gauge: --seed: expected a whole number between 0 and 18446744073709551615, found "
            "-3\n");
  EXPECT_EQ(words({"--seed", "18446744073709551616"}),
            "gauge: --seed: expected a whole number between 0 and 18446744073709551615, found "
            "18446744073709551616\n");
  EXPECT_EQ(words({"--port", "99999"}),
            "gauge: --port: expected a whole number between 0 and 65535, found 99999\n");
  EXPECT_EQ(words({"--port", "x"}),
            "gauge: --port: expected a whole number of 0 or more, found x\n");
  EXPECT_EQ(words({"--part", "nan"}),
            "gauge: --part: expected a number between 0 and 0.5, found nan\n");
  EXPECT_EQ(words({"far"}), "gauge: length: expected a number, found far\n");
  EXPECT_EQ(words({"--part", "2"}),
            "gauge: --part: expected a number between 0 and 0.5, found 2\n");
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
