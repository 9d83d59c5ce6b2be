#include "saphira/runtime/component.hpp"

#include "saphira/bus/program.hpp"

namespace saphira::runtime {

std::vector<Port> ports_of(const Component& component) {
  bus::NodeOptions options;
  options.name = component.name;
  bus::Node node(options, bus::make_memory_bus());
  return Shell(node, component.make).ports().table();
}

int run_component(int argc, char** argv, const Component& component) {
  return bus::run_program(argc, argv, component.name, component.effect, component.add_options,
                          [&](const bus::NodeOptions& options, const bus::Stop& stop) {
                            bus::Node node(options);
                            Shell(node, component.make).run(stop);
                            return bus::kExitOk;
                          });
}

}  // namespace saphira::runtime
