// security: the authority of a site, and the credentials of its members.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/authority.hpp"
#include "saphira/security/documents.hpp"

namespace saphira::cli {
namespace {

using security::Authority;

constexpr int kDays = 365;
constexpr std::int64_t kDay = 86400;
constexpr std::int64_t kSoon = 30;  // [days]

struct Words {
  std::string folder;
  std::string name;
  std::string roles_file;
  std::vector<std::string> roles;
  std::string robot;
  int days = kDays;
  std::string credentials;
  std::string program = "cli";
  bool json = false;
};

std::string day_of(std::int64_t seconds) {
  return utc_text(seconds, "%Y-%m-%d");
}

void tell_folder(const std::string& folder) {
  std::cout << folder
            << "\nCopy this folder, whole, to its machine; it holds private keys. For a person's "
               "commands and programs: ~/.config/saphira/credentials. For the service: "
               "/etc/saphira/credentials, owned by the user saphira.\n";
}

int init(const Words& words) {
  const std::string file =
      words.roles_file.empty() ? config_folder() + "/security/roles.yaml" : words.roles_file;
  const Authority made =
      Authority::make(words.folder, words.name, read_file(file), file, unix_seconds());
  std::cout
      << "The authority of " << made.site() << " is in " << made.folder()
      << ". Whoever reads that folder can make members: keep it off the robots, and keep a copy.\n"
         "Next: saphira security add NAME --role ROLE, for each machine and person. Roles:\n";
  for (const security::Role& role : made.roles().roles)
    std::cout << "  " << role.name
              << std::string(role.name.size() < 10 ? 10 - role.name.size() : 1, ' ') << role.about
              << '\n';
  return bus::kExitOk;
}

int add(const Words& words) {
  tell_folder(Authority(words.folder)
                  .add(words.name, words.roles, words.robot, words.days, unix_seconds()));
  return bus::kExitOk;
}

int renew(const Words& words) {
  tell_folder(Authority(words.folder).renew(words.name, words.days, unix_seconds()));
  std::cout << "Its programs take it when they are started again; the old certificates hold until "
               "they expire.\n";
  return bus::kExitOk;
}

int revoke(const Words& words) {
  const std::string list = Authority(words.folder).revoke(words.name);
  std::cout << words.name << " is revoked.\n"
            << list
            << "\nCopy this file over revoked.signed in the folder of credentials on every "
               "machine: its programs "
               "take it within seconds, without a restart.\n";
  return bus::kExitOk;
}

int list(const Words& words) {
  const Authority authority(words.folder);
  nlohmann::json members = nlohmann::json::array();
  for (const auto& [name, member] : authority.members()) {
    const std::int64_t days = (member.until - unix_seconds()) / kDay;
    const std::string state = member.revoked                   ? "revoked"
                              : member.until <= unix_seconds() ? "expired"
                              : days < kSoon ? "expires in " + std::to_string(days) +
                                                   " days: saphira security renew " + name
                                             : "holds";
    members.push_back({{"name", name},
                       {"issue", member.issue},
                       {"roles", member.roles},
                       {"robot", member.robot},
                       {"until", day_of(member.until)},
                       {"state", state}});
    if (!words.json)
      std::printf("%-20s %-28s %-12s until %s  %s\n", name.c_str(),
                  joined(member.roles, ",").c_str(),
                  member.robot.empty() ? "any robot" : member.robot.c_str(),
                  day_of(member.until).c_str(), state.c_str());
  }
  if (words.json)
    std::cout << members.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  else if (members.empty())
    std::cout << authority.site() << " has no members yet: saphira security add NAME --role ROLE\n";
  return bus::kExitOk;
}

/// A folder of credentials, or the authority's files.
int check(const Words& words, const bus::NodeOptions& options) {
  const std::string folder = words.credentials.empty() ? options.security : words.credentials;
  if (folder.empty() || folder == bus::kOpenBus)
    return failed(
        "this user and this machine have no credentials: the bus is open to all "
        "(docs/security.md)");
  for (const std::string& role : security::roles_in(folder)) {
    const security::Credentials good = security::load_role(folder, role, unix_seconds());
    if (const std::string trouble = security::trouble_of_key(good); !trouble.empty())
      throw std::invalid_argument(trouble);
    std::cout << folder << "/" << role << ": " << security::common_name(good.subject) << " of "
              << good.subject.site << ", " << role << ", until " << day_of(good.until) << '\n';
  }
  const security::Credentials mine =
      security::load_credentials(folder, words.program, unix_seconds());
  std::cout << words.program << " is " << mine.subject.name << " (" << mine.subject.role << ")\n";
  return bus::kExitOk;
}

}  // namespace

void add_security(CLI::App& app, Chosen& chosen) {
  auto words = std::make_shared<Words>();
  // Once: an option bound to the variable in each subcommand would set the folder again in all.
  const char* const given = std::getenv("SAPHIRA_AUTHORITY");
  words->folder = given != nullptr && *given != '\0' ? given : user_folder() + "/authority";
  CLI::App* command = app.add_subcommand(
      "security",
      "Keys and certificates of a site, and the roles of its members (docs/security.md)");
  chosen.apart.insert(command);
  command->require_subcommand(1);
  const auto action = [&](const std::string& name, const std::string& about,
                          int (*run)(const Words&)) {
    CLI::App* one = command->add_subcommand(name, about);
    one->add_option("--authority", words->folder, "folder of the authority (Env:SAPHIRA_AUTHORITY)")
        ->capture_default_str();
    chosen.when(one,
                [words, run](const bus::NodeOptions&, const bus::Stop&) { return run(*words); });
    return one;
  };
  const auto add_days = [&](CLI::App* one) {
    one->add_option("--days", words->days, "how long the certificates hold")->capture_default_str();
  };
  CLI::App* one = action("init", "Make the authority of a site", init);
  one->add_option("site", words->name, "its name")->required();
  one->add_option("--roles", words->roles_file, "file of roles [config/security/roles.yaml]");

  one = action("add", "Make a member: a machine, a person or a program", add);
  one->add_option("name", words->name, "its name")->required();
  one->add_option("--role", words->roles, "its role; several for several programs of a machine")
      ->required()
      ->delimiter(',');
  one->add_option("--robot", words->robot, "the only robot that it may have to do with");
  add_days(one);

  one = action("renew", "Make new certificates of a member, before the old ones expire", renew);
  one->add_option("name", words->name, "of the member")->required();
  add_days(one);

  one = action("revoke", "End a member's certificates", revoke);
  one->add_option("name", words->name, "of the member")->required();

  one = action("list", "The members", list);
  one->add_flag("--json", words->json, "for programs");

  one = command->add_subcommand("check", "Check that a folder of credentials is whole and valid");
  one->add_option("folder", words->credentials, "the folder [that of this user or machine]");
  one->add_option("--program", words->program, "for which program")->capture_default_str();
  chosen.when(one, [words](const bus::NodeOptions& options, const bus::Stop&) {
    return check(*words, options);
  });
}

}  // namespace saphira::cli
