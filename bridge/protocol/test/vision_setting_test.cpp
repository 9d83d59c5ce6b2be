#include "saphira/protocol/vision_setting.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <tuple>

namespace saphira::protocol {
namespace {

using What = VisionSetting::What;

// Manual 9.1.
TEST(VisionSetting, IsReadFromTheManualsText) {
  for (const auto& [text, what, channel, value] : {std::tuple{"pioneer_a_mode=0", What::mode, 0, 0},
                                                   {"pioneer_c_mode=2", What::mode, 2, 2},
                                                   {"line_bottom_row=0", What::bottom_row, 0, 0},
                                                   {"line_num_slices=10", What::slices, 0, 10},
                                                   {"line_slice_size=1", What::slice_size, 0, 1},
                                                   {"line_min_mass=8", What::minimum_mass, 0, 8}}) {
    const VisionSetting setting = parse_vision_setting(text);
    EXPECT_EQ(setting.what, what) << text;
    EXPECT_EQ(setting.channel, channel) << text;
    EXPECT_EQ(setting.value, value) << text;
  }
  EXPECT_EQ(parse_vision_setting("pioneer_b_color=light-blue").color, "light-blue");
}

TEST(VisionSetting, OtherTextIsRefusedWithTheExpectedForm) {
  for (const char* const text :
       {"", "=", "hello", "pioneer_a_mode", "pioneer_a_mode=", "pioneer_a_mode=3",
        "pioneer_a_mode=-1", "pioneer_d_mode=0", "pioneer_A_mode=0", "pioneer_a_mode=1 ",
        "pioneer_a_size=1", "pioneer_a_color=", "pioneer_a_color=a b", "line_slice_size=0",
        "line_min_mass=-1", "line_min_mass=2000", "line_top_row=1", "pioneer_"})
    EXPECT_THROW(parse_vision_setting(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace saphira::protocol
