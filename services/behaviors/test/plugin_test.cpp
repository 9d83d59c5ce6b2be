#include "behaviors/shell/plugin.hpp"

#include <gtest/gtest.h>

#include "pioneer.hpp"
#include "saphira/base/text.hpp"
#include "trouble.hpp"

namespace saphira::behaviors {
namespace {

TEST(Plugin, TheExampleRunsAmongTheOthers) {
  Registry registry = predefined();
  EXPECT_EQ(load_plugin(SAPHIRA_EXAMPLE_PLUGIN, registry),
            (std::vector<std::string>{"HoldDistance"}));
  ASSERT_NE(registry.find("HoldDistance"), nullptr);
  EXPECT_EQ(registry.find("HoldDistance")->source, SAPHIRA_EXAMPLE_PLUGIN);
  Executive executive(registry, pioneer());
  double speed = 0.0;
  for (const double range : {2.5, 0.3}) {
    for (std::uint64_t i = 1; i <= 40; ++i) {
      const Intent intent{i, true, {{"hold", "HoldDistance", 2, true, {}}}};
      Inputs inputs;
      inputs.cycle = i;
      inputs.sonars = {{3, range, true}};
      inputs.intent = &intent;
      const Output output = executive.step(inputs);
      EXPECT_EQ(output.trouble, "");
      speed = output.speed;
    }
    EXPECT_NEAR(speed, range > 1.0 ? 0.2 : -0.2, 0.1);
    executive.reset();
  }
}

TEST(Plugin, WhatIsNoPluginIsSaidToBeNone) {
  Registry registry;
  const auto message = [&](const std::string& path) {
    return test::trouble_of<UnusableFile>([&] { load_plugin(path, registry); });
  };
  EXPECT_NE(message("/nowhere/x.so").find("/nowhere/x.so: expected a plug-in of behaviors"),
            std::string::npos);
  EXPECT_NE(message("libm.so.6").find("expected a plug-in of behaviors"), std::string::npos);
  EXPECT_NE(message(SAPHIRA_OTHER_LIBRARY).find("it has no saphira_behaviors_plugin"),
            std::string::npos)
      << message(SAPHIRA_OTHER_LIBRARY);
  EXPECT_TRUE(registry.names().empty());
}

}  // namespace
}  // namespace saphira::behaviors
