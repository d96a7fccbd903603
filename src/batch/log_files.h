#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flightwatt {

/// A log that a batch is to do, and the name that its results go by.
struct LogFile {
    std::filesystem::path path;
    std::string flight;
};

/// The logs among files and folders (searched to the bottom for .data files, compressed or not), in the order
/// of their paths, each once however it is written. Flights of the same name get the names NAME, NAME_2, ...
/// Throws InputError for an input that does not exist, or where there is no log at all.
std::vector<LogFile> find_logs(const std::vector<std::string>& inputs);

}  // namespace flightwatt
