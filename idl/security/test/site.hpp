#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/authority.hpp"

namespace saphira::security::test {

constexpr std::int64_t kNow = 1'800'000'000;
constexpr std::int64_t kDay = 86400;

/// A folder for a test's authority, with the shipped roles.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("saphira-security-" + name + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path(const std::string& file = "authority") const { return (path_ / file).string(); }
  Authority authority(const std::string& site = "office",
                      const std::string& file = "authority") const {
    const std::string roles = config_folder() + "/security/roles.yaml";
    return Authority::make(path(file), site, read_file(roles), roles, kNow);
  }

 private:
  const std::filesystem::path path_;
};

/// The message of the exception that f() throws; empty where it throws none.
template <class F>
std::string trouble(F&& f) {
  try {
    f();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

inline bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace saphira::security::test
