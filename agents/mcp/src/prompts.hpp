#pragma once

#include "saphira/mcp/session.hpp"

namespace saphira::mcp {

/// The usual jobs, as prompts that a person picks in the client: the answer to prompts/list.
Json prompts();
/// One of them with its arguments filled in: the answer to prompts/get. A text: the error.
Json prompt(const Json& name, const Json& arguments);

}  // namespace saphira::mcp
