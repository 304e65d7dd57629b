#pragma once

#include <map>
#include <string>

namespace mcdbn {

/// The text of every file in report/, by name; embedded at build time.
const std::map<std::string, std::string>& page_files();

}  // namespace mcdbn
