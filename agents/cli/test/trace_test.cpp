#include "saphira/cli/trace.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "saphira/base/text.hpp"
#include "trouble.hpp"

namespace saphira::cli {
namespace {

const std::string kHeader =
    "cycle,x,y,th,velocity,rotation_velocity,set_velocity,set_heading,set_rotation_velocity,"
    "clearance,contacts\n";
const std::string kFirst = "1,1,2,0.5,0,0,0,0,0,0.75,0\n";
const std::string kSecond = "2,4,6,0.5,0,0,0,0,0,0.25,1\n";
const std::string kThird = "3,4,7,0.5,0,0,0,0,0,0.5,1\n";

TEST(Trace, SumsUpTheDrive) {
  const Track track = evaluate_trace(kHeader + kFirst + kSecond + kThird, 100, "t");
  EXPECT_EQ(track.cycles, 3U);
  EXPECT_DOUBLE_EQ(track.path, 6.0);
  EXPECT_DOUBLE_EQ(track.min_clearance, 0.25);
  EXPECT_EQ(track.contacts, 1U);
}

TEST(Trace, IsCutAtTheCycle) {
  const Track track = evaluate_trace(kHeader + kFirst + kSecond + kThird, 2, "t");
  EXPECT_EQ(track.cycles, 2U);
  EXPECT_DOUBLE_EQ(track.path, 5.0);
  EXPECT_EQ(track.hash, evaluate_trace(kHeader + kFirst + kSecond, 2, "t").hash);
  EXPECT_NE(track.hash, evaluate_trace(kHeader + kFirst + kSecond + kThird, 3, "t").hash);
}

TEST(Trace, HashIsFnv1a64OfTheLines) {
  // The published offset basis, then the definition written out once more.
  EXPECT_EQ(evaluate_trace(kHeader, 9, "t").hash, "cbf29ce484222325");
  std::uint64_t value = 0xcbf29ce484222325ULL;
  for (const char c : kFirst) {
    value ^= static_cast<unsigned char>(c);
    value *= 0x100000001b3ULL;
  }
  char text[17];
  snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  EXPECT_EQ(evaluate_trace(kHeader + kFirst, 9, "t").hash, text);
}

TEST(Trace, OneChangedDigitChangesTheHash) {
  std::string other = kSecond;
  other[other.find("0.25")] = '1';
  EXPECT_NE(evaluate_trace(kHeader + kFirst + kSecond, 9, "t").hash,
            evaluate_trace(kHeader + kFirst + other, 9, "t").hash);
}

TEST(Trace, ALineThatIsBeingWrittenIsLeftOut) {
  const Track track = evaluate_trace(kHeader + kFirst + kSecond + "3,4,7", 100, "t");
  EXPECT_EQ(track.cycles, 2U);
}

TEST(Trace, TheCutCountsInTheLastConnection) {
  // The client left and connected again: the robot stands at the same place.
  const std::string text = kHeader + kFirst + kSecond + kThird + kHeader +
                           "1,4,7,0,0,0,0,0,0,2,1\n" + "2,4,8,0,0,0,0,0,0,2,2\n" +
                           "3,4,9,0,0,0,0,0,0,2,2\n";
  const Track track = evaluate_trace(text, 2, "t");
  EXPECT_EQ(track.cycles, 2U);
  EXPECT_DOUBLE_EQ(track.path, 7.0);
  EXPECT_EQ(track.contacts, 2U);
}

TEST(Trace, ContactsAddUpOverARestartOfTheSimulator) {
  const std::string text = kHeader + kFirst + kSecond + kHeader + kFirst + kSecond;
  EXPECT_EQ(evaluate_trace(text, 9, "t").contacts, 2U);
}

TEST(Trace, AnEmptyOneHasNoClearance) {
  EXPECT_TRUE(std::isnan(evaluate_trace("", 9, "t").min_clearance));
}

TEST(Trace, WhatIsNoTraceIsRefusedWithItsPlace) {
  for (const std::string bad : {"1,2,3\n", "a,1,1,1,1,1,1,1,1,1,1\n", "1,1,1,1,1,1,1,1,1,1,1,1\n",
                                "1,1,1,1,1,1,1,1,1,1,\n", "\n"}) {
    std::string text = kHeader + kFirst;
    text += bad;
    EXPECT_TRUE(test::trouble_of<FileError>([&] {
                  evaluate_trace(text, 9, "t.csv");
                }).starts_with("t.csv:3:"))
        << bad;
  }
}

TEST(Summary, HasTheKeys) {
  Summary summary;
  summary.arrived = true;
  summary.time = 12.3;
  summary.track = evaluate_trace(kHeader + kFirst + kSecond, 2, "t");
  summary.late_cycles = 4;
  summary.speed_factor = 300.25;
  const std::string text = to_json(summary);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json.size(), 9U);
  EXPECT_EQ(json.at("arrived"), true);
  EXPECT_DOUBLE_EQ(json.at("time_s"), 12.3);
  EXPECT_DOUBLE_EQ(json.at("path_m"), 5.0);
  EXPECT_DOUBLE_EQ(json.at("min_clearance_m"), 0.25);
  EXPECT_EQ(json.at("contacts"), 1);
  EXPECT_EQ(json.at("cycles"), 2);
  EXPECT_EQ(json.at("late_cycles"), 4);
  EXPECT_EQ(json.at("trajectory_hash"), summary.track.hash);
  EXPECT_DOUBLE_EQ(json.at("speed_factor"), 300.25);
}

TEST(Summary, AnUnknownSpeedIsNotSaid) {
  Summary summary;
  summary.speed_factor = 2.5;
  EXPECT_NE(to_text(summary).find("(2.50 x real time)"), std::string::npos);
  summary.speed_factor = 0.0;  // it was interrupted
  EXPECT_EQ(to_text(summary).find("real time"), std::string::npos);
}

TEST(Summary, WithoutATraceIsStillJson) {
  EXPECT_TRUE(nlohmann::json::parse(to_json({})).contains("min_clearance_m"));
  Summary summary;
  summary.track = evaluate_trace("", 0, "t");
  EXPECT_TRUE(nlohmann::json::parse(to_json(summary)).at("min_clearance_m").is_null());
}

}  // namespace
}  // namespace saphira::cli
