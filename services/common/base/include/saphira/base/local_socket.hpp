#pragma once

#include <string>

namespace saphira {

/// A descriptor that is connected to the local socket of that path; -1 with errno where nobody
/// listens. The caller closes it. `flags`: of socket(), such as SOCK_NONBLOCK.
int connect_local(const std::string& path, int flags = 0);

}  // namespace saphira
