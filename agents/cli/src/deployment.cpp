#include "saphira/cli/deployment.hpp"

#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "saphira/base/places.hpp"
#include "saphira/base/robot_name.hpp"
#include "saphira/base/text.hpp"

namespace saphira::cli {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail_at(const Deployment& deployment, const Placed& at,
                          const std::string& message) {
  std::istringstream lines(deployment.text);
  std::string line;
  for (int i = 0; i < at.line; ++i)
    if (!std::getline(lines, line))
      line.clear();
  throw FileError(deployment.file, at.line, at.column, message, line);
}

/// Reads one file, and its errors.
class Parser {
 public:
  Parser(const std::string& text, const std::string& file) {
    deployment_.file = file;
    deployment_.text = text;
  }

  Deployment parse() {
    YAML::Node root;
    try {
      root = YAML::Load(deployment_.text);
    } catch (const YAML::ParserException& error) {
      fail(error.mark,
           "expected a deployment in YAML, such as config/deployments/demo.yaml: " + error.msg);
    }
    expect(root.IsMap(), root, "a deployment (keys such as programs:)");
    keys(root, {{"robot", [this](const auto& n) { deployment_.bus.robot = robot(n); }},
                {"domain", [this](const auto& n) { deployment_.bus.domain = domain(n); }},
                {"profile", [this](const auto& n) { deployment_.bus.profile = profile(n); }},
                {"peers",
                 [this](const auto& n) {
                   for (const Placed& peer : words(n, "a list of addresses"))
                     deployment_.bus.peers.push_back(peer.text);
                 }},
                {"interface",
                 [this](const auto& n) {
                   deployment_.bus.interface = word(n, "the address of an interface");
                 }},
                {"security", [this](const auto& n) { deployment_.bus.security = security(n); }},
                {"lockstep",
                 [this](const auto& n) { deployment_.bus.lockstep = boolean(n, "lockstep"); }},
                {"settings", [this](const auto& n) { settings(n); }},
                {"forget", [this](const auto& n) { forget(n); }},
                {"programs", [this](const auto& n) { programs(n); }}});
    if (deployment_.programs.empty())
      fail(root.Mark(), "expected programs: with at least one program");
    return std::move(deployment_);
  }

 private:
  using Handler = std::function<void(const YAML::Node&)>;
  using Handlers = std::vector<std::pair<std::string, Handler>>;

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& message) const {
    fail_at(deployment_, {"", std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1}, message);
  }
  void expect(bool good, const YAML::Node& node, const std::string& what) const {
    if (!good)
      fail(node.Mark(), "expected " + what + ", found " + kind(node));
  }
  static Placed placed(const YAML::Node& node) {
    return {node.Scalar(), node.Mark().line + 1, node.Mark().column + 1};
  }

  static std::string kind(const YAML::Node& node) {
    switch (node.Type()) {
      case YAML::NodeType::Scalar:
        return "\"" + node.Scalar() + "\"";
      case YAML::NodeType::Sequence:
        return "a list";
      case YAML::NodeType::Map:
        return "keys";
      default:
        return "nothing";
    }
  }

  void keys(const YAML::Node& map, const Handlers& handlers) const {
    std::set<std::string> seen;
    for (const auto& entry : map) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      const auto handler =
          std::ranges::find_if(handlers, [&](const auto& known) { return known.first == key; });
      if (handler == handlers.end()) {
        fail(entry.first.Mark(), "unknown key " + kind(entry.first) + ": expected one of " +
                                     joined(handlers, ", ", &Handlers::value_type::first));
      }
      if (!seen.insert(key).second)
        fail(entry.first.Mark(), "the key \"" + key + "\" is there already");
      handler->second(entry.second);
    }
  }

  std::string word(const YAML::Node& node, const std::string& what) const {
    expect(node.IsScalar() && !node.Scalar().empty(), node, what);
    return node.Scalar();
  }

  bool boolean(const YAML::Node& node, const std::string& what) const {
    bool value = false;
    expect(node.IsScalar() && YAML::convert<bool>::decode(node, value), node,
           "true or false (" + what + ")");
    return value;
  }

  std::string robot(const YAML::Node& node) const {
    std::string name = word(node, "the robot's name");
    if (const std::string trouble = trouble_of_robot(name); !trouble.empty())
      fail(node.Mark(), trouble);
    return name;
  }

  std::uint32_t domain(const YAML::Node& node) const {
    unsigned value = 0;
    expect(node.IsScalar() && YAML::convert<unsigned>::decode(node, value) && value <= 231, node,
           "a DDS domain between 0 and 231");
    return value;
  }

  // As every path in a file: relative to the file.
  std::string security(const YAML::Node& node) const {
    const std::string folder = word(node, "a folder of credentials, or none");
    return folder == "none" ? folder
                            : (fs::absolute(deployment_.file).parent_path() / folder).string();
  }

  std::string profile(const YAML::Node& node) const {
    constexpr const char* kExpected = "a network profile: host, lan or wan";
    std::string name = word(node, kExpected);
    expect(name == "host" || name == "lan" || name == "wan", node, kExpected);
    return name;
  }

  std::vector<Placed> words(const YAML::Node& node, const std::string& what) const {
    expect(node.IsSequence(), node, what);
    std::vector<Placed> all;
    for (const auto& entry : node) {
      expect(entry.IsScalar(), entry, "a word or a number");
      all.push_back(placed(entry));
    }
    return all;
  }

  void settings(const YAML::Node& node) {
    expect(node.IsMap(), node, "settings with their defaults (name: value)");
    for (const auto& entry : node) {
      const std::string name = word(entry.first, "the name of a setting");
      if (name == "config" || name == "run" || name == "robot")
        fail(entry.first.Mark(), "${" + name + "} is built in: expected another name");
      expect(entry.second.IsScalar(), entry.second, "the default of " + name);
      if (!deployment_.settings.emplace(name, placed(entry.second)).second)
        fail(entry.first.Mark(), "the setting \"" + name + "\" is there already");
    }
  }

  void forget(const YAML::Node& node) {
    for (const Placed& file : words(node, "a list of files in ${run}")) {
      if (file.text.find('/') != std::string::npos || file.text.starts_with('.'))
        fail(node.Mark(), "expected names of files in ${run}, found \"" + file.text + "\"");
      deployment_.forget.push_back(file.text);
    }
  }

  void programs(const YAML::Node& node) {
    expect(node.IsSequence(), node, "a list of programs (- program: NAME)");
    for (const auto& entry : node)
      program(entry);
  }

  void program(const YAML::Node& node) {
    expect(node.IsMap(), node, "a program (program: NAME)");
    Program made;
    keys(node,
         {{"program",
           [&](const auto& n) {
             word(n, "a program");
             made.program = placed(n);
           }},
          {"name", [&](const auto& n) { made.name = word(n, "a name"); }},
          {"arguments", [&](const auto& n) { made.arguments = words(n, "a list of arguments"); }},
          {"robot", [&](const auto& n) { made.robot = robot(n); }},
          {"bus", [&](const auto& n) { made.bus = boolean(n, "bus"); }},
          {"restart", [&](const auto& n) { made.restart = boolean(n, "restart"); }},
          {"when", [&](const auto& n) {
             word(n, "on, off or a ${setting}");
             made.when = placed(n);
           }}});
    if (made.program.text.empty())
      fail(node.Mark(), "expected program: in this entry");
    if (made.name.empty()) {
      made.name = fs::path(made.program.text).filename().string();
      if (made.name.starts_with("saphira-"))
        made.name.erase(0, std::string("saphira-").size());
    }
    if (std::ranges::any_of(made.name,
                            [](unsigned char each) { return each == '/' || each <= ' '; }))
      fail(node.Mark(),
           "expected name: ONE-WORD, without / and blanks, found \"" + made.name + "\"");
    for (const Program& other : deployment_.programs)
      if (other.name == made.name)
        fail(node.Mark(), "the name \"" + made.name + "\" is there already: expected name: OTHER");
    deployment_.programs.push_back(std::move(made));
  }

  Deployment deployment_;
};

std::string replaced(const Deployment& deployment, const Placed& at,
                     const std::map<std::string, std::string>& values) {
  std::string out;
  std::size_t from = 0;
  while (true) {
    const std::size_t begin = at.text.find("${", from);
    out += at.text.substr(from, begin - from);
    if (begin == std::string::npos)
      return out;
    const std::size_t end = at.text.find('}', begin);
    if (end == std::string::npos)
      fail_at(deployment, at, "expected } after ${ in \"" + at.text + "\"");
    const std::string name = at.text.substr(begin + 2, end - begin - 2);
    const auto value = values.find(name);
    if (value == values.end()) {
      std::string message = "unknown ${" + name + "}: expected one of";
      for (const auto& [known, _] : values)
        message.append(" ").append(known);
      fail_at(deployment, at, message);
    }
    out += value->second;
    from = end + 1;
  }
}

std::optional<std::string> executable(const fs::path& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0)
    return path.string();
  return std::nullopt;
}

/// The path of a program; nothing, with the reason in `missing`, where there is none.
std::optional<std::string> find_program(const Deployment& deployment, const std::string& name,
                                        const Places& places, std::string& missing) {
  if (name.find('/') != std::string::npos) {
    // As every path in a file: relative to the file.
    const fs::path path = fs::path(deployment.file).parent_path() / name;
    missing = "expected a program, found no executable " + path.string();
    return executable(path);
  }
  if (const auto found = executable(fs::path(places.bin) / name))
    return found;
  const char* path = std::getenv("PATH");
  const std::string folders = path == nullptr ? "" : path;
  for (std::size_t at = 0; at < folders.size();) {
    const std::size_t end = std::min(folders.find(':', at), folders.size());
    if (const auto found = executable(fs::path(folders.substr(at, end - at)) / name))
      return found;
    at = end + 1;
  }
  missing = "expected a program, found no \"" + name + "\" in " + places.bin + " or on PATH";
  if (name == "saphira-speech")
    missing += std::string(": ") + kInstallSpeech;
  return std::nullopt;
}

bool is_on(const Deployment& deployment, const Placed& when,
           const std::map<std::string, std::string>& values) {
  const std::string word = replaced(deployment, when, values);
  bool on = false;
  if (!YAML::convert<bool>::decode(YAML::Node(word), on))
    fail_at(deployment, when, "expected on or off for " + when.text + ", found \"" + word + "\"");
  return on;
}

}  // namespace

Deployment parse_deployment(const std::string& text, const std::string& file) {
  return Parser(text, file).parse();
}

Deployment load_deployment(const std::string& file) {
  return parse_deployment(read_file(file), file);
}

Places find_places() {
  Places places{program_folder(), config_folder(), {}};
  if (places.config.starts_with("/usr/"))
    places.own = "/etc/saphira";
  return places;
}

std::string find_deployment(const std::string& name, const Places& places) {
  // An administrator's deployment replaces the shipped one.
  const std::string own = places.own + "/" + name + ".yaml";
  std::error_code none;
  if (!places.own.empty() && std::filesystem::is_regular_file(own, none))
    return own;
  return find_file(places.config + "/deployments", name, ".yaml");
}

std::vector<ChildSpec> command_lines(const Deployment& deployment, const Places& places,
                                     const std::vector<std::string>& set,
                                     std::vector<std::string>* left_out) {
  std::map<std::string, std::string> values{{"config", places.config},
                                            {"run", places.run},
                                            {"robot", deployment.bus.robot.value_or(places.robot)}};
  std::map<std::string, std::string> settings;
  for (const auto& [name, value] : deployment.settings)
    settings[name] = replaced(deployment, value, values);
  for (const std::string& word : set) {
    const std::size_t equals = word.find('=');
    const auto setting = settings.find(word.substr(0, equals));
    if (equals == std::string::npos || setting == settings.end()) {
      std::string names;
      for (const auto& [known, value] : settings)
        names.append(" ").append(known).append("=").append(value);
      throw std::invalid_argument("\"" + word + "\" sets nothing: " + deployment.file + " has" +
                                  (names.empty() ? " no settings" : names));
    }
    setting->second = word.substr(equals + 1);
  }
  values.insert(settings.begin(), settings.end());

  std::vector<ChildSpec> all;
  for (const Program& program : deployment.programs) {
    const std::optional<std::string> robot = program.robot ? program.robot : deployment.bus.robot;
    values["robot"] = robot.value_or(places.robot);
    if (program.when && !is_on(deployment, *program.when, values))
      continue;
    std::string missing;
    const std::optional<std::string> path =
        find_program(deployment, replaced(deployment, program.program, values), places, missing);
    if (!path) {
      if (!program.when || left_out == nullptr)
        fail_at(deployment, program.program, missing);
      left_out->push_back(program.name + " is left out: " + missing);
      continue;
    }
    ChildSpec child;
    child.name = program.name;
    child.restart = program.restart;
    child.argv.push_back(*path);
    for (const Placed& argument : program.arguments)
      child.argv.push_back(replaced(deployment, argument, values));
    if (program.bus) {
      child.robot = values["robot"];
      const BusOptions& bus = deployment.bus;
      const auto add = [&child](const std::string& option, const std::string& value) {
        child.argv.push_back(option);
        child.argv.push_back(value);
      };
      if (robot)
        add("--robot", *robot);
      if (bus.domain)
        add("--domain", std::to_string(*bus.domain));
      if (bus.profile)
        add("--profile", *bus.profile);
      for (const std::string& peer : bus.peers)
        add("--peer", peer);
      if (bus.interface)
        add("--interface", *bus.interface);
      if (bus.security)
        add("--security", *bus.security);
      if (bus.lockstep)
        child.argv.emplace_back("--lockstep");
    }
    all.push_back(std::move(child));
  }
  return all;
}

std::string hidden_from_service(const std::vector<std::string>& argv, const std::string& run) {
  std::string text;
  for (const std::string& word : argv)
    for (const char* const hidden : {"/home/", "/root/", "/run/user/", "/tmp/", "/var/tmp/"}) {
      const std::size_t at = word.find(hidden);
      const bool begins =
          at == 0 || (at != std::string::npos &&
                      std::string_view("=:,").find(word[at - 1]) != std::string::npos);
      if (begins && !word.substr(at).starts_with(run))
        text += "  the service does not see " + word.substr(at) +
                ": put it below /etc/saphira, readable for the user saphira\n";
    }
  return text;
}

std::string closed_devices(const std::vector<std::string>& argv) {
  std::string text;
  for (const std::string& word : argv) {
    const std::string device = word.substr(0, word.find('@'));  // DEVICE@RATE
    if (device.starts_with("/dev/") && access(device.c_str(), F_OK) == 0 &&
        access(device.c_str(), R_OK | W_OK) != 0)
      text += "  this user may not open " + device +
              ": it is for the group that `ls -l` shows, usually dialout\n";
  }
  return text;
}

}  // namespace saphira::cli
