#include "report/figure_files.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/number.h"
#include "base/overwrite_guard.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <system_error>
#include <vector>

#include <boost/process/args.hpp>
#include <boost/process/io.hpp>
#include <boost/process/system.hpp>
#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// Runs a program of the PATH with its output on standard error; false if it is not installed. Throws OutputError if it
/// fails.
bool run_program(std::vector<std::string> command) {
    namespace bp = boost::process;
    constexpr int not_installed = 127;
    const auto program = command.front();
    command.insert(command.begin(), {"-c", R"(command -v "$0" > /dev/null || exit 127; exec "$0" "$@")"});
    std::error_code error;
    const int code = bp::system("/bin/sh", bp::args(command), bp::std_out > stderr, error);
    if (error) throw OutputError(fmt::format("cannot run {}: {}", program, error.message()));
    if (code != 0 && code != not_installed)
        throw OutputError(fmt::format("{} failed with exit code {}", program, code));
    return code == 0;
}

/// Vega uses CSS pixels of 1/96 inch.
constexpr double px_per_pt = 96.0 / 72.0;
constexpr double default_width_px = 720.0;

/// The theme for papers: with a width all type has 8 points, as figures are not scaled.
VegaJson in_type_of_papers(const VegaJson& theme, const FigureLayout& layout) {
    constexpr double type_pt = 8.0;
    auto values = theme.flatten();
    for (auto& [path, value] : values.items())
        if (layout.width_pt && (path.ends_with("FontSize") || path.ends_with("/fontSize"))) value = type_pt * px_per_pt;
    if (layout.width_pt) values["/style/panel-name/fontWeight"] = "normal";
    if (layout.is_serif) values["/font"] = "'Times New Roman', 'Liberation Serif', 'DejaVu Serif', serif";
    return values.unflatten();
}

/// The specification with the light theme, for any Vega-Lite.
std::string standalone(const Figure& figure, const VegaJson& light_theme) {
    auto spec = figure.spec;
    spec["config"] = light_theme;
    return spec.dump(1, ' ', false, VegaJson::error_handler_t::replace) + "\n";
}

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

FigureFiles write_figures(std::span<const Figure> figures, const std::filesystem::path& tools,
                          const std::filesystem::path& folder, const FigureLayout& layout) {
    for (const auto& figure : figures)
        for (const auto* ending : {".vl.json", ".svg", ".pdf"}) register_output(folder / (figure.id + ending));
    make_directories(folder);
    constexpr double landscape = 0.75;  // of the width
    const auto theme = in_type_of_papers(VegaJson::parse(read_file(tools / "theme.json")).at("light"), layout);
    FigureFiles files{figures.size()};
    const double width_px = layout.width_pt ? *layout.width_pt * px_per_pt : default_width_px;
    const double height_px = layout.height_pt.value_or(landscape * layout.width_pt.value_or(0.0)) * px_per_pt;
    std::vector<std::string> render{"node", (tools / "render.mjs").string(), folder.string(),
                                    fmt::format("{}", width_px), fmt::format("{}", height_px)};
    for (const auto& figure : figures) {
        write_file_atomically(folder / (figure.id + ".vl.json"), standalone(figure, theme));
        render.push_back(figure.id);  // only these: the folder may contain others
    }
    files.has_svg = run_program(render);
    files.has_pdf = files.has_svg;
    for (const auto& figure : figures) {
        if (!files.has_pdf) break;
        const auto file = (folder / figure.id).string();
        files.has_pdf = run_program({"rsvg-convert", "--format", "pdf", "--output", file + ".pdf", file + ".svg"});
    }
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
