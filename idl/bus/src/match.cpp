#include <fnmatch.h>

#include <sstream>

#include "internal.hpp"

namespace saphira::bus {
namespace {

int rank(const std::string& durability) {
  if (durability == "transient_local")
    return 1;
  if (durability == "transient")
    return 2;
  return durability == "persistent" ? 3 : 0;
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream stream(list);
  for (std::string part; std::getline(stream, part, ',');)
    parts.push_back(part);
  if (parts.empty())
    parts.emplace_back();
  return parts;
}

}  // namespace

namespace internal {

bool partitions_meet(const std::string& one, const std::string& other) {
  for (const auto& a : split(one))
    for (const auto& b : split(other))
      if (a == b || fnmatch(a.c_str(), b.c_str(), 0) == 0 || fnmatch(b.c_str(), a.c_str(), 0) == 0)
        return true;
  return false;
}

std::optional<std::string> mismatch_text(const EndpointEntry& own, const EndpointEntry& other,
                                         const std::string& name) {
  if (own.topic != other.topic || own.writer == other.writer)
    return std::nullopt;
  const std::string why = own.writer ? why_incompatible(own, other) : why_incompatible(other, own);
  if (why.empty())
    return std::nullopt;
  if (!partitions_meet(own.robot, other.robot))
    return std::string();
  const bool lockstep = why.starts_with("reliability") || why.starts_with("durability");
  return "topic " + own.topic + ": the " + (other.writer ? "writer" : "reader") + " of " + name +
         " does not match, " + why +
         (lockstep ? "; run both programs with --lockstep, or neither"
                   : "; are both programs of one version?");
}

}  // namespace internal

std::string why_incompatible(const EndpointEntry& writer, const EndpointEntry& reader) {
  if (writer.type != reader.type)
    return "type: offered " + writer.type + ", requested " + reader.type;
  if (reader.reliable && !writer.reliable)
    return "reliability: offered best effort, requested reliable";
  if (rank(writer.durability) < rank(reader.durability))
    return "durability: offered " + writer.durability + ", requested " + reader.durability;
  if (writer.ownership != reader.ownership)
    return "ownership: offered " + writer.ownership + ", requested " + reader.ownership;
  if (reader.deadline > 0.0 && (writer.deadline == 0.0 || writer.deadline > reader.deadline)) {
    std::ostringstream text;
    text << "deadline: offered ";
    if (writer.deadline > 0.0)
      text << writer.deadline << " s";
    else
      text << "none";
    text << ", requested " << reader.deadline << " s";
    return text.str();
  }
  if (writer.liveliness != reader.liveliness) {
    // The order of the kinds is not that of their names; a reader without lease requires a kind
    // only.
    const auto kind = [](const std::string& text) {
      return text.starts_with("manual_by_topic")         ? 2
             : text.starts_with("manual_by_participant") ? 1
                                                         : 0;
    };
    const auto lease = [](const std::string& text) {
      const auto space = text.find(' ');
      return space == std::string::npos ? 0.0 : std::stod(text.substr(space));
    };
    const double offered = lease(writer.liveliness);
    const double requested = lease(reader.liveliness);
    if (kind(writer.liveliness) < kind(reader.liveliness) ||
        (requested > 0.0 && (offered == 0.0 || offered > requested)))
      return "liveliness: offered " + writer.liveliness + ", requested " + reader.liveliness;
  }
  return {};
}

}  // namespace saphira::bus
