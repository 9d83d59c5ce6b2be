#include "saphira/base/places.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"

namespace saphira {

namespace fs = std::filesystem;

std::string program_folder() {
  return fs::read_symlink("/proc/self/exe").parent_path().string();
}

std::string config_folder() {
  const fs::path bin = program_folder();
  // Installed: bin/ and share/saphira/ are siblings. Built: build/<preset>/bin in the source tree.
  for (const fs::path& config :
       {bin / "../share/saphira", bin / "../../../config", fs::path(SAPHIRA_SOURCE_CONFIG)}) {
    std::error_code error;
    if (fs::is_directory(config / "robots", error))
      return fs::canonical(config).string();
  }
  throw std::runtime_error("no configuration: expected " + (bin / "../share/saphira").string() +
                           " (installed) or the source tree's config/");
}

std::string user_folder() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && *config != 0)
    return std::string(config) + "/saphira";
  const char* const home = std::getenv("HOME");
  return home == nullptr || *home == 0 ? "" : std::string(home) + "/.config/saphira";
}

std::string folder_of(const std::string& file) {
  const std::string folder = fs::path(file).parent_path();
  return folder.empty() ? "." : folder;
}

std::vector<std::string> names_in(const std::string& folder, const std::string& extension) {
  std::error_code error;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == extension && !entry.path().filename().string().starts_with('.'))
      names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string find_file(const std::string& folder, const std::string& name,
                      const std::string& extension) {
  std::error_code error;
  if (fs::is_regular_file(name, error))
    return name;
  for (const fs::path& path : {fs::path(folder) / name, fs::path(folder) / (name + extension)})
    if (fs::is_regular_file(path, error))
      return path.string();
  if (fs::exists(name, error))
    throw std::invalid_argument(name + ": expected a file, found " +
                                (fs::is_directory(name, error) ? "a folder" : "a device"));
  if (name.find('/') != std::string::npos) {
    const fs::path path(name);
    const std::string meant = guess(path.stem().string(), names_in(folder_of(name), extension));
    throw std::invalid_argument(
        name + ": there is no such file" +
        (meant.empty()
             ? ""
             : ": did you mean " + (path.parent_path() / meant).string() + extension + "?"));
  }
  const std::vector<std::string> names = names_in(folder, extension);
  throw std::invalid_argument("no \"" + name + "\" in " + folder +
                              did_you_mean(name, names, ": expected a file, or a shipped one.") +
                              " There are: " + joined(names, " "));
}

}  // namespace saphira
