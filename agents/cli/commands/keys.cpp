// keys: the keys of persons at the doors. audit: who drove, stopped, reset, asked, was refused.
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "run_folder.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/audit_file.hpp"
#include "saphira/security/door_keys.hpp"

namespace saphira::cli {
namespace {

constexpr std::size_t kOtherAudits = 3;  // that are named

using security::DoorKey;
using security::DoorKeys;
using security::DoorRight;

struct KeyWords {
  std::string file;
  std::string name;
  std::string right = "drive";
  int days = 90;
};

/// The file that this user's doors read: of root, the one of the machine's service.
std::string usual_keys() {
  return geteuid() == 0 ? security::door_key_files().back() : security::door_key_files().front();
}

DoorKeys read(const std::string& file) {
  return std::filesystem::exists(file) ? DoorKeys(read_file(file), file) : DoorKeys();
}

/// Others may read it: it holds hashes. The service has a user of its own.
void write(const std::string& file, const DoorKeys& keys) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::error_code none;
  if (!folder.empty())
    std::filesystem::create_directories(folder, none);
  if (!replace_file(file, keys.text(), true) || chmod(file.c_str(), 0644) != 0)
    throw UnusableFile(cannot_be(file, "written"));
}

int add(const KeyWords& words) {
  DoorKeys keys = read(words.file);
  const DoorRight right = words.right == "watch"   ? DoorRight::watch
                          : words.right == "drive" ? DoorRight::drive
                                                   : DoorRight::operate;
  const std::string key = keys.add(words.name, right, words.days, unix_seconds());
  write(words.file, keys);
  std::cout << "The key of " << words.name << ", to " << words.right << ", is shown this once:\n"
            << key << "\nFor the page: behind the # of its address, as http://HOST:8642/#" << key
            << "\nFor MCP by HTTP: as the bearer token.\n"
            << words.file << " has its hash; running doors know it within a second.\n";
  return bus::kExitOk;
}

int list(const KeyWords& words) {
  const DoorKeys keys = read(words.file);
  for (const DoorKey& key : keys.all())
    std::printf("%-32s %-8s until %s%s\n", key.name.c_str(), security::name_of(key.right),
                utc_text(key.until - 1, "%Y-%m-%d").c_str(),
                key.until <= unix_seconds() ? "  over" : "");
  if (keys.all().empty())
    std::cout << words.file << ": nobody has a key yet: saphira keys add NAME\n";
  return bus::kExitOk;
}

int revoke(const KeyWords& words) {
  DoorKeys keys = read(words.file);
  keys.revoke(words.name);
  write(words.file, keys);
  std::cout << "The key of " << words.name
            << " holds no more; doors end what it has open within a second.\n";
  return bus::kExitOk;
}

struct AuditWords {
  std::string file;
  bool check = false;
  std::string known;
};

int audit(const AuditWords& words, const FilesOf& bus) {
  std::string file = words.file;
  if (file.empty()) {
    const std::vector<std::string> all = audit_files(bus);
    if (all.empty())
      throw UnusableFile("this machine has no audit" + words_of(bus) +
                         ": the bridge of a robot keeps it, where saphira "
                         "up or the service runs it");
    if (all.size() > 1)
      std::cerr << "saphira: " << all.front() << ", the newest; others: "
                << joined(std::vector<std::string>(
                       all.begin() + 1, all.begin() + static_cast<std::ptrdiff_t>(
                                                          std::min(all.size(), kOtherAudits + 1))))
                << (all.size() > kOtherAudits + 1 ? " ..." : "") << '\n';
    file = all.front();
  }
  const security::AuditRecord record = security::read_audit(file, words.known);
  if (!words.check)
    for (const std::string& line : record.lines)
      std::cout << line << '\n';
  if (!record.trouble.empty())
    return failed("the audit was changed or cut: " + record.trouble);
  if (words.check)
    std::cout
        << record.lines.size() << (record.lines.size() == 1 ? " entry" : " entries") << ", whole"
        << (record.vouched_from > 1 ? " from number " + std::to_string(record.vouched_from) + " on"
                                    : "")
        << "; the newest is number " << record.number << ", hash " << record.hash
        << "\nNote the hash elsewhere: saphira audit --check --known HASH finds an audit that "
           "was written anew.\n";
  return bus::kExitOk;
}

}  // namespace

void add_keys(CLI::App& app, Chosen& chosen) {
  auto words = std::make_shared<KeyWords>();
  words->file = usual_keys();
  CLI::App* command =
      app.add_subcommand("keys", "Keys of persons for the console's page and MCP by HTTP");
  chosen.apart.insert(command);
  command->require_subcommand(1);
  const auto action = [&](const std::string& name, const std::string& about,
                          int (*run)(const KeyWords&)) {
    CLI::App* one = command->add_subcommand(name, about);
    one->add_option("--file", words->file, "the file of keys")->capture_default_str();
    chosen.when(one,
                [words, run](const bus::NodeOptions&, const bus::Stop&) { return run(*words); });
    return one;
  };
  CLI::App* one = action("add", "Make a key for a person, and show it", add);
  one->add_option("name", words->name, "of the person")->required();
  one->add_option("--right", words->right,
                  "watch: watch and stop; drive: also drive, talk and have goals; operate: also "
                  "others' goals, the emergency stop's reset and micro-tasks")
      ->check(CLI::IsMember({"watch", "drive", "operate"}))
      ->capture_default_str();
  one->add_option("--days", words->days, "how long it holds")->capture_default_str();
  action("list", "The persons with a key", list);
  one = action("revoke", "End a person's key", revoke);
  one->add_option("name", words->name, "of the person")->required();
}

void add_audit(CLI::App& app, Chosen& chosen) {
  auto words = std::make_shared<AuditWords>();
  CLI::App* command = app.add_subcommand(
      "audit", "Who drove, stopped, reset, asked and was refused, on the robot's machine");
  chosen.apart.insert(command);
  command->add_option("file", words->file, "the audit [the newest of this machine]");
  command->add_flag("--check", words->check, "only say if it is whole and unchanged");
  command->add_option("--known", words->known, "a hash noted earlier, which has to be there");
  chosen.when(command, [words, &app](const bus::NodeOptions&, const bus::Stop&) {
    return audit(*words, given_bus(app));
  });
}

}  // namespace saphira::cli
