#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "saphira/runtime/shell.hpp"

namespace saphira::runtime {

/// Services on one in-memory bus, stepped in the caller's thread.
class Composition {
 public:
  /// `options`: those of each service, but for its name.
  Composition(bus::NodeOptions options, std::shared_ptr<bus::MemoryBus> memory)
      : options_(std::move(options)), memory_(std::move(memory)) {}

  /// Throws the service's exceptions for its options and files.
  void add(const std::string& name, const Shell::Make& make) {
    options_.name = name;
    auto node = std::make_unique<bus::Node>(options_, memory_);
    auto shell = std::make_unique<Shell>(*node, make);
    parts_.push_back({std::move(node), std::move(shell)});
  }

  /// Each service steps the cycle that is due. False where none is.
  bool advance() {
    bool stepped = false;
    for (const Part& part : parts_)
      stepped = part.shell->advance() || stepped;
    return stepped;
  }
  /// Without due steps: requests, files and status.
  void idle() {
    for (const Part& part : parts_)
      part.shell->idle();
  }

  /// Of its services, in order: for each f(service).
  template <class F>
  void each(F&& f) {
    for (const Part& part : parts_)
      f(part.shell->service());
  }

 private:
  struct Part {
    std::unique_ptr<bus::Node> node;
    std::unique_ptr<Shell> shell;
  };

  bus::NodeOptions options_;
  std::shared_ptr<bus::MemoryBus> memory_;
  std::vector<Part> parts_;
};

}  // namespace saphira::runtime
