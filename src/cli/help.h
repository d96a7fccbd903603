#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flightwatt::cli {

/// A page of the documentation that `flightwatt help TOPIC` shows.
struct HelpPage {
    std::string topic;  ///< its file's name without the ending: "missions"
    std::string title;  ///< its first heading
    std::filesystem::path file;
};

/// The pages (*.md) of a folder, by topic; none where the folder is absent.
std::vector<HelpPage> help_pages(const std::filesystem::path& folder);

/// The commit that the program was built of; empty where it is unknown. Programs alone define it (cmake/commit.cmake),
/// so that a new commit relinks them and compiles nothing.
[[gnu::weak]] const char* commit();

/// The version, and the commit in parentheses where it is known: "0.2.0 (c72d378)". For --version alone: files and JSON
/// have the version, because equal inputs give equal bytes at every commit.
std::string version_text();

}  // namespace flightwatt::cli
