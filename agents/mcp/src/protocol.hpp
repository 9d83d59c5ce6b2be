#pragma once

#include <string>

#include "saphira/mcp/session.hpp"

/// Words of the protocol that several parts of the session use.
namespace saphira::mcp {

constexpr int kBadRequest = -32600;
constexpr int kBadParameters = -32602;
constexpr int kNoResource = -32002;    // of the older era; the newer one has kBadParameters
constexpr int kNoCapability = -32021;  // the client has not declared it
inline const std::string kMeta = "io.modelcontextprotocol/";
inline const std::string kTasks = "io.modelcontextprotocol/tasks";
inline const std::string kResources = "saphira://robot/";

/// Null where the object has no such member.
inline const Json& member(const Json& object, const std::string& name) {
  static const Json none;
  const auto found = object.is_object() ? object.find(name) : object.end();
  return found == object.end() ? none : *found;
}

/// The usual jobs, as prompts that a person picks in the client: the answer to prompts/list.
Json prompts();
/// One of them with its arguments filled in: the answer to prompts/get. A text: the error.
Json prompt(const Json& name, const Json& arguments);

inline bool is_resource(const Tool& tool) {
  return tool.reads && member(tool.input, "properties").empty();
}

}  // namespace saphira::mcp
