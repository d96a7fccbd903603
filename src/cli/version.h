#pragma once

#include <string>

namespace flightwatt::cli {

/// The commit that the program was built of; empty where it is unknown. Programs alone define it (cmake/commit.cmake),
/// so that a new commit links them anew and compiles nothing.
[[gnu::weak]] const char* commit();

/// The version, and the commit in parentheses where it is known: "0.2.0 (c72d378)". For --version alone: files and JSON
/// have the version, because equal inputs give equal bytes at every commit.
std::string version_text();

}  // namespace flightwatt::cli
