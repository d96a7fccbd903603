#include "mission/file/named_file.h"

#include "base/error.h"
#include "base/input_file.h"

#include <system_error>

#include <fmt/format.h>

namespace flightwatt::mission {

std::filesystem::path named_file(const TomlTable& table, std::string_view key) {
    auto path = std::filesystem::path(table.file()).parent_path() / table.string(key);
    const auto error = open_error(path);
    if (error == std::errc::no_such_file_or_directory) {
        throw InputError(table.where(key), fmt::format("{}: there is no file {}", key, path.string()),
                         "paths are relative to the mission file");
    }
    if (error) {
        throw InputError(table.where(key),
                         fmt::format("{}: {} cannot be read: {}", key, path.string(), error.message()));
    }
    return path;
}

}  // namespace flightwatt::mission
