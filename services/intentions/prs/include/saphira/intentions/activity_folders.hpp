#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "saphira/base/watched_folder.hpp"
#include "saphira/intentions/functions.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// The activity files (*.act) of folders. A later folder covers activities of the same name in
/// earlier ones. A file with an error changes nothing: its earlier activities stay.
class ActivityFolders {
 public:
  /// An empty path is none. base: the schemas that activities may name besides each other.
  ActivityFolders(const std::vector<std::string>& paths, std::shared_ptr<const Functions> functions,
                  Registry base);

  /// The changes that a look has found.
  struct Reload {
    bool changed = false;              ///< also where only the errors changed
    std::vector<Schema> taken;         ///< new, or another than before
    std::vector<std::string> removed;  ///< activities that are gone
    std::vector<std::string> errors;   ///< of files that changed: file, line, column, caret
    std::vector<std::string> warnings;
  };
  Reload reload();

  /// From now on a file that names another behavior has an error. The next reload() tries files
  /// with errors again: their behavior may have come later than they.
  void know_behaviors(std::vector<BehaviorSignature> behaviors);
  /// The files with errors, and the errors; empty: none.
  std::string trouble() const;

 private:
  struct File {
    std::string newest;  ///< content
    std::string good;    ///< newest accepted content
    bool taken = false;  ///< a content was accepted
    std::string fault;   ///< of `newest`; empty: none
  };
  struct Layer {
    WatchedFolder folder;
    std::map<std::string, File> files;  ///< by path
    bool missing = false;
  };
  struct Origin {
    std::string file;
    std::string content;

    bool operator==(const Origin&) const = default;
  };
  bool read(Layer& layer, Reload& reload, std::vector<std::string>& changed);
  std::vector<Schema> compile(Layer& layer, const Registry& known,
                              const std::vector<std::string>& changed, Reload& reload);

  std::vector<Layer> layers_;
  std::shared_ptr<const Functions> functions_;
  Registry base_;
  bool retries_ = false;
  std::map<std::string, Origin> given_;  ///< by name: the origin of each activity
};

/// The folder of the shipped activities: config/activities.
std::string activities_folder();

}  // namespace saphira::intentions
