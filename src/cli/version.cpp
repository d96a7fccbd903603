#include "cli/version.h"

#include <string_view>

#include <fmt/format.h>

namespace flightwatt::cli {

std::string version_text() {
    const std::string_view known = commit != nullptr ? commit() : "";
    return known.empty() ? FLIGHTWATT_VERSION : fmt::format(FLIGHTWATT_VERSION " ({})", known);
}

}  // namespace flightwatt::cli
