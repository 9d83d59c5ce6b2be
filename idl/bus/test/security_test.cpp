// The bus with security: several members of a site in one process.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "forged.hpp"
#include "harness.hpp"
#include "liar.hpp"
#include "process.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/authority.hpp"
#include "strangers.hpp"
#include "trouble.hpp"

namespace saphira::bus::test {
namespace {

namespace fs = std::filesystem;

/// A site with a member for each role, named as the role.
class Site {
 public:
  explicit Site(const std::string& name, const std::string& more_of_roles = {}) {
    const std::string file = config_folder() + "/security/roles.yaml";
    authority_.emplace(security::Authority::make(
        folder_.path("authority"), name, read_file(file) + more_of_roles, file, unix_seconds()));
    for (const security::Role& role : authority_->roles().roles)
      add(role.name, role.name);
  }

  void add(const std::string& name, const std::string& role, const std::string& robot = "") {
    authority_->add(name, {role}, robot, 365, unix_seconds());
  }
  security::Authority& authority() { return *authority_; }
  const security::Authority& authority() const { return *authority_; }

  /// A member's folder as somebody else has copied it.
  std::string copy_of(const std::string& member) const {
    const std::string copy = folder_.path("copy-" + member);
    fs::remove_all(copy);
    fs::copy(authority_->folder_of(member), copy, fs::copy_options::recursive);
    return copy;
  }

  NodeOptions options(const std::string& member, const std::string& of_robot = robot("s")) const {
    NodeOptions options = node_options(member, of_robot);
    options.program = program_of(member);
    options.security = authority_->folder_of(member);
    return options;
  }
  std::unique_ptr<Node> node(const std::string& member,
                             const std::string& of_robot = robot("s")) const {
    return std::make_unique<Node>(options(member, of_robot));
  }

 private:
  // Of a role that goes with certain programs, one of them.
  std::string program_of(const std::string& member) const {
    const security::Role* const role = authority_->roles().find(member);
    return role == nullptr || role->programs.empty() ? member : role->programs.front();
  }

  const saphira::test::TempDir folder_;
  std::optional<security::Authority> authority_;
};

/// An endpoint of any topic.
class AnyEndpoint {
 public:
  virtual ~AnyEndpoint() = default;
  virtual std::size_t matched() const = 0;
};

template <class End>
class EndpointOf : public AnyEndpoint {
 public:
  explicit EndpointOf(End end) : end_(std::move(end)) {}
  std::size_t matched() const override { return end_.matched(); }

 private:
  End end_;
};

std::unique_ptr<AnyEndpoint> endpoint(Node& node, const std::string& name, bool writes) {
  std::unique_ptr<AnyEndpoint> made;
  for_each_topic([&]<class T>(const Topic<T>& topic) {
    if (topic.name != name)
      return;
    if (writes)
      made = std::make_unique<EndpointOf<Writer<T>>>(node.writer(topic));
    else
      made = std::make_unique<EndpointOf<Reader<T>>>(node.reader(topic));
  });
  return made;
}

v1::MotorCommand command_of(const std::string& source) {
  return {.source = source};
}

// Every line of the file of roles, for each role that it does not name: the role is told so by its
// own program, and where its program was altered so that it does not care, by everybody else's.
class EveryLine : public testing::Test {
 protected:
  /// The name of a role that the line does name, first those that run on a robot.
  static std::string allowed(const std::set<std::string>& roles) {
    for (const char* const role : {"robot", "bridge", "services", "operator"})
      if (roles.contains(role))
        return role;
    return *roles.begin();
  }
  Node& node(const std::string& role) {
    auto& made = nodes_[role];
    if (!made)
      made = site_.node(role);
    return *made;
  }

  Site site_{"lines"};

 private:
  std::map<std::string, std::unique_ptr<Node>> nodes_;
};

TEST_F(EveryLine, IsKeptByTheProgramItself) {
  for (const security::TopicRule& rule : site_.authority().roles().topics)
    for (const security::Role& role : site_.authority().roles().roles)
      for (const bool writes : {true, false}) {
        SCOPED_TRACE(rule.topic + " " + role.name + (writes ? " writes" : " reads"));
        const bool may = (writes ? rule.writers : rule.readers).contains(role.name);
        try {
          EXPECT_NE(endpoint(node(role.name), rule.topic, writes), nullptr);
          EXPECT_TRUE(may);
        } catch (const std::invalid_argument& error) {
          EXPECT_FALSE(may) << error.what();
          EXPECT_NE(std::string(error.what()).find(role.name + " (" + role.name + ") may not "),
                    std::string::npos)
              << error.what();
          EXPECT_NE(std::string(error.what()).find(rule.topic), std::string::npos) << error.what();
        }
      }
}

TEST_F(EveryLine, IsKeptInADryRun) {
  NodeOptions options = site_.options("agent");
  options.dry_run = true;
  Node dry(options);
  EXPECT_NE(endpoint(dry, "drive/direct", true), nullptr);
  EXPECT_THROW(endpoint(dry, "drive/teleop", true), std::invalid_argument);
  EXPECT_THROW(endpoint(dry, "drive/estop", false), std::invalid_argument);
}

TEST_F(EveryLine, IsKeptByTheOthers) {
  const security::Roles& roles = site_.authority().roles();
  for (const security::Role& role : roles.roles)
    node(role.name);
  struct Honest {
    std::unique_ptr<AnyEndpoint> writer;
    std::unique_ptr<AnyEndpoint> reader;
    std::size_t readers = 0;  ///< that the writer has without any liar
    std::size_t writers = 0;
  };
  std::map<std::string, Honest> honest;
  for (const security::TopicRule& rule : roles.topics)
    honest[rule.topic] = {endpoint(node(allowed(rule.writers)), rule.topic, true),
                          endpoint(node(allowed(rule.readers)), rule.topic, false)};
  Node& watch = node("bridge");
  // Every program writes these two.
  const std::size_t programs = roles.roles.size();
  for (auto& [topic, pair] : honest) {
    pair.readers = 1;
    pair.writers = topic == topics::kStatus.name || topic == topics::kLog.name ? programs + 1 : 1;
    if (topic == topics::kPresence.name)
      continue;  // the programs' own readers are its
    ASSERT_TRUE(eventually(watch,
                           [&] {
                             return pair.writer->matched() == pair.readers &&
                                    pair.reader->matched() == pair.writers;
                           }))
        << topic << ": " << pair.writer->matched() << " " << pair.reader->matched();
  }

  // Together, since one that ended would count until its lease is over.
  std::vector<std::unique_ptr<Liar>> liars;
  for (const security::Role& role : roles.roles) {
    SCOPED_TRACE(role.name);
    liars.push_back(std::make_unique<Liar>(site_.options(role.name), topics::kLog.name));
    std::set<std::string> untold;
    for (const security::TopicRule& rule : roles.topics) {
      if (rule.topic == topics::kPresence.name)
        continue;
      for (const bool writes : {true, false}) {
        ASSERT_TRUE(liars.back()->add(rule.topic, writes)) << rule.topic;
        if (!(writes ? rule.writers : rule.readers).contains(role.name))
          untold.insert(role.name + " (" + role.name + ") may not " + (writes ? "write" : "read") +
                        " the topic " + rule.topic + ":");
      }
      honest[rule.topic].writers += rule.writers.contains(role.name) ? 1U : 0U;
      honest[rule.topic].readers += rule.readers.contains(role.name) ? 1U : 0U;
    }
    const auto as_the_line_says = [&](const std::string& topic) {
      const Honest& pair = honest[topic];
      return topic == topics::kPresence.name ||
             (pair.reader->matched() == pair.writers && pair.writer->matched() == pair.readers);
    };
    for (const security::TopicRule& rule : roles.topics)
      EXPECT_TRUE(eventually(watch, [&] { return as_the_line_says(rule.topic); })) << rule.topic;
    EXPECT_TRUE(eventually(watch,
                           [&] {
                             for (const security::Role& other : roles.roles)
                               for (const std::string& trouble :
                                    internal::transport_of(node(other.name)).take_refusals().texts)
                                 std::erase_if(untold, [&](const std::string& part) {
                                   return trouble.find(part) != std::string::npos;
                                 });
                             return untold.empty();
                           }))
        << untold.size() << " are not told, such as " << *untold.begin();
    // All endpoints of the node were looked at by now, and the forbidden ones are still unmatched.
    // A program whose presence is late, as in this crowd, counts as gone until it is heard again.
    for (const security::TopicRule& rule : roles.topics)
      EXPECT_TRUE(eventually(watch, [&] { return as_the_line_says(rule.topic); })) << rule.topic;
  }
}

/// All that an honest member may write and read on the bus.
class Honest {
 public:
  Honest(const Site& site, const std::string& role) : node_(site.node(role)) {
    const security::Roles& roles = site.authority().roles();
    for_each_topic([&]<class T>(const Topic<T>& topic) {
      if (roles.may_write(role, topic.name))
        turns_.push_back(
            [writer = std::make_shared<Writer<T>>(node_->writer(topic))] { writer->write(T()); });
      if (roles.may_read(role, topic.name))
        turns_.push_back([this, reader = std::make_shared<Reader<T>>(node_->reader(topic)), topic] {
          for (const auto& sample : reader->take())
            heard_[sample.info.sender ? sample.info.sender->name : ""].insert(topic.name);
        });
    });
  }

  void turn() {
    for (const auto& one : turns_)
      one();
    for (const std::string& text : internal::transport_of(*node_).take_refusals().texts)
      refusals_ += text + "\n";
    node_->wait(milliseconds(20));
  }
  /// The topics on which it has heard a member.
  std::set<std::string> heard(const std::string& member) { return heard_[member]; }
  const std::string& refusals() const { return refusals_; }

 private:
  const std::unique_ptr<Node> node_;
  std::vector<std::function<void()>> turns_;
  std::map<std::string, std::set<std::string>> heard_;
  std::string refusals_;
};

// An altered program takes permissions that nobody of the site's authority has signed. The others
// do not let it in, so that it neither writes nor reads anything.
class Forger : public testing::Test {
 protected:
  Forger() {
    for (Site* const site : {&site_, &other_}) {
      site->add("john", "observer");
      site->add("karen", "operator", robot("other"));
    }
  }

  /// A member's folder with permissions for everything.
  std::string forged(const std::string& member, const std::string& role,
                     const security::KeyPair& signer) const {
    const std::string folder = site_.copy_of(member);
    security::test::forge(folder, {{member, 1, role, "forged"}, "", 0, unix_seconds() + 86400},
                          site_.authority().roles(), signer);
    return folder;
  }
  saphira::test::Process altered(const std::string& name, const std::string& credentials,
                                 const std::vector<std::string>& more = {}) {
    std::vector<std::string> argv{"saphira-bus-altered", "--robot", robot("s"), "--name", name};
    argv.insert(argv.end(), more.begin(), more.end());
    return {argv,
            folder_.path(name),
            {{"SAPHIRA_DOMAIN", saphira::test::domain()},
             {"SAPHIRA_PROFILE", "host"},
             {"SAPHIRA_SECURITY", credentials}}};
  }
  template <class Condition>
  bool turn_until(Condition&& condition) {
    return saphira::test::wait_until([&] {
      bridge_.turn();
      services_.turn();
      return condition();
    });
  }

  const saphira::test::TempDir folder_;
  Site site_{"forged"};
  Site other_{"forged"};
  Honest bridge_{site_, "bridge"};
  Honest services_{site_, "services"};
};

TEST_F(Forger, IsHeldToItsGenuinePermissions) {
  auto genuine = altered("genuine", site_.copy_of("john"));
  ASSERT_TRUE(turn_until([&] {
    return saphira::test::has(genuine.output(), "hears robot/state") &&
           bridge_.heard("john").contains(topics::kDriveStop.name);
  })) << genuine.output();
  const security::Roles& roles = site_.authority().roles();
  for (const std::string& topic : bridge_.heard("john"))
    EXPECT_TRUE(roles.may_write("observer", topic)) << topic;
  EXPECT_FALSE(saphira::test::has(genuine.output(), "hears drive/behaviors"));
  EXPECT_TRUE(saphira::test::has(bridge_.refusals(),
                                 "john (observer) may not write the topic drive/teleop"))
      << bridge_.refusals();
}

// Its permissions are genuine, and for another robot.
TEST_F(Forger, IsNamedWhereItWantsAnotherRobot) {
  auto genuine = altered("genuine", site_.copy_of("karen"));
  const std::string told = "karen (operator) may not have it of " + robot("s") +
                           ": its permissions are for the robot " + robot("other");
  EXPECT_TRUE(turn_until([&] { return saphira::test::has(bridge_.refusals(), told); }))
      << bridge_.refusals();
  for (Honest* const honest : {&bridge_, &services_})
    EXPECT_EQ(honest->heard("karen"), std::set<std::string>());
  EXPECT_FALSE(saphira::test::has(genuine.output(), "hears ")) << genuine.output();
}

TEST_F(Forger, IsNotLetIn) {
  const std::string karens = site_.copy_of("karen");
  const std::string johns = site_.copy_of("john");
  const std::string theirs = other_.copy_of("john");
  const struct {
    const char* name;
    const char* member;
    const char* role;
    security::KeyPair signer;
  } cases[]{{"by-itself", "john", "observer", security::test::pair_of(johns, "observer")},
            {"of-another-robot", "karen", "operator", security::test::pair_of(karens, "operator")},
            {"by-another-site", "john", "observer", security::test::pair_of(theirs, "observer")}};
  for (const auto& one : cases) {
    SCOPED_TRACE(one.name);
    auto program = altered(one.name, forged(one.member, one.role, one.signer));
    const std::string told = "calls itself " + std::string(one.name);
    EXPECT_TRUE(turn_until([&] {
      return saphira::test::has(bridge_.refusals(), told) &&
             saphira::test::has(services_.refusals(), told);
    })) << program.output();
    for (int i = 0; i < 20; ++i) {
      bridge_.turn();
      services_.turn();
    }
    for (Honest* const honest : {&bridge_, &services_})
      EXPECT_EQ(honest->heard(one.member), std::set<std::string>());
    program.signal(SIGTERM);
    EXPECT_EQ(program.wait(), 0);
    EXPECT_FALSE(saphira::test::has(program.output(), "hears ")) << program.output();
  }
}

// One that announces an operator's name, and authenticates as itself. Its permissions are genuine.
TEST_F(Forger, HasNoOtherName) {
  site_.add("kate", "operator");
  auto program = altered(
      "false-name", site_.copy_of("john"),
      {"--own", "CN=john.1,OU=observer,O=forged", "--as", "CN=kate.1,OU=operator,O=forged"});
  const std::string told = "calls itself false-name at " + internal::host_name() +
                           " and announces /O=forged/OU=operator/CN=kate.1";
  EXPECT_TRUE(turn_until([&] {
    return saphira::test::has(bridge_.refusals(), told) &&
           saphira::test::has(services_.refusals(), told);
  })) << bridge_.refusals();
  for (const char* const member : {"john", "kate"})
    EXPECT_EQ(bridge_.heard(member), std::set<std::string>()) << member;
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_FALSE(saphira::test::has(program.output(), "hears ")) << program.output();
}

TEST(Security, AStrangerIsNotHeardAndHearsNothing) {
  const Site site("stranger");
  const auto bridge = site.node("bridge");
  const auto operating = site.node("operator");
  auto commands = bridge->reader(topics::kDriveTeleop);
  auto states = bridge->writer(topics::kRobotState);
  auto driver = operating->writer(topics::kDriveTeleop);
  NodeOptions open = site.options("operator");
  open.security = kOpenBus;
  open.name = "stranger";
  Node one(open);
  Node other(open);
  auto forged = one.writer(topics::kDriveTeleop);
  auto spy = one.reader(topics::kRobotState);
  auto forged_states = other.writer(topics::kRobotState);
  // The strangers have each other, and the members have each other.
  ASSERT_TRUE(eventually(one, [&] { return spy.matched() == 1; }));
  ASSERT_TRUE(eventually(*bridge, [&] { return commands.matched() == 1; }));
  for (int i = 0; i < 20; ++i) {
    forged.write(command_of("stranger"));
    states.write(robot_state(1, static_cast<std::uint64_t>(i)));
    driver.write(command_of("operator"));
    bridge->wait(milliseconds(10));
  }
  for (const auto& sample : commands.take())
    EXPECT_EQ(sample.data.source, "operator");
  EXPECT_EQ(commands.matched(), 1U);
  EXPECT_EQ(states.matched(), 0U);
  EXPECT_EQ(forged.matched(), 0U);
  EXPECT_EQ(spy.matched(), 1U);
  EXPECT_TRUE(spy.take().empty());
  EXPECT_TRUE(saphira::test::has(one.bar(), "its programs are of the site stranger"));
  EXPECT_EQ(bridge->bar(), "");
  std::string told;
  EXPECT_TRUE(eventually(*bridge, [&] {
    for (const std::string& text : internal::transport_of(*bridge).take_refusals().texts)
      told += text;
    return saphira::test::has(told, "127.0.0.1 is not let in that calls itself stranger");
  })) << told;
}

TEST(Security, StrangersWhoRepeatThemselvesKeepNobodyOut) {
  const Site site("repeated");
  const auto bridge = site.node("bridge");
  auto commands = bridge->reader(topics::kDriveTeleop);
  saphira::test::Strangers strangers(static_cast<unsigned>(std::stoul(saphira::test::domain())));
  const std::jthread flood([&](const std::stop_token& stop) {
    while (!stop.stop_requested())
      strangers.announce(300, 1000, 300);
  });
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(eventually(*bridge, [&] {
      return !internal::transport_of(*bridge).notices().empty();
    })) << "all places of strangers are taken";
    const auto operating = site.node("operator");
    auto driver = operating->writer(topics::kDriveTeleop);
    EXPECT_TRUE(eventually(*bridge, [&] {
      driver.write(command_of("operator"));
      return !commands.take().empty();
    }));
  }
}

TEST(Security, WhereTheSealIsRequiredAMemberWithoutItStaysOut) {
  const Site site("sealed", "\nseal: required\n");
  const auto bridge = site.node("bridge");
  auto commands = bridge->reader(topics::kDriveTeleop);
  const auto operating = site.node("operator");
  auto driver = operating->writer(topics::kDriveTeleop);
  EXPECT_TRUE(eventually(*bridge, [&] {
    driver.write(command_of("operator"));
    return !commands.take().empty();
  }));
  fs::remove(site.authority().folder_of("operator") + "/site.key");
  EXPECT_THROW(site.node("operator"), std::invalid_argument);
}

TEST(Security, AMemberOfAnotherSiteIsAStranger) {
  const Site site("one");
  const Site other("other");
  const auto bridge = site.node("bridge");
  const auto operating = site.node("operator");
  const auto foreign = other.node("operator");
  auto commands = bridge->reader(topics::kDriveTeleop);
  auto forged = foreign->writer(topics::kDriveTeleop);
  auto driver = operating->writer(topics::kDriveTeleop);
  ASSERT_TRUE(eventually(*bridge, [&] { return commands.matched() == 1; }));
  ASSERT_TRUE(eventually(*bridge, [&] {
    driver.write(command_of("operator"));
    forged.write(command_of("foreign"));
    bool heard = false;
    for (const auto& sample : commands.take()) {
      EXPECT_EQ(sample.data.source, "operator");
      heard = true;
    }
    return heard;
  }));
  EXPECT_EQ(forged.matched(), 0U);
  EXPECT_TRUE(eventually(*foreign, [&] {
    return foreign->bar() ==
           "its programs are of the site one, and the credentials of operator are of other";
  }));
}

TEST(Security, WhoIsRevokedIsCutOff) {
  Site site("revoked");
  site.add("karen", "operator");
  const std::string stolen = site.copy_of("karen");
  const auto bridge = site.node("bridge");
  auto commands = bridge->reader(topics::kDriveTeleop);
  NodeOptions options = site.options("karen");
  options.security = stolen;
  Node karen(options);
  auto driver = karen.writer(topics::kDriveTeleop);
  ASSERT_TRUE(eventually(*bridge, [&] { return commands.matched() == 1; }));
  site.authority().revoke("karen");
  // She goes on, with the folder that nobody has taken from her.
  EXPECT_TRUE(eventually(
      *bridge,
      [&] {
        driver.write(command_of("karen"));
        return commands.matched() == 0;
      },
      milliseconds(60000)));
  commands.take();
  // Nor is she taken back when she begins again.
  Node again(options);
  auto second = again.writer(topics::kDriveTeleop);
  auto own = again.reader(topics::kLog);
  ASSERT_TRUE(eventually(again, [&] { return own.matched() >= 1; }));  // her own old program
  EXPECT_EQ(second.matched(), 0U);
  EXPECT_EQ(commands.matched(), 0U);
  EXPECT_TRUE(commands.take().empty());
}

TEST(Security, CredentialsOfOneRobotAreForItAlone) {
  Site site("robots");
  site.add("karen", "operator", robot("s"));
  const auto bridge = site.node("bridge");
  const auto karen = site.node("karen");
  auto commands = bridge->reader(topics::kDriveTeleop);
  auto driver = karen->writer(topics::kDriveTeleop);
  EXPECT_TRUE(eventually(*bridge, [&] { return commands.matched() == 1; }));
  for (const std::string& other : {robot("other"), std::string("*")})
    EXPECT_TRUE(saphira::test::has(
        saphira::test::trouble_of<std::invalid_argument>([&] { site.node("karen", other); }),
        "are for the robot " + robot("s") + " alone"))
        << other;
}

TEST(Security, ABusWithoutItsCredentialsDoesNotBegin) {
  NodeOptions options = node_options("a", robot("s"));
  options.security = "/nowhere";
  EXPECT_TRUE(saphira::test::has(
      saphira::test::trouble_of<std::invalid_argument>([&] { const Node node(options); }),
      "/nowhere: there is no such folder"));
}

}  // namespace
}  // namespace saphira::bus::test
