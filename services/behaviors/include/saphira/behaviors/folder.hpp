#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/watched_folder.hpp"
#include "saphira/behaviors/behavior.hpp"

namespace saphira::behaviors {

/// The behavior files (*.beh) of a folder, and the schemas that they gave to a registry.
class Folder {
 public:
  explicit Folder(std::string path) : folder_(std::move(path), ".beh") {}

  /// The changes that a look has found.
  struct Reload {
    bool changed = false;             ///< schemas came, changed or went, or the errors changed
    std::vector<std::string> taken;   ///< files
    std::vector<std::string> gone;    ///< likewise
    std::vector<std::string> faults;  ///< of changed files: as FileError has them
    std::vector<std::string> warnings;
  };

  /// Takes the changes in the folder since the last look into `registry`. A file with an error
  /// changes nothing: its earlier schemas stay. The schemas of a removed file are removed.
  Reload reload(Registry& registry);

  const std::string& path() const { return folder_.path(); }
  /// The files with errors, and the errors; empty: none.
  std::string trouble() const;

 private:
  struct File {
    std::vector<std::string> schemas;  ///< given to the registry
    std::string fault;                 ///< the first one; empty: none
  };
  void take_changed(const std::vector<std::string>& changed, Registry& registry, Reload& reload);
  void take(const std::string& name, File& file, Registry& registry, Reload& reload);
  std::string owner(const std::string& schema, const std::string& but) const;

  WatchedFolder folder_;
  std::map<std::string, File> files_;  ///< by name
  bool missing_ = false;
};

/// The sources of an executive's schemas: layers. A later layer covers schemas of the same name in
/// earlier ones.
class Sources {
 public:
  /// Fixed schemas, such as those of a plug-in.
  void add(Registry fixed);
  void add(Folder folder);

  /// Looks at the folders, and updates `registry` from the layers. The first look takes all.
  Folder::Reload reload(Registry& registry);
  std::string trouble() const;

 private:
  struct Layer {
    Registry schemas;
    std::optional<Folder> folder;
  };
  struct Origin {
    std::size_t layer = 0;
    std::uint64_t revision = 0;

    bool operator==(const Origin&) const = default;
  };
  std::vector<Layer> layers_;
  std::map<std::string, Origin> taken_;  ///< origin of the registry's schemas
};

/// The behaviors of a folder; std::runtime_error with all errors of its files.
Registry load_behaviors(const std::string& folder);

/// The folder of the shipped behaviors: config/behaviors.
std::string behaviors_folder();

}  // namespace saphira::behaviors
