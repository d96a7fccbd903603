#pragma once

#include "live/source.h"

#include <filesystem>
#include <memory>

namespace flightwatt::live {

/// The .data lines of the standard input, until it is closed.
std::unique_ptr<MessageSource> standard_input();

/// A .data file from its beginning, and what is written to it from then on, as the ground station does. Where the file
/// gets shorter or another takes its name, that is read from its beginning. Throws InputError where there is no such
/// file, or it is no regular one.
std::unique_ptr<MessageSource> follow_data_file(const std::filesystem::path& path);

}  // namespace flightwatt::live
