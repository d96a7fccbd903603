// flightwatt report: a batch's folder and missions to one HTML page, and to figures for papers.

#include "base/parallel.h"
#include "base/text.h"
#include "cli/output/mission_output.h"
#include "cli/output/stage_options.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "mission/mission_file.h"
#include "report/figure_files.h"
#include "report/outline.h"
#include "report/page.h"
#include "report/report.h"
#include "stages.h"

#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

namespace {

using namespace flightwatt;

struct ReportArguments {
    std::optional<std::string> figures;
    std::optional<std::string> figure_width;
    std::optional<std::string> figure_height;
    bool figures_are_serif = false;
    std::optional<std::string> published;
    std::optional<std::string> title;
    std::optional<std::string> outline;
    std::optional<double> capacity_ah;
    bool with_replay = false;
    bool is_interactive = false;
};

report::FigureLayout figure_layout(const ReportArguments& arguments) {
    const auto length_pt = [](const std::string& option, const std::optional<std::string>& text) {
        return text ? std::optional(report::parse_figure_length_pt(option, *text)) : std::nullopt;
    };
    return {length_pt("figure-width", arguments.figure_width), length_pt("figure-height", arguments.figure_height),
            arguments.figures_are_serif};
}

report::ReportInput read_inputs(const cli::StageCall& call, const ReportArguments& arguments) {
    report::ReportInput inputs;
    inputs.capacity_ah = arguments.capacity_ah;
    figure_layout(arguments);  // a bad one is refused before any work
    inputs.published_file = arguments.published;
    inputs.with_replay = arguments.with_replay;
    inputs.is_interactive = arguments.is_interactive;
    if (arguments.outline) inputs.outlines = report::read_outlines(*arguments.outline);
    cli::MissionNames names;
    for (const auto& input : call.inputs) {
        std::error_code error;
        if (!std::filesystem::is_directory(input, error)) {
            const auto read = names.made_unique(call, mission::read_mission(input, {true, std::nullopt}));
            cli::warn_of_setup(call, setup_of(read));
            if (!setup_of(read).packs || inputs.with_replay) {
                inputs.missions.push_back(read);
                continue;
            }
            const auto& all = inputs.packs.emplace_back(fly_packs(read));
            if (!all.suffice) cli::warn(call, describe(all));
            for (const auto& flight : all.flights) inputs.missions.push_back(flight.mission);
            continue;
        }
        if (!inputs.out.empty())
            throw UsageError("give one folder of flightwatt batch: it takes the logs of several folders");
        inputs.out = input;
    }
    return inputs;
}

/// Where figures are wanted as files; returns their names.
std::vector<std::string> write_figure_files(const cli::StageCall& call, const ReportArguments& arguments,
                                            const report::ReportContent& content) {
    const auto& folder = arguments.figures;
    if (!folder) return {};
    const auto files =
        write_figures(content.document, report::figure_tools(report::web_folder()), *folder, figure_layout(arguments));
    if (files.names.empty())
        cli::warn(call, "node is not there: no figure was made");
    else
        cli::note(call, fmt::format("{} figures in {}: .vl.json, .svg{}", files.names.size(), *folder,
                                    files.has_pdf ? ", .pdf" : ""));
    if (!files.names.empty() && !files.has_pdf) cli::warn(call, "rsvg-convert is not there: no PDF was made");
    return files.names;
}

/// The command that gives the same, with names of files without their folders: the page goes to others.
std::string command_of(const cli::StageCall& call, const ReportArguments& arguments) {
    const auto name_of = [](const std::string& file) {
        return std::filesystem::absolute(file).lexically_normal().filename().string();
    };
    std::string command = "flightwatt report";
    for (const auto& input : call.inputs) command += " " + name_of(input);
    if (arguments.capacity_ah) command += fmt::format(" --capacity {:g}", *arguments.capacity_ah);
    if (arguments.published) command += " --published " + name_of(*arguments.published);
    if (arguments.outline) command += " --outline " + name_of(*arguments.outline);
    if (arguments.with_replay) command += " --replay";
    if (arguments.is_interactive) command += " --interactive";
    return valid_utf8(command + " -o " + name_of(call.output.value_or("report.html")));
}

report::ReportLog log_of(const cli::StageCall& call) {
    return {[&](const std::string& text) { cli::warn(call, text); },
            [](const std::string& unit) -> Progress {
                const auto bar = std::make_shared<cli::ProgressBar>(unit);
                return [bar](std::size_t done, std::size_t all) { bar->show(done, all); };
            }};
}

int write_page(const cli::StageCall& call, const ReportArguments& arguments) {
    auto input = read_inputs(call, arguments);
    if (input.with_replay && (input.out.empty() || input.missions.empty()))
        throw UsageError(
            "--replay flies missions on a batch's flights: give a folder of flightwatt batch and missions");
    if (const auto ending = std::filesystem::path(call.output.value_or("")).extension();
        !ending.empty() && ending != ".html" && ending != ".htm")
        throw UsageError(
            fmt::format("{}: a report is a web page: expected -o FILE.html; --figures DIR writes its "
                        "figures as .svg and .pdf",
                        *call.output));
    const bool wants_page = call.output || (!call.json && !arguments.figures);
    if (wants_page && !call.output && ::isatty(STDOUT_FILENO) == 1)
        throw UsageError("a page is not for a terminal: expected -o FILE.html");
    std::optional<report::FrontEnd> front_end;  // read first: missing files are an error before any work
    if (wants_page) front_end = report::read_front_end(report::web_folder());
    if (input.is_interactive) {
        if (!front_end || input.missions.empty())
            throw UsageError("--interactive is for the missions of a page: give missions and -o FILE.html");
        front_end->engine = report::read_engine(report::web_folder());
    }
    if (arguments.figures) report::figure_tools(report::web_folder());
    input.with_figures = arguments.figures.has_value();
    input.command = command_of(call, arguments);
    auto content = make_report(input, log_of(call));
    if (arguments.title)
        for (const auto* key : {"title", "name"}) content.document[key] = valid_utf8(*arguments.title);
    content.summary["figures"] = write_figure_files(call, arguments, content);
    if (wants_page) cli::write_result(call, page_html(content.document, *front_end));
    if (!call.json) return cli::ok;
    content.summary["title"] = content.document["title"];
    cli::print(cli::json_text(cli::json_document(call, content.summary)));
    return cli::ok;
}

}  // namespace

int flightwatt::stages::report_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "report", "[OUT] [MISSION.toml...] -o report.html",
        R"(Writes one HTML page, to be opened offline, of the folder OUT of flightwatt batch (flights, model,
validation, battery) and of missions (software, schedules, quality of service). --figures writes figures for
papers: .vl.json (Vega-Lite with the data), .svg (by node) and .pdf (where rsvg-convert is). The model is
the batch's own, with the bands that the batch stored.)"};
    stage.next = [](const auto&) { return "open it in a browser"; };
    stage.json_schema = [] { return cli::json_schema({report::summary_schema()}); };
    stage.examples = {"flightwatt report my missions/first.toml -o report.html",
                      "flightwatt report my --figures figures --figure-width 3.5in"};
    stage.uses_threads = true;
    ReportArguments arguments;
    auto& options = stage.options;
    options.add("figures", arguments.figures, cli::output_file("DIR"), "write every figure to DIR");
    options.add("figure-width", arguments.figure_width, {.value = "WIDTH", .needs = {"figures"}},
                "of those files: 3.5in, 89mm ...; their type is then set at 8 points");
    options.add("figure-height", arguments.figure_height, {.value = "HEIGHT", .needs = {"figures"}},
                "at most, of those files; default: 3/4 of --figure-width");
    options.add_choice<bool>("figure-font", arguments.figures_are_serif, {{"sans", false}, {"serif", true}},
                             {.value = "FONT", .needs = {"figures"}}, "of those files");
    options.add("published", arguments.published, cli::input_file("MODEL.toml"), "show Table I next to this model's");
    options.add("title", arguments.title, {.value = "TITLE"}, "of the page");
    options.add("outline", arguments.outline, cli::input_file("FILE.geojson"),
                "draw its lines and polygons below the flown tracks: a field, a coast, an airspace");
    cli::add_capacity_option(
        options, arguments.capacity_ah,
        "the capacity of the flights' battery; default: that of the missions' pack, if it is of these "
        "flights, or else the estimate of flightwatt battery");
    options.add("replay", arguments.with_replay,
                "fly the missions' schedules on the power that the batch's flights measured (flightwatt replay)");
    options.add("interactive", arguments.is_interactive,
                "put the program and the missions' files into the page (4 MB): sliders fly a mission again");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return write_page(call, arguments); });
}
