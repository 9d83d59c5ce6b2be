#pragma once

#include <string>
#include <string_view>

namespace saphira::internal {

/// The text without case, by Unicode and no locale; `options` of utf8proc say more. Of a text that
/// is not UTF-8 only A to Z change.
std::string without_case(std::string_view text, int options);

}  // namespace saphira::internal
