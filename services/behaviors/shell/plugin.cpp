#include "behaviors/shell/plugin.hpp"

#include <dlfcn.h>

#include "saphira/base/text.hpp"
#include "saphira/behaviors/plugin.hpp"

namespace saphira::behaviors {
namespace {

void* symbol(void* library, const char* name, const std::string& path) {
  void* const found = dlsym(library, name);
  if (found == nullptr)
    throw UnusableFile(path + ": expected a plug-in of behaviors; it has no " + name);
  return found;
}

}  // namespace

std::vector<std::string> load_plugin(const std::string& path, Registry& registry) {
  // Without a slash the loader would look in the system's folders.
  const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const why = dlerror();
    throw UnusableFile(path + ": expected a plug-in of behaviors: " +
                       (why == nullptr ? "it cannot be loaded" : why));
  }
  const int version = *static_cast<const int*>(symbol(library, "saphira_behaviors_plugin", path));
  if (version != kPluginVersion)
    throw UnusableFile(path + ": expected a plug-in of version " + std::to_string(kPluginVersion) +
                       ", found version " + std::to_string(version));
  const auto enter =
      reinterpret_cast<void (*)(Registry&)>(symbol(library, "saphira_register_behaviors", path));
  Registry added;
  enter(added);
  std::vector<std::string> names = added.names();
  for (const std::string& name : names) {
    Schema schema = *added.find(name);
    schema.source = path;
    if (!schema.make) {
      std::string what = path;
      what.append(": the behavior \"").append(name).append("\" has no way to be made");
      throw UnusableFile(what);
    }
    registry.add(std::move(schema));
  }
  return names;
}

}  // namespace saphira::behaviors
