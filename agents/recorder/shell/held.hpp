#pragma once

#include <fstream>
#include <string>

#include "saphira/base/descriptor.hpp"

namespace saphira::recorder {

/// Holds the name of a recording, so that no second recorder writes there. A recording that is
/// there stays until something is recorded.
class Held {
 public:
  /// std::invalid_argument where another recorder writes it, or where something is there that would
  /// be lost.
  Held(const std::string& file, bool overwrite);
  /// A new recording that has not taken its place is removed.
  ~Held();

  std::ostream& out() { return out_; }
  /// The written part takes its place, once. std::runtime_error where it cannot.
  void keep();

 private:
  /// None: there is no such file.
  Descriptor locked(const std::string& path, int flags) const;

  const std::string file_;
  const std::string new_;
  Descriptor lock_;
  Descriptor before_;  ///< the lock of a recording that is there
  bool is_kept_ = false;
  std::ofstream out_;
};

}  // namespace saphira::recorder
