#pragma once

#include <string>
#include <string_view>

namespace mcdbn {

/// Whether these bytes are UTF-8 text (RFC 3629), which JSON and TOML take alone.
bool is_utf8(std::string_view bytes);

/// @param what "FILE: its name"  @throws InputError that asks to rename it
void require_utf8(std::string_view bytes, const std::string& what);

}  // namespace mcdbn
