#include "base/program_files.h"

#include "base/error.h"

#include <cstdlib>

#include <fmt/format.h>

namespace flightwatt {

std::filesystem::path program_folder() {
    std::error_code error;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::filesystem::path() : program.parent_path();
}

std::filesystem::path program_files(const std::string& name, const char* variable, const std::string& what) {
    const char* named = std::getenv(variable);
    auto folder = named != nullptr ? std::filesystem::path(named)
                                   : program_folder().parent_path() / "share" / "flightwatt" / name;
    std::error_code error;
    if (std::filesystem::is_directory(folder, error)) return folder;
    throw InputError({folder.string()}, what + " are not there",
                     fmt::format("{} can name the project's folder {}/", variable, name));
}

}  // namespace flightwatt
