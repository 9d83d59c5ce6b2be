#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/watched_folder.hpp"
#include "saphira/behaviors/behavior.hpp"

namespace saphira::behaviors {

/// The behavior files (*.beh) of a folder, and what they have given a registry.
class Folder {
 public:
  explicit Folder(std::string path) : folder_(std::move(path), ".beh") {}

  /// The changes that a look has found.
  struct News {
    bool changed = false;             ///< schemas came, changed or went, or the trouble is another
    std::vector<std::string> taken;   ///< files
    std::vector<std::string> faults;  ///< of files that changed: as FileError has them
    std::vector<std::string> warnings;
  };

  /// Takes what is new in the folder since the last look into `registry`. A file that is wrong
  /// changes nothing: what it gave before stays. What a file that is gone gave is taken away.
  News look(Registry& registry);

  const std::string& path() const { return folder_.path(); }
  /// The files that have mistakes now, and which mistakes; empty: none.
  std::string trouble() const;

 private:
  struct File {
    std::vector<std::string> schemas;  ///< that it has given
    std::string fault;                 ///< the first one; empty: none
  };
  void take_changed(const std::vector<std::string>& changed, Registry& registry, News& news);
  void take(const std::string& name, File& file, Registry& registry, News& news);
  std::string owner(const std::string& schema, const std::string& but) const;

  WatchedFolder folder_;
  std::map<std::string, File> files_;  ///< by name
  bool missing_ = false;
};

/// Where an executive's schemas come from: layers, of which a later one covers schemas of the same
/// name in those before it.
class Sources {
 public:
  /// Schemas that stay as they are, such as those of a plug-in.
  void add(Registry fixed);
  void add(Folder folder);

  /// Looks at the folders, and makes `registry` what the layers are now. The first look takes all.
  Folder::News look(Registry& registry);
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
  std::map<std::string, Origin> taken_;  ///< what the registry was given
};

/// The behaviors of a folder; std::runtime_error that says all that is wrong with its files.
Registry load_behaviors(const std::string& folder);

/// The folder of the shipped behaviors: config/behaviors.
std::string behaviors_folder();

}  // namespace saphira::behaviors
