#include "base/format_version.h"

#include <cmath>

#include <fmt/format.h>

namespace flightwatt {

std::string format_line() { return fmt::format("format = {}\n", format_version); }

void require_known_format(const TomlTable& root) {
    const double format = root.optional_number("format").value_or(format_version);
    if (format < 1.0 || format != std::floor(format)) {
        throw InputError(root.where("format"), fmt::format("format = {} is no version of a format", format),
                         fmt::format("expected a whole number from 1 to {}", format_version));
    }
    if (format <= format_version) return;
    throw InputError(
        root.where("format"),
        fmt::format("format = {} is newer than this program, which reads formats up to {}", format, format_version),
        "use a newer FlightWatt, or write the file with this one");
}

}  // namespace flightwatt
