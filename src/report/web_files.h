#pragma once

#include <filesystem>
#include <string>

namespace flightwatt::report {

/// What the page is made of besides its contents.
struct WebFiles {
    std::filesystem::path folder;
    std::string style;
    std::string theme;      ///< Vega's configuration in light and dark, JSON
    std::string libraries;  ///< Vega, Vega-Lite and Vega-Embed
    std::string script;     ///< the page's own
};

/// The folder web/ of these programs: ../share/flightwatt/web beside the folder of the running program, or
/// what FLIGHTWATT_WEB says. Throws InputError where it is absent.
std::filesystem::path web_folder();

/// Throws InputError where a file is missing, saying how to install the libraries.
WebFiles read_web_files(const std::filesystem::path& folder);

}  // namespace flightwatt::report
