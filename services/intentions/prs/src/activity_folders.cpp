#include "saphira/intentions/activity_folders.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/intentions/language.hpp"

namespace saphira::intentions {

ActivityFolders::ActivityFolders(const std::vector<std::string>& paths,
                                 std::shared_ptr<const Functions> functions, Registry base)
    : functions_(std::move(functions)), base_(std::move(base)) {
  for (const std::string& path : paths)
    if (!path.empty())
      layers_.push_back({WatchedFolder(path, ".act"), {}, false});
}

void ActivityFolders::know_behaviors(std::vector<BehaviorSignature> behaviors) {
  base_.know_behaviors(std::move(behaviors));
  retries_ = !trouble().empty();
}

/// Reads the changes in a folder; true where there are any.
bool ActivityFolders::read(Layer& layer, Reload& reload, std::vector<std::string>& changed) {
  const WatchedFolder::Changes changes = layer.folder.poll();
  const bool other = changes.any() || changes.missing != layer.missing;
  if (changes.missing && !layer.missing)
    reload.errors.push_back(layer.folder.path() + ": expected a folder of activity files");
  layer.missing = changes.missing;
  for (const std::string& name : changes.gone)
    layer.files.erase(layer.folder.path_of(name));
  for (const std::string& name : changes.changed) {
    const std::string path = layer.folder.path_of(name);
    File& file = layer.files[path];
    file.fault.clear();
    changed.push_back(path);
    try {
      file.newest = read_file(path);
    } catch (const std::runtime_error& error) {
      file.newest = file.good;
      file.fault = error.what();
    }
  }
  return other;
}

/// The activities of a folder: of each file the newest content without errors.
std::vector<Schema> ActivityFolders::compile(Layer& layer, const Registry& known,
                                             const std::vector<std::string>& changed,
                                             Reload& reload) {
  std::map<std::string, std::string> contents;
  for (const auto& [path, file] : layer.files)
    contents[path] = file.newest;
  std::set<std::string> warned;
  while (true) {
    std::vector<ActivityFile> files;
    files.reserve(contents.size());
    for (const auto& [path, content] : contents)
      files.push_back({path, content});
    Loaded loaded = load_activities(files, *functions_, known);
    std::set<std::string> wrong;
    for (const Diagnostic& trouble : loaded.troubles) {
      const std::string text = trouble.text();
      if (!trouble.error) {
        if (std::find(changed.begin(), changed.end(), trouble.file) != changed.end() &&
            warned.insert(text).second)
          reload.warnings.push_back(text);
        continue;
      }
      wrong.insert(trouble.file);
      File& file = layer.files.at(trouble.file);
      if (contents[trouble.file] != file.newest)
        continue;  // an older content, broken by another file
      file.fault += (file.fault.empty() ? "" : "\n") + text;
    }
    if (wrong.empty()) {
      for (const auto& [path, content] : contents) {
        File& file = layer.files.at(path);
        file.good = content;
        file.taken = true;
      }
      return std::move(loaded.schemas);
    }
    // Back to the last good content; without one, or if that has errors too, the file is left out.
    for (const std::string& path : wrong) {
      const File& file = layer.files.at(path);
      if (file.taken && contents[path] != file.good)
        contents[path] = file.good;
      else
        contents.erase(path);
    }
  }
}

ActivityFolders::Reload ActivityFolders::reload() {
  Reload reload;
  reload.changed = std::exchange(retries_, false);
  std::vector<std::string> changed;
  for (Layer& layer : layers_)
    reload.changed = read(layer, reload, changed) || reload.changed;
  if (!reload.changed)
    return reload;
  std::map<std::string, std::string> faults;
  for (Layer& layer : layers_)
    for (auto& [path, file] : layer.files)
      if (std::find(changed.begin(), changed.end(), path) == changed.end())
        faults[path] = std::exchange(file.fault, {});  // it may be right by now: tried again below
  Registry all = base_;
  std::map<std::string, std::pair<Schema, Origin>> wanted;
  for (Layer& layer : layers_) {
    for (Schema& schema : compile(layer, all, changed, reload)) {
      all.add(schema);
      const std::string name = normal(schema.name);
      Origin origin{schema.source, layer.files.at(schema.source).good};
      wanted.insert_or_assign(name, std::pair(std::move(schema), std::move(origin)));
    }
  }
  for (const Layer& layer : layers_)
    for (const auto& [path, file] : layer.files)
      if (!file.fault.empty() && file.fault != faults[path])
        reload.errors.push_back(file.fault +
                                (file.taken ? "\nWhat this file gave before stays in use." : ""));
  for (const auto& [name, origin] : given_)
    if (!wanted.contains(name))
      reload.removed.push_back(name);
  for (auto& [name, one] : wanted) {
    const auto before = given_.find(name);
    if (before == given_.end() || !(before->second == one.second))
      reload.taken.push_back(one.first);
  }
  given_.clear();
  for (auto& [name, one] : wanted)
    given_[name] = std::move(one.second);
  return reload;
}

std::string ActivityFolders::trouble() const {
  std::string text;
  const auto add = [&text](const std::string& what) { text += (text.empty() ? "" : "\n") + what; };
  for (const Layer& layer : layers_) {
    if (layer.missing)
      add(layer.folder.path() + ": expected a folder of activity files");
    for (const auto& [path, file] : layer.files)
      if (!file.fault.empty())
        add(file.fault);
  }
  return text;
}

std::string activities_folder() {
  return config_folder() + "/activities";
}

}  // namespace saphira::intentions
