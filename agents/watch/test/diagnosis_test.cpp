#include "saphira/watch/diagnosis.hpp"

#include <gtest/gtest.h>

#include "saphira/base/text.hpp"

namespace saphira::watch {
namespace {

bus::ProgramEntry program(const std::string& name, std::uint32_t pid = 7) {
  return {.name = name,
          .host = "attic",
          .pid = pid,
          .robot = "ant",
          .contract = "0f1e2d3c",
          .known = 10.0,
          .endpoints = 20};
}
bus::EndpointEntry endpoint(const std::string& program, std::uint32_t pid, bool writer,
                            const std::string& topic = "robot/state", bool reliable = true) {
  bus::EndpointEntry entry;
  entry.topic = topic;
  entry.type = "saphira::v1::RobotState";
  entry.writer = writer;
  entry.program = program;
  entry.host = "attic";
  entry.pid = pid;
  entry.robot = "ant";
  entry.reliable = reliable;
  entry.durability = "volatile";
  return entry;
}

/// A robot's bridge and behaviors on a machine, all well.
BusFacts well() {
  BusFacts facts;
  facts.robot = {"ant", "--robot"};
  facts.domain = {"3", "usual"};
  facts.contract = "0f1e2d3c";
  facts.interfaces = {{"lo", "127.0.0.1", true, {}}};
  facts.programs = {program("bridge", 1), program("behaviors", 2)};
  facts.endpoints = {endpoint("bridge", 1, true), endpoint("behaviors", 2, false)};
  return facts;
}
BusFacts on_a_lan() {
  BusFacts facts = well();
  facts.profile = bus::Profile::lan;
  facts.interfaces.push_back({"eth0", "10.0.0.1", true, {"10.0.0.2"}});
  return facts;
}
BusFacts secured() {
  BusFacts facts = well();
  facts.credentials = {"/c", "", "ann", "operator", "lab", 200};
  for (bus::ProgramEntry& each : facts.programs)
    each.subject = "CN=robot.1,OU=bridge,O=lab";
  return facts;
}

/// Codes of the findings that are no good news: "!" before those that are wrong.
std::string codes(const std::vector<Finding>& findings) {
  std::vector<std::string> all;
  for (const Finding& each : findings) {
    EXPECT_TRUE(each.verdict != Verdict::wrong || !each.remedy.empty()) << each.code;
    if (each.verdict != Verdict::ok)
      all.push_back((each.verdict == Verdict::wrong ? "!" : "") + each.code);
  }
  return joined(all, " ");
}

TEST(Diagnosis, AHealthyBusHasNoFindings) {
  EXPECT_EQ(codes(diagnose(well())), "");
  EXPECT_EQ(codes(diagnose(on_a_lan())), "");
  EXPECT_EQ(codes(diagnose(secured())), "");
}

TEST(Diagnosis, ProgramsOfTheSiteThatLetAMemberInAreNoBar) {
  std::vector<bus::ProgramEntry> found = secured().programs;
  EXPECT_EQ(why_kept_out(found, "ann"), "");
  for (bus::ProgramEntry& each : found)
    each.let_in = false;
  EXPECT_EQ(why_kept_out(found, "ann"),
            "behaviors and bridge of the site lab have not let ann in: credentials of another "
            "authority, expired, revoked, or a wrong clock: saphira security check on both sides, "
            "saphira doctor");
  found.resize(1);
  found.push_back(found[0]);
  EXPECT_TRUE(why_kept_out(found, "ann").starts_with("bridge of the site lab has not let"));
  found[0].subject = found[1].subject = "";
  EXPECT_EQ(why_kept_out(found, "ann"), "") << "they are open";
}

TEST(Diagnosis, NobodyIsThere) {
  BusFacts facts = well();
  facts.programs.clear();
  facts.endpoints.clear();
  EXPECT_EQ(codes(diagnose(facts)), "!nobody");
  facts.programs = {program("cli")};
  EXPECT_EQ(codes(diagnose(facts)), "!nobody") << "another person's command";
  facts.others = {{"bee", "bridge"}, {"bee", "behaviors"}};
  facts.domains = {{88, "the demo, robot ant"}};
  const std::vector<Finding> found = diagnose(facts);
  EXPECT_EQ(codes(found), "!nobody other-robot other-domain");
  EXPECT_EQ(found[found.size() - 3].remedy, "it may be another one's: --robot bee or --domain 88");
}

TEST(Diagnosis, TheNetworkIsChecked) {
  BusFacts facts = on_a_lan();
  facts.interfaces[1].others.clear();
  EXPECT_EQ(codes(diagnose(facts)), "multicast");
  facts.interfaces[1].multicast_returns = false;
  EXPECT_EQ(codes(diagnose(facts)), "!multicast");
  facts.interfaces[0].multicast_returns = false;
  EXPECT_EQ(codes(diagnose(facts)), "!multicast !multicast");
  facts = on_a_lan();
  facts.interfaces.pop_back();
  facts.waits = {"this machine has no network address yet"};
  EXPECT_EQ(codes(diagnose(facts)), "!address");
}

TEST(Diagnosis, PeersAreResolvedAndHeard) {
  BusFacts facts = on_a_lan();
  facts.profile = bus::Profile::wan;
  facts.interfaces[1].multicast_returns = false;
  facts.interfaces[1].others.clear();
  facts.peers = {{"base", "10.0.0.2", false}};
  EXPECT_EQ(codes(diagnose(facts)), "") << "wan needs no multicast";
  facts.peers = {{"base", "", false}, {"10.0.0.3", "10.0.0.3", true}};
  EXPECT_EQ(codes(diagnose(facts)), "!peer !peer");
}

TEST(Diagnosis, SecurityIsOnBothSides) {
  BusFacts facts = secured();
  facts.credentials = {};
  EXPECT_EQ(codes(diagnose(facts)), "!secured !secured");
  facts = secured();
  facts.programs[1].subject.clear();
  facts.programs[1].let_in = false;
  EXPECT_EQ(codes(diagnose(facts)), "!open");
  facts.programs[1].subject = "CN=x.1,OU=bridge,O=barn";
  EXPECT_EQ(codes(diagnose(facts)), "!not-let-in");
  facts.programs[1].known = 1.0;
  EXPECT_EQ(codes(diagnose(facts)), "") << "the handshake takes a while";
  facts.credentials.days = 3;
  EXPECT_EQ(codes(diagnose(facts)), "credentials");
  facts.credentials.trouble = "expired";
  facts.trouble = "no bus";
  EXPECT_EQ(codes(diagnose(facts)), "!credentials !bus");
}

TEST(Diagnosis, ProgramsThatDoNotFit) {
  BusFacts facts = well();
  facts.programs[1].contract = "11111111";
  EXPECT_EQ(codes(diagnose(facts)), "!contract");
  facts = well();
  facts.programs[1].endpoints = 0;
  EXPECT_EQ(codes(diagnose(facts)), "!one-way");
  facts.programs[1].known = 1.0;
  EXPECT_EQ(codes(diagnose(facts)), "");
  facts = well();
  facts.programs[0].silent = true;
  EXPECT_EQ(codes(diagnose(facts)), "!silent");
  facts = well();
  facts.programs.push_back({.name = "ros", .known = 10.0, .endpoints = 2});
  EXPECT_EQ(codes(diagnose(facts)), "program");
  facts = well();
  facts.refused = {"a program at 10.0.0.9 is not let in"};
  situation::Program one;
  one.status.incompatible = 1;
  one.status.host = "attic";
  one.clock_behind = 100.0;
  facts.statuses = {one};
  EXPECT_EQ(codes(diagnose(facts)), "!refused !reported !clock");
}

TEST(Diagnosis, TwoProgramsTalkByTheirTopics) {
  BusFacts facts = well();
  std::vector<Finding> found = diagnose(facts, "behaviors", "bridge");
  EXPECT_EQ(codes(found), "");
  EXPECT_EQ(found.back().is, "behaviors[2] at attic and bridge[1] at attic: <- robot/state");
  EXPECT_EQ(diagnose(facts, "bridge", "").back().code, "pair");
  facts.endpoints[0].reliable = false;
  found = diagnose(facts, "behaviors", "bridge");
  EXPECT_EQ(codes(found), "!topic");
  EXPECT_EQ(found.back().remedy, "run both programs with --lockstep, or neither");
  EXPECT_EQ(codes(diagnose(facts)), "!topic");
  facts.endpoints[0].denied = "robot (agent) may not write the topic robot/state";
  EXPECT_EQ(diagnose(facts, "bridge", "behaviors").back().remedy,
            "a role of the site that may (config/security/roles.yaml), or other credentials");
  facts.endpoints.clear();
  EXPECT_EQ(codes(diagnose(facts, "bridge", "behaviors")), "pair");
  facts.programs[1].robot = "bee";
  EXPECT_EQ(codes(diagnose(facts, "bridge", "behaviors")), "!robots");
}

TEST(Diagnosis, AProgramThatIsNotThere) {
  BusFacts facts = well();
  EXPECT_EQ(codes(diagnose(facts, "bridge", "intentions")), "!absent");
  EXPECT_TRUE(diagnose(facts, "brigde", "").back().is.ends_with("did you mean bridge?"));
  facts.others = {{"bee", "intentions"}};
  EXPECT_EQ(diagnose(facts, "bridge", "intentions").back().remedy,
            "one of robot bee is: give both one --robot");
}

TEST(Diagnosis, DomainsAreFoundByTheirPorts) {
  EXPECT_EQ(discovery_port(0, false), 7400);
  EXPECT_EQ(discovery_port(160, true), 47525);
  EXPECT_EQ(domains_in("  sl  local_address rem_address\n"
                       "   1: 00000000:1D65 00000000:0000 07\n"  // 7525
                       "   2: 0100007F:1CE8 00000000:0000 07\n"  // 7400
                       "   3: 00000000:B9A5 00000000:0000 07\n"  // 47525
                       "   4: 00000000:B9A5 00000000:0000 07\n"
                       "   5: 00000000:B9A6 00000000:0000 07\n"),
            (std::vector<std::uint32_t>{0, 160}));
  EXPECT_TRUE(domains_in("").empty());
}

}  // namespace
}  // namespace saphira::watch
