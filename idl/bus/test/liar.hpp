#pragma once

#include <memory>
#include <string>

#include "saphira/bus/node.hpp"

namespace saphira::bus::test {

/// A member whose program was altered: it makes writers and readers that its role does not allow.
/// Its own Fast DDS lets it, since each is said to be of a topic that it may have.
class Liar {
 public:
  Liar(const NodeOptions& options, std::string allowed_topic);
  ~Liar();

  /// A writer or reader of the topic, as everybody else's. False where it could not be made.
  bool add(const std::string& topic, bool writes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saphira::bus::test
