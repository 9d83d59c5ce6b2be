#pragma once

#include <string>

namespace saphira::test {

/// A small disk of this test, which can be full: a tmpfs at an empty folder, in a mount namespace
/// of this process. It goes with the process.
class SmallDisk {
 public:
  /// `folder` outlives the processes of the test.
  explicit SmallDisk(std::string folder);

  /// False where this process may not mount anything: then the test is skipped.
  bool works() const { return works_; }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  /// Nothing more can be written.
  void fill() const;
  void make_room() const;

 private:
  std::string folder_;
  bool works_;
};

}  // namespace saphira::test
