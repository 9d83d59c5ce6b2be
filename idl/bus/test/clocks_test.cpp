// Writers on machines whose clocks are not this one's.
#include "harness.hpp"
#include "raw_writer.hpp"

namespace saphira::bus::test {
namespace {

TEST(Clocks, ARequestCountsHoweverFarApartTheClocksAre) {
  Node node(node_options("test", robot("c")));
  auto reader = node.reader(topics::kEstopReset);
  RawWriter writer(robot("c"), topics::kEstopReset.name, "saphira::v1::Request", false);
  ASSERT_TRUE(eventually(node, [&] { return writer.matched() && reader.matched() == 1; }));
  for (const double ahead : {0.0, -3600.0, -3.0, 3.0, 3600.0}) {
    ASSERT_TRUE(writer.write(bytes_of_request("reset"), ahead));
    const auto came = take_at_least(node, reader, 1);
    ASSERT_EQ(came.size(), 1U) << ahead;
    EXPECT_EQ(came[0].data.functor, "reset");
    EXPECT_NEAR(came[0].info.age, -ahead, 2.0);
  }
}

}  // namespace
}  // namespace saphira::bus::test
