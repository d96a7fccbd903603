#include "compute/sensors/sysfs_file.h"

#include "base/error.h"
#include "base/number.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

namespace flightwatt::compute {

std::optional<std::string> sysfs_text(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string line;
    if (!std::getline(stream, line)) return std::nullopt;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    return line;
}

std::optional<double> sysfs_number(const std::filesystem::path& file) {
    const auto text = sysfs_text(file);
    return text ? parse_number(*text) : std::nullopt;
}

double require_sysfs_number(const std::filesystem::path& file) {
    const auto text = sysfs_text(file);
    if (!text) throw InputError({file.string()}, "the sensor cannot be read");
    if (const auto value = parse_number(*text)) return *value;
    throw InputError({file.string(), 1}, fmt::format("the sensor says '{}', expected a number", *text));
}

std::vector<std::filesystem::path> sysfs_entries(const std::filesystem::path& folder,
                                                 std::string_view prefix) {
    std::vector<std::filesystem::path> found;
    std::error_code none;
    for (std::filesystem::directory_iterator it(folder, none), end; it != end; it.increment(none)) {
        if (it->path().filename().string().starts_with(prefix)) found.push_back(it->path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace flightwatt::compute
