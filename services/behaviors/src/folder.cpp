#include "saphira/behaviors/folder.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/behaviors/language.hpp"

namespace saphira::behaviors {

Folder::Reload Folder::reload(Registry& registry) {
  Reload reload;
  const WatchedFolder::Changes changes = folder_.poll();
  reload.changed = changes.any() || changes.missing != missing_;
  if (changes.missing && !missing_)
    reload.faults.push_back(path() + ": expected a folder of behavior files");
  missing_ = changes.missing;
  for (const std::string& name : changes.gone) {
    for (const std::string& schema : files_[name].schemas)
      registry.remove(schema);
    files_.erase(name);
    reload.gone.push_back(folder_.path_of(name));
  }
  if (changes.any())
    take_changed(changes.changed, registry, reload);
  return reload;
}

/// Includes files that had errors before, since they may be right by now. Repeats while a file is
/// accepted, since another file may have waited for its names.
void Folder::take_changed(const std::vector<std::string>& changed, Registry& registry,
                          Reload& reload) {
  std::vector<std::string> open = changed;
  std::map<std::string, std::string> before;
  for (const auto& [name, file] : files_)
    if (!file.fault.empty() && std::find(open.begin(), open.end(), name) == open.end())
      before[name] = file.fault;
  for (const auto& [name, fault] : before)
    open.push_back(name);
  std::sort(open.begin(), open.end());
  std::map<std::string, std::vector<std::string>> faults;
  for (std::size_t left = open.size() + 1; open.size() < left;) {
    left = open.size();
    std::erase_if(open, [&](const std::string& name) {
      Reload one;
      take(name, files_[name], registry, one);
      faults[name] = std::move(one.faults);
      if (!faults[name].empty())
        return false;
      std::move(one.taken.begin(), one.taken.end(), std::back_inserter(reload.taken));
      std::move(one.warnings.begin(), one.warnings.end(), std::back_inserter(reload.warnings));
      return true;
    });
  }
  for (const std::string& name : open)
    if (const auto old = before.find(name);
        old == before.end() || old->second != files_[name].fault) {
      if (!files_[name].schemas.empty())
        faults[name].back() += "\nWhat this file gave before stays in use.";
      std::move(faults[name].begin(), faults[name].end(), std::back_inserter(reload.faults));
    }
}

void Folder::take(const std::string& name, File& file, Registry& registry, Reload& reload) {
  const std::string path = folder_.path_of(name);
  const auto fault = [&](const std::string& what) {
    if (file.fault.empty())
      file.fault = what;
    reload.faults.push_back(what);
  };
  file.fault.clear();
  Compiled compiled;
  try {
    compiled = compile(read_file(path), path);
  } catch (const std::runtime_error& error) {
    fault(error.what());
    return;
  }
  for (const FileError& warning : compiled.warnings)
    reload.warnings.emplace_back(warning.what());
  for (const FileError& one : compiled.errors)
    fault(one.what());
  for (const Schema& schema : compiled.schemas)
    if (const std::string other = owner(schema.name, name); !other.empty()) {
      std::string what = path;
      what.append(": the behavior \"").append(schema.name).append("\" is in ").append(other);
      fault(what.append(" already"));
    }
  if (!file.fault.empty())
    return;
  std::vector<std::string> names;
  for (Schema& schema : compiled.schemas) {
    names.push_back(schema.name);
    registry.add(std::move(schema));
  }
  for (const std::string& old : file.schemas)
    if (std::find(names.begin(), names.end(), old) == names.end())
      registry.remove(old);
  file.schemas = std::move(names);
  reload.taken.push_back(path);
}

std::string Folder::owner(const std::string& schema, const std::string& but) const {
  for (const auto& [name, file] : files_)
    if (name != but &&
        std::find(file.schemas.begin(), file.schemas.end(), schema) != file.schemas.end())
      return name;
  return {};
}

std::string Folder::trouble() const {
  std::string out = missing_ ? path() + ": expected a folder of behavior files" : "";
  for (const auto& [name, file] : files_)
    if (!file.fault.empty())
      out += (out.empty() ? "" : "\n") + file.fault;
  return out;
}

void Sources::add(Registry fixed) {
  layers_.push_back({std::move(fixed), {}});
}

void Sources::add(Folder folder) {
  layers_.push_back({{}, std::move(folder)});
}

Folder::Reload Sources::reload(Registry& registry) {
  Folder::Reload all;
  for (Layer& layer : layers_) {
    if (!layer.folder)
      continue;
    Folder::Reload reload = layer.folder->reload(layer.schemas);
    all.changed = all.changed || reload.changed;
    all.taken.insert(all.taken.end(), reload.taken.begin(), reload.taken.end());
    all.gone.insert(all.gone.end(), reload.gone.begin(), reload.gone.end());
    all.faults.insert(all.faults.end(), reload.faults.begin(), reload.faults.end());
    all.warnings.insert(all.warnings.end(), reload.warnings.begin(), reload.warnings.end());
  }
  std::map<std::string, Origin> now;
  for (std::size_t i = 0; i < layers_.size(); ++i)
    for (const std::string& name : layers_[i].schemas.names())
      now[name] = {i, layers_[i].schemas.find(name)->revision};
  for (const auto& [name, origin] : taken_)
    if (!now.contains(name))
      registry.remove(name);
  for (const auto& [name, origin] : now)
    if (const auto before = taken_.find(name); before == taken_.end() || before->second != origin)
      registry.add(*layers_[origin.layer].schemas.find(name));
  all.changed = all.changed || now != taken_;
  taken_ = std::move(now);
  return all;
}

std::string Sources::trouble() const {
  std::string out;
  for (const Layer& layer : layers_)
    if (layer.folder)
      if (const std::string one = layer.folder->trouble(); !one.empty())
        out += (out.empty() ? "" : "\n") + one;
  return out;
}

Registry load_behaviors(const std::string& folder) {
  Registry registry;
  const Folder::Reload reload = Folder(folder).reload(registry);
  if (!reload.faults.empty()) {
    throw std::runtime_error(joined(reload.faults, "\n"));
  }
  return registry;
}

std::string behaviors_folder() {
  return config_folder() + "/behaviors";
}

}  // namespace saphira::behaviors
