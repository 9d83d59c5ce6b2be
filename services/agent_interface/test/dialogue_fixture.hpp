#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "process.hpp"
#include "saphira/agent_interface/dialogue.hpp"
#include "saphira/base/text.hpp"

namespace saphira::agent_interface {

/// A corridor with two named offices, and a nameless doorway.
inline constexpr const char* kMap = R"(
CORRIDOR (1) 5000, 1000, 0, 10000, 2000 "upper corridor"
OFFICE (231) 3000, 4000, 0, 4000, 4000 "EJ-231"
DOOR (1231) 3000, 2000, -90, 900 "EJ-231"
OFFICE (233) 7000, 4000, 0, 4000, 4000 "EJ-233"
DOOR (1233) 7000, 2000, -90, 900 "EJ-233"
DOOR (1235) 3000, 0, 90, 900
)";

/// A dialogue with the shipped grammar. The robot stands in the corridor of kMap.
struct DialogueTest : testing::Test {
  DialogueTest() {
    situation.map = maps::parse_map(kMap, "test.map");
    situation.pose_in_map = Pose{3.5, 1.2, 0.0};
    situation.findable = {"alice", "john", "karen"};
  }
  Grammar grammar() const {
    const std::string file = test::source("config/grammars/flakey.grammar");
    return Grammar(read_file(file), file);
  }
  Dialogue::Outputs hear(const std::string& text, const std::string& speaker = "Alice") {
    Utterance utterance{{7, ++number}, speaker, text};
    utterance.time = now;
    last = dialogue.hear(utterance, situation);
    return last;
  }
  /// The robot's newest answer, in one line.
  std::string answer() const {
    std::string all;
    for (const Said& one : last.said)
      all += (all.empty() ? "" : " / ") + one.text;
    return all;
  }
  std::string said(const std::string& text, const std::string& speaker = "Alice") {
    hear(text, speaker);
    return answer();
  }
  /// The newest goals.
  std::string goals() const {
    std::string all;
    for (const WantedGoal& goal : last.goals) {
      const std::string arguments = describe(goal.arguments);
      all += (all.empty() ? "" : "; ") + goal.functor + (arguments.empty() ? "" : " ") + arguments;
    }
    return all;
  }
  static std::string claims(const std::vector<Claimed>& claims) {
    std::string all;
    for (const Claimed& claim : claims) {
      EXPECT_TRUE(claim.list.empty() || joined(claim.list) == claim.value) << claim.value;
      all += (all.empty() ? "" : "; ") + claim.name + "=" + (claim.nil ? "nil" : claim.value);
    }
    return all;
  }

  Situation situation;
  Dialogue dialogue{grammar()};
  Dialogue::Outputs last;
  std::uint64_t number = 0;  ///< of the newest utterance
  double now = 1e9;          ///< [s]
};

}  // namespace saphira::agent_interface
