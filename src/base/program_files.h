#pragma once

#include <filesystem>
#include <string>

namespace flightwatt {

/// The folder of the running program; empty where the system does not tell.
std::filesystem::path program_folder();

/// A folder of files that come with the programs: what the environment variable `variable` says, or
/// ../share/flightwatt/NAME beside the folder of the running program, installed or not. Throws InputError
/// "`what` are not there" where it is absent.
std::filesystem::path program_files(const std::string& name, const char* variable, const std::string& what);

}  // namespace flightwatt
