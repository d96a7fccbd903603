#include "report/web_files.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/program_files.h"

namespace flightwatt::report {

std::filesystem::path web_folder() {
    return program_files("web", "FLIGHTWATT_WEB", "the report's web files");
}

WebFiles read_web_files(const std::filesystem::path& folder) {
    WebFiles files;
    files.folder = folder;
    files.style = read_file(folder / "page.css");
    files.theme = read_file(folder / "theme.json");
    for (const auto* library : {"vega", "vega-lite", "vega-embed"}) {
        const auto path = folder / "node_modules" / library / "build" / (std::string(library) + ".min.js");
        if (!std::filesystem::exists(path)) {
            throw InputError({path.string()}, "the report's figures need this library, and it is not there",
                             "run scripts/install_dependencies with the npm registry at hand");
        }
        files.libraries += read_file(path) + "\n";
    }
    files.script = read_file(folder / "fit_width.js") + read_file(folder / "page.js");
    return files;
}

}  // namespace flightwatt::report
