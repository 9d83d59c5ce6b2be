#pragma once

#include <string>

#include "process.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/authority.hpp"
#include "trouble.hpp"

namespace saphira::security::test {

constexpr std::int64_t kNow = 1'800'000'000;
constexpr std::int64_t kDay = 86400;

/// A folder for a test's authority, with the shipped roles.
class Folder {
 public:
  std::string path(const std::string& file = "authority") const { return folder_.path(file); }
  Authority authority(const std::string& site = "office",
                      const std::string& file = "authority") const {
    const std::string roles = config_folder() + "/security/roles.yaml";
    return Authority::make(path(file), site, read_file(roles), roles, kNow);
  }

 private:
  const saphira::test::TempDir folder_;
};

using saphira::test::trouble;

inline bool says(const std::string& text, const std::string& part) {
  return saphira::test::has(text, part);
}

}  // namespace saphira::security::test
