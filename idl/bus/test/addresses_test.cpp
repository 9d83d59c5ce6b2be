// When the network side of a program is made.
#include "addresses.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace saphira::bus::internal {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Addresses::Devices on(unsigned device, const std::vector<std::string>& addresses) {
  Addresses::Devices all;
  for (const std::string& address : addresses)
    all.emplace(address, device);
  return all;
}

TEST(Addresses, OneThatIsThereIsUsedAtOnce) {
  Addresses addresses("");
  EXPECT_TRUE(addresses.due(on(2, {"10.0.0.1"}), seconds(1)));
  addresses.made();
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.1"}), seconds(2)));
  EXPECT_EQ(addresses.wait(), "");
}

TEST(Addresses, OneThatComesLaterIsUsedWhenItHasSettled) {
  Addresses addresses("");
  EXPECT_FALSE(addresses.due(on(2, {}), seconds(1)));
  EXPECT_NE(addresses.wait().find("no network address yet"), std::string::npos);
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.1"}), seconds(20)));
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.1", "10.0.1.1"}), seconds(20) + milliseconds(200)));
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.1", "10.0.1.1"}), seconds(20) + milliseconds(400)));
  EXPECT_TRUE(addresses.due(on(2, {"10.0.0.1", "10.0.1.1"}), seconds(20) + milliseconds(500)));
}

TEST(Addresses, OneThatGoesOrComesBackNeedsNothing) {
  Addresses addresses("");
  ASSERT_TRUE(addresses.due(on(2, {"10.0.0.1", "10.0.1.1"}), seconds(1)));
  addresses.made();
  EXPECT_FALSE(addresses.due(on(2, {"10.0.1.1"}), seconds(2)));
  EXPECT_FALSE(addresses.due(on(2, {}), seconds(3)));
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.1"}), seconds(4)));
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.1"}), seconds(5)));
}

TEST(Addresses, OneOnAnotherDeviceIsUsed) {
  Addresses addresses("");
  ASSERT_TRUE(addresses.due(on(2, {"10.0.0.1"}), seconds(1)));
  addresses.made();
  EXPECT_FALSE(addresses.due({}, seconds(2)));
  EXPECT_FALSE(addresses.due(on(3, {"10.0.0.1"}), seconds(6)));
  EXPECT_TRUE(addresses.due(on(3, {"10.0.0.1"}), seconds(7)));
}

TEST(Addresses, AnotherOneIsUsed) {
  Addresses addresses("");
  ASSERT_TRUE(addresses.due(on(2, {"10.0.0.1"}), seconds(1)));
  addresses.made();
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.7"}), seconds(2)));
  EXPECT_TRUE(addresses.due(on(2, {"10.0.0.7"}), seconds(3)));
  addresses.made();
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.1"}), seconds(4)));
  EXPECT_TRUE(addresses.due(on(2, {"10.0.0.1"}), seconds(5))) << "it was made without that one";
}

TEST(Addresses, WhereOneIsNamedTheOthersDoNotMatter) {
  Addresses addresses("10.0.0.2");
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.1"}), seconds(1)));
  EXPECT_EQ(addresses.wait(),
            "interface 10.0.0.2 is no address of this machine, which has 10.0.0.1: only its own "
            "programs are reached");
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.1", "10.0.0.2"}), seconds(2)));
  EXPECT_TRUE(addresses.due(on(2, {"10.0.0.1", "10.0.0.2"}), seconds(3)));
  addresses.made();
  // Its sockets went with it.
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.1"}), seconds(4)));
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.2"}), seconds(5)));
  EXPECT_TRUE(addresses.due(on(2, {"10.0.0.2"}), seconds(6)));
}

TEST(Addresses, AfterAFailureItWaits) {
  Addresses addresses("");
  ASSERT_TRUE(addresses.due(on(2, {"10.0.0.1"}), seconds(1)));
  addresses.failed(seconds(1));
  EXPECT_FALSE(addresses.due(on(2, {"10.0.0.1"}), seconds(3)));
  EXPECT_TRUE(addresses.due(on(2, {"10.0.0.1"}), seconds(6)));
}

}  // namespace
}  // namespace saphira::bus::internal
