// A third-party plug-in, from the installed tree only: installed, configured, built, and loaded by
// the installed service.

#include <gtest/gtest.h>

#include <algorithm>

#include "installed.hpp"
#include "node_options.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira {
namespace {

TEST(ExamplePlugin, IsBuiltFromTheInstalledTreeAndLoadedByTheService) {
  const test::Installed installed;
  const std::string build = installed.build("services/behaviors/examples/hold_distance");
  if (HasFatalFailure())
    return;
  // It needs only a pure library: the bus belongs to the service.
  const std::string entries = read_file(build + "/CMakeCache.txt");
  EXPECT_NE(entries.find("saphira_DIR:PATH=" + installed.prefix()), std::string::npos);
  EXPECT_EQ(entries.find("fastrtps_DIR"), std::string::npos);

  const bus::NodeOptions options = test::node_options("reader", test::unique_robot());
  const std::map<std::string, std::string> environment = {{"SAPHIRA_ROBOT", options.robot},
                                                          {"SAPHIRA_DOMAIN", test::domain()}};
  const std::string plugin = build + "/hold_distance.so";
  test::Process service({installed.program("saphira-behaviors"), "--plugin", plugin},
                        installed.path("service.log"), environment);
  bus::Node node(options);
  auto schemas = node.reader(bus::topics::kBehaviorSchemas);
  std::optional<v1::BehaviorSchemas> told;
  ASSERT_TRUE(test::wait_until([&] {
    node.wait(std::chrono::milliseconds(10));
    if (auto newest = schemas.take_newest())
      told = std::move(newest);
    return told.has_value() || !service.running();
  })) << service.output();
  ASSERT_TRUE(told) << service.output();
  const auto found = std::ranges::find(
      told->schemas, "HoldDistance", [](const v1::BehaviorSchema& schema) { return schema.name; });
  ASSERT_NE(found, told->schemas.end());
  EXPECT_EQ(found->source, plugin);
  EXPECT_EQ(found->parameters.size(), 2U);
  EXPECT_EQ(found->rules.size(), 3U);
}

}  // namespace
}  // namespace saphira
