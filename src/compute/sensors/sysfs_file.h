#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::compute {

/// The first line of a sysfs file without its end; std::nullopt if it cannot be read.
std::optional<std::string> sysfs_text(const std::filesystem::path& file);

/// The number that a sysfs file holds; std::nullopt if there is none.
std::optional<double> sysfs_number(const std::filesystem::path& file);

/// The same of a file that must have one. Throws InputError naming it.
double require_sysfs_number(const std::filesystem::path& file);

/// The entries of a folder whose names begin with `prefix`, sorted; none if there is no such folder.
std::vector<std::filesystem::path> sysfs_entries(const std::filesystem::path& folder,
                                                 std::string_view prefix = "");

}  // namespace flightwatt::compute
