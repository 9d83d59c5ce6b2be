#include "saphira/console/message.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace saphira::console {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kLongest = 1000;  // of a text
constexpr std::size_t kName = 40;
constexpr std::size_t kFileName = 200;
constexpr std::size_t kPiece = 3000;  // of a file
constexpr std::size_t kLargestFile = 1'000'000;

const Json& member(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end())
    throw std::invalid_argument(std::string("\"") + name + "\" is missing");
  return *found;
}

std::string text(const Json& object, const char* name, std::size_t longest = kLongest) {
  const Json& value = member(object, name);
  if (!value.is_string() || value.get_ref<const std::string&>().size() > longest)
    throw std::invalid_argument(std::string("\"") + name + "\": expected a text of at most " +
                                std::to_string(longest) + " bytes");
  return value.get<std::string>();
}

double number(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    throw std::invalid_argument(std::string("\"") + name + "\": expected a number");
  return value.get<double>();
}

std::uint64_t count(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_number_unsigned())
    throw std::invalid_argument(std::string("\"") + name + "\": expected a whole number from 0 on");
  return value.get<std::uint64_t>();
}

bool truth(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_boolean())
    throw std::invalid_argument(std::string("\"") + name + "\": expected true or false");
  return value.get<bool>();
}

Message read(const Json& json) {
  const std::string type = text(json, "type");
  if (type == "drive")
    return teleop::Control::Sample{count(json, "number"),    number(json, "at"),
                                   truth(json, "active"),    number(json, "velocity"),
                                   number(json, "rotation"), count(json, "cycle")};
  if (type == "ack")
    return Ack{count(json, "frame")};
  if (type == "ping")
    return Ping{number(json, "at")};
  if (type == "hello")
    return Hello{text(json, "key"), text(json, "name", kName),
                 json.contains("ticket") ? text(json, "ticket", kName) : ""};
  if (type == "rename")
    return Rename{text(json, "name", kName)};
  if (type == "take")
    return TakeControl{truth(json, "force")};
  if (type == "ask")
    return AskForControl{};
  if (type == "give")
    return GiveControl{count(json, "to")};
  if (type == "release")
    return ReleaseControl{};
  if (type == "hand_back")
    return HandBack{};
  if (type == "stop")
    return StopRobot{count(json, "reference")};
  if (type == "robots")
    return ShowRobots{truth(json, "shown")};
  if (type == "stop_robots")
    return StopRobots{count(json, "reference"), text(json, "robot")};
  if (type == "estop")
    return EmergencyStop{};
  if (type == "estop_reset")
    return ResetEmergencyStop{};
  if (type == "goal")
    return AskGoal{count(json, "reference"), text(json, "words")};
  if (type == "say")
    return Say{text(json, "text")};
  if (type == "cancel")
    return CancelGoal{count(json, "reference"), text(json, "id")};
  if (type == "process")
    return AskProcess{count(json, "reference"), text(json, "service"), text(json, "process"),
                      text(json, "functor")};
  if (type == "map")
    return ChangeMap{count(json, "reference"), text(json, "words")};
  if (type == "save_map")
    return SaveMap{count(json, "reference")};
  if (type == "load_map")
    return LoadMap{count(json, "reference"), text(json, "name", kFileName),
                   text(json, "text", kPiece), truth(json, "more")};
  if (type == "point_out")
    return PointOut{number(json, "x"), number(json, "y"), truth(json, "in_map")};
  return Wrong{"\"type\" is not known: " + type.substr(0, kName)};
}

}  // namespace

Message parse_message(std::string_view text) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object())
    return Wrong{"expected one JSON object"};
  try {
    return read(json);
  } catch (const std::invalid_argument& error) {
    return Wrong{error.what()};
  }
}

std::optional<std::string> Upload::take(const LoadMap& piece) {
  if (piece.reference != reference_)  // another file
    text_.clear();
  reference_ = piece.reference;
  text_ += piece.text;
  if (text_.size() > kLargestFile) {
    text_.clear();
    throw std::invalid_argument(piece.name + ": expected a map file of at most 1 MB");
  }
  return piece.more ? std::nullopt : std::optional(std::exchange(text_, {}));
}

std::string to_json(const teleop::Control::State& state) {
  Json asked = Json::array();
  for (const auto& [id, name] : state.asked)
    asked.push_back({{"id", id}, {"name", name}});
  return Json{{"holder", state.holder},
              {"name", state.name},
              {"asked", asked},
              {"note", state.note},
              {"let_go", state.let_go}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<std::string> words_of(std::string_view text) {
  constexpr std::string_view kSpaces = " \t\n\r\v\f";
  std::vector<std::string> words;
  std::string word;
  bool begun = false;   // also by "", which is an empty word
  bool inside = false;  // of quotes
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      inside = !inside;
      begun = true;
    } else if (!inside && kSpaces.find(c) != std::string_view::npos) {
      if (begun)
        words.push_back(std::exchange(word, {}));
      begun = false;
    } else {
      const bool escapes =
          inside && c == '\\' && i + 1 < text.size() && (text[i + 1] == '"' || text[i + 1] == '\\');
      word += escapes ? text[++i] : c;
      begun = true;
    }
  }
  if (inside)
    throw std::invalid_argument("expected a closing \" behind \"" + word);
  if (begun)
    words.push_back(word);
  return words;
}

security::DoorRight right_for(const Message& message) {
  using security::DoorRight;
  const auto is = [&]<class... Kinds>(std::type_identity<Kinds>...) {
    return (std::holds_alternative<Kinds>(message) || ...);
  };
  if (is(std::type_identity<Ping>(), std::type_identity<Ack>(), std::type_identity<StopRobot>(),
         std::type_identity<EmergencyStop>(), std::type_identity<ShowRobots>(),
         std::type_identity<StopRobots>(), std::type_identity<SaveMap>()))
    return DoorRight::watch;
  return is(std::type_identity<ResetEmergencyStop>(), std::type_identity<AskProcess>(),
            std::type_identity<ChangeMap>(), std::type_identity<LoadMap>())
             ? DoorRight::operate
             : DoorRight::drive;
}

}  // namespace saphira::console
