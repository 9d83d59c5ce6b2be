#pragma once

#include <string>

#include "saphira/base/descriptor.hpp"

namespace saphira {

/// A descriptor that is connected to the local socket of that path; none with errno where nobody
/// listens. `flags`: of socket(), such as SOCK_NONBLOCK. EPERM: it is in a folder that everybody
/// may write, such as /tmp, and another user than this one or root listens there.
Descriptor connect_local(const std::string& path, int flags = 0);

}  // namespace saphira
