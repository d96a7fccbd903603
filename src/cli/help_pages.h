#pragma once

#include <filesystem>
#include <string>
#include <string_view>
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

/// To the standard output; where that is a terminal, through $PAGER or else less, if there is one. Throws
/// OutputError as print().
void show_page(std::string_view text);

}  // namespace flightwatt::cli
