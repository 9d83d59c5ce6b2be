#include "saphira/base/places.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "robot.hpp"
#include "saphira/base/robot_name.hpp"

namespace saphira::c {
namespace fs = std::filesystem;

namespace {

/// The folder of this library. The prefix of the build or installation is one to three levels up.
fs::path above_library() {
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&above_library), &info) == 0 ||
      info.dli_fname == nullptr)
    return {};
  std::error_code error;
  return fs::canonical(info.dli_fname, error).parent_path();
}

}  // namespace

std::string beside_library(const std::string& path) {
  std::error_code error;
  // lib/ of a build, lib/saphira/, and lib/x86_64-linux-gnu/saphira/ of Debian.
  for (const fs::path& prefix :
       {above_library() / "..", above_library() / "../..", above_library() / "../../.."})
    if (fs::exists(prefix / path, error))
      return (prefix / path).lexically_normal().string();
  return (above_library() / ".." / path).lexically_normal().string();
}

std::string configuration() {
  const std::string installed = beside_library("share/saphira");
  std::error_code error;
  if (fs::is_directory(fs::path(installed) / "robots", error))
    return installed;
  return config_folder();
}

std::string robot_of_environment() {
  const char* const name = std::getenv("SAPHIRA_ROBOT");
  return name == nullptr || *name == '\0' ? std::string() : std::string(kOnBus) + name;
}

std::unique_ptr<Robot> robot_at(const std::string& address, Say say) {
  if (address.starts_with(kOnBus))
    return bus_robot(address.substr(std::string_view(kOnBus).size()), std::move(say));
  return direct_robot(address, std::move(say));
}

// The bus is a separate part: a program with a robot of its own needs no DDS.
std::unique_ptr<Robot> bus_robot(const std::string& name, Say say) {
  if (const std::string trouble = trouble_of_robot(name); !trouble.empty())
    throw std::invalid_argument("SAPHIRA_ROBOT: " + trouble);
  const std::string path = (above_library() / "libsfx-bus.so").string();
  void* const part = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (part == nullptr)
    throw std::runtime_error("the bus cannot be joined: " + std::string(::dlerror()));
  const auto make = reinterpret_cast<MakeBusRobot>(::dlsym(part, kBusRobot));
  if (make == nullptr)
    throw std::runtime_error("the bus cannot be joined: " + path + " is of another version");
  return std::unique_ptr<Robot>(make(name, std::move(say)));
}

}  // namespace saphira::c
