// Programs with other vendors' DDS generate their types from the same files.
#include <gtest/gtest.h>

#include <filesystem>

#include "process.hpp"

namespace saphira {
namespace {

namespace fs = std::filesystem;

bool there_is(const std::string& program) {
  const test::TempDir folder;
  test::Process which({"/bin/sh", "-c", "command -v " + program}, folder.path("which"));
  return which.wait() == 0;
}

TEST(Contract, CompilesWithCyclonesIdlc) {
  if (!there_is("idlc"))
    GTEST_SKIP() << "no idlc: apt-get install cyclonedds-tools";
  const std::string idl = test::source("idl");
  const test::TempDir folder;
  int files = 0;
  for (const auto& entry : fs::directory_iterator(idl)) {
    if (entry.path().extension() != ".idl")
      continue;
    ++files;
    const std::string name = entry.path().stem().string();
    test::Process idlc({"/usr/bin/env", "-C", folder.path(), "idlc", "-I" + idl, entry.path()},
                       folder.path(name + ".log"));
    EXPECT_EQ(idlc.wait(), 0) << entry.path() << ":\n" << idlc.output();
    // A warning also fails: the next version may refuse it.
    EXPECT_EQ(idlc.output(), "") << entry.path();
    EXPECT_TRUE(fs::exists(folder.path(name + ".c"))) << entry.path();
  }
  EXPECT_GE(files, 11);
}

}  // namespace
}  // namespace saphira
