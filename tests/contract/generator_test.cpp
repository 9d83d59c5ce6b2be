// The generator refuses what other vendors read in another way.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "installed.hpp"
#include "process.hpp"

namespace saphira {
namespace {

/// Its error, without the folder; empty: there is none.
std::string error_of(const std::string& members, bool foreign = false) {
  const test::TempDir folder;
  std::ofstream(folder.path("a.idl")) << "module saphira { module v1 {\n" << members << "\n}; };\n";
  std::vector<std::string> words{test::Installed::build_folder() + "/idl/saphira-idl-generate",
                                 folder.path("out")};
  if (foreign)
    words.insert(words.end(), {"--foreign", "idl"});
  words.push_back(folder.path("a.idl"));
  test::Process generator(words, folder.path("log"));
  const bool good = generator.wait() == 0;
  EXPECT_EQ(good, std::ifstream(folder.path("out/saphira/idl/a.hpp")).good());
  const std::string said = generator.output();
  return said.substr(std::min(said.find("a.idl"), said.size()));
}

TEST(Generator, RefusesWhatOthersReadInAnotherWay) {
  const std::string final = "@extensibility(FINAL) struct ";
  EXPECT_EQ(error_of(final + "A { @key long a; sequence<long, 3> b; };"), "");
  EXPECT_EQ(error_of("struct A { long a; };"),
            "a.idl:2: expected module, enum, @extensibility(FINAL) struct, typedef or const, found "
            "struct\n");
  EXPECT_EQ(error_of("@extensibility(MUTABLE) struct A { long a; };"),
            "a.idl:2: expected \"FINAL\", found MUTABLE\n");
  EXPECT_EQ(error_of(final + "A { @optional long a; };"),
            "a.idl:2: expected a name, found @optional\n");
  EXPECT_EQ(error_of(final + "A { sequence<long> a; };"), "a.idl:2: expected \",\", found >\n");
  EXPECT_EQ(error_of(final + "A { string<31> a; };"), "a.idl:2: expected a name, found <\n");
  EXPECT_EQ(error_of(final + "A { @key string a; };"),
            "a.idl: the key of A has more than 16 bytes\n");
  EXPECT_EQ(error_of(final + "A { @key long a; @key long long b; };"), "");
  EXPECT_EQ(error_of(final + "A { @key long a; @key long long b; @key long c; };"),
            "a.idl: the key of A has more than 16 bytes\n");
  EXPECT_EQ(error_of(final + "A { Stranger a; };"), "a.idl: no type Stranger\n");
}

TEST(Generator, MessagesOfAnotherSystemMayHaveNoBounds) {
  const std::string final = "@extensibility(FINAL) struct ";
  for (const std::string member : {"sequence<long> a;", "double a[36];", "saphira::v1::B_ a;"}) {
    const std::string members = final + "B_ { int8 b; }; " + final + "A { " + member + " };";
    EXPECT_EQ(error_of(members, true), "");
    EXPECT_NE(error_of(members), "");
  }
  EXPECT_EQ(error_of(final + "A { other::B_ a; };", true), "a.idl: no type other::B_\n");
}

}  // namespace
}  // namespace saphira
