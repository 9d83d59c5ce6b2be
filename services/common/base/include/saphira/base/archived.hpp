#pragma once

/// Lists the members of a class with private state for saphira::Archive (base/archive.hpp): saved
/// and restored in this order, by their names without the underscore at the end.
#define SAPHIRA_ARCHIVE(...)             \
  template <class Archive>               \
  void archive(Archive& a) {             \
    a.listed(#__VA_ARGS__, __VA_ARGS__); \
  }
