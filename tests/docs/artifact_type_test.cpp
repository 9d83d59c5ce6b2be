// docs/add-an-artifact-type.md, followed on a copy of the files that it names.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "installed.hpp"
#include "pages.hpp"
#include "saphira/base/text.hpp"

namespace saphira {
namespace {

namespace fs = std::filesystem;

/// A file of the page, and the place for the lines that the page adds.
struct Step {
  const char* file;
  const char* place;  ///< the newest type there
  const char* table;  ///< what stands before the table's size; empty: it has none
  bool behind = false;
};
constexpr Step kType{"services/common/lps/include/saphira/lps/artifact.hpp", "  zone ", ""};
constexpr Step kTraits{"services/common/maps/include/saphira/maps/artifact_traits.hpp",
                       "    {.type = lps::PointType::zone", "<ArtifactTraits, "};
constexpr Step kOnBus{"idl/perception.idl", "ARTIFACT_ZONE", "", true};
constexpr Step kPair{"services/common/lps/shell/convert.hpp", "    {lps::PointType::zone",
                     "v1::ArtifactType, "};

/// The named files, in a folder before that of the sources.
class Copy {
 public:
  Copy() {
    for (const Step& step : {kType, kTraits, kOnBus, kPair})
      write(step.file, read_file(test::source(step.file)));
  }

  void follow(const Step& step) {
    std::string added;
    for (const test::Block& block : test::blocks_of("docs/add-an-artifact-type.md"))
      if (block.file == step.file)
        added += block.text;
    ASSERT_FALSE(added.empty()) << "the page adds nothing to " << step.file;
    std::string text = read_file(folder_.path(step.file));
    const std::string place = step.place;
    ASSERT_NE(text.find(place), std::string::npos) << step.file;
    if (step.behind)
      text.insert(text.find(place) + place.size(), ",\n" + added);
    else
      text.insert(text.find(place), added);
    if (const std::string table = step.table; !table.empty()) {
      ASSERT_NE(text.find(table), std::string::npos) << step.file;
      const std::size_t at = text.find(table) + table.size();
      const std::string size = text.substr(at, text.find('>', at) - at);
      text.replace(at, size.size(), std::to_string(std::stoi(size) + 1));
    }
    write(step.file, text);
  }

  void generate() {
    EXPECT_EQ(said(test::Installed::build_folder() + "/idl/saphira-idl-generate " +
                   folder_.path("generated") + " " + test::source("idl/common.idl") + " " +
                   folder_.path("idl/perception.idl")),
              "");
  }

  /// The messages of the compiler about these lines; empty where they are right.
  std::string compile(const std::string& lines) {
    write("all.cpp", lines);
    std::string command =
        test::Installed::cached("CMAKE_CXX_COMPILER") + " -std=c++20 -fsyntax-only";
    for (const std::string& root : {folder_.path(), test::source("")})
      for (const char* const folder :
           {"/services/common/lps/include", "/services/common/maps/include",
            "/services/common/geometry/include", "/services/common/base/include",
            "/services/common"})
        command += " -I" + root + folder;
    return said(command + " -isystem " + folder_.path("generated") + " -isystem " +
                test::Installed::build_folder() + "/idl/generated -isystem /usr/include/eigen3 " +
                folder_.path("all.cpp"));
  }

 private:
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(folder_.path(name)).parent_path());
    std::ofstream(folder_.path(name)) << text;
  }
  std::string said(const std::string& command) const {
    fs::remove(folder_.path("said"));
    test::Process process({"/bin/sh", "-c", command}, folder_.path("said"));
    process.wait(std::chrono::minutes(2));
    return process.output();
  }

  const test::TempDir folder_;
};

TEST(ArtifactType, CompilesOnceEachStepOfThePageIsDone) {
  const std::string traits = "#include \"saphira/maps/artifact_traits.hpp\"\n";
  const std::string convert = "#include \"lps/shell/convert.cpp\"\n";
  Copy copy;
  ASSERT_NO_FATAL_FAILURE(copy.follow(kType));
  std::string said = copy.compile(traits);
  EXPECT_NE(said.find("a type of artifacts has no traits"), std::string::npos) << said;
  ASSERT_NO_FATAL_FAILURE(copy.follow(kTraits));
  ASSERT_NO_FATAL_FAILURE(copy.follow(kOnBus));
  copy.generate();
  said = copy.compile(convert);
  EXPECT_NE(said.find("an enumerator of ours has no pair"), std::string::npos) << said;
  ASSERT_NO_FATAL_FAILURE(copy.follow(kPair));
  EXPECT_EQ(copy.compile(traits + convert), "");
}

}  // namespace
}  // namespace saphira
