#include "report/figure_files.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/number.h"
#include "base/overwrite_guard.h"
#include "base/temporary_folder.h"
#include "report/figures/run_program.h"

#include <algorithm>
#include <map>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace flightwatt::report {
namespace {

/// Vega uses CSS pixels of 1/96 inch.
constexpr double px_per_pt = 96.0 / 72.0;

}  // namespace

std::filesystem::path figure_tools(const std::filesystem::path& web) {
    for (const std::string library : {"vega", "vega-lite"}) {
        const auto file = web / "node_modules" / library / "build" / (library + ".min.js");
        if (open_error(file))
            throw InputError({file.string()}, "this library of the figures is missing",
                             "run scripts/install_dependencies with access to the npm registry");
    }
    return web;
}

FigureFiles write_figures(const Json& document, const std::filesystem::path& tools, const std::filesystem::path& folder,
                          const FigureLayout& layout) {
    constexpr double landscape = 0.75;  // of the width
    const double width_px = layout.width_pt.value_or(0.0) * px_per_pt;
    const double height_px = layout.height_pt.value_or(landscape * layout.width_pt.value_or(0.0)) * px_per_pt;
    make_directories(folder);
    const TemporaryFolder scratch(folder / fmt::format(".figures-{}.tmp", ::getpid()));
    write_file_atomically(scratch.path() / "document.json",
                          document.dump(-1, ' ', false, Json::error_handler_t::replace));
    FigureFiles files;
    if (!run_program({"node", (tools / "render.mjs").string(), scratch.path().string(), fmt::format("{}", width_px),
                      fmt::format("{}", height_px), layout.is_serif ? "serif" : "sans"}))
        return files;
    for (const auto& entry : std::filesystem::directory_iterator(scratch.path()))
        if (entry.path().extension() == ".svg") files.names.push_back(entry.path().stem().string());
    std::ranges::sort(files.names);
    files.has_pdf = true;
    for (const auto& name : files.names) {
        const auto file = (scratch.path() / name).string();
        files.has_pdf =
            files.has_pdf && run_program({"rsvg-convert", "--format", "pdf", "--output", file + ".pdf", file + ".svg"});
    }
    for (const auto& name : files.names)
        for (const auto* ending : {".vl.json", ".svg", ".pdf"}) register_output(folder / (name + ending));
    for (const auto& name : files.names)
        for (const std::string ending : {".vl.json", ".svg", ".pdf"})
            if (std::error_code absent; std::filesystem::exists(scratch.path() / (name + ending), absent))
                std::filesystem::rename(scratch.path() / (name + ending), folder / (name + ending));
    return files;
}

double parse_figure_length_pt(const std::string& option, const std::string& text) {
    static const std::map<std::string, double> points_of{
        {"in", 72.0}, {"cm", 72.0 / 2.54}, {"mm", 7.2 / 2.54}, {"pt", 1.0}};
    constexpr double min_pt = 1.5 * 72.0;
    constexpr double max_pt = 20.0 * 72.0;
    const auto unit_at = std::min(text.find_first_not_of("0123456789."), text.size());
    const auto unit = points_of.find(text.substr(unit_at));
    const auto number = parse_number(std::string_view(text).substr(0, unit_at));
    if (!number || unit == points_of.end())
        throw UsageError(
            fmt::format("--{} {}: expected a length with its unit: 3.5in, 89mm, 9cm or 252pt", option, text));
    const double length_pt = *number * unit->second;
    if (!(length_pt >= min_pt && length_pt <= max_pt))
        throw UsageError(fmt::format("--{} {}: expected 1.5in to 20in", option, text));
    return length_pt;
}

}  // namespace flightwatt::report
