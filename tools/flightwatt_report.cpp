// flightwatt report: a batch's folder and missions to one HTML page, and to figures for papers.

#include "base/error.h"
#include "base/number.h"
#include "base/text.h"
#include "cli/output/battery_output.h"
#include "cli/output/mission_output.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "mission/mission_file.h"
#include "report/figure.h"
#include "report/html.h"
#include "report/page.h"
#include "report/report.h"
#include "stages.h"

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/chrono.h>

namespace {

using namespace flightwatt;

std::optional<double> figure_width_pt(const cli::StageCall& call) {
    const auto width = call.get_optional<std::string>("figure-width");
    if (!width) return std::nullopt;
    if (!call.has("figures")) throw UsageError("--figure-width is that of the files of --figures DIR");
    return report::parse_figure_width_pt(*width);
}

report::ReportInput read_inputs(const cli::StageCall& call) {
    report::ReportInput inputs;
    inputs.capacity_ah = cli::capacity_option(call);
    figure_width_pt(call);  // a bad one is refused before any work
    inputs.published_file = call.get_optional<std::string>("published");
    inputs.with_replay = call.has("replay");
    for (const auto& input : call.inputs) {
        std::error_code error;
        if (!std::filesystem::is_directory(input, error)) {
            inputs.missions.push_back(mission::read_mission(input, {true, std::nullopt}));
            cli::warn_of_setup(call, setup_of(inputs.missions.back()));
            continue;
        }
        inputs.outs.emplace_back(input);
    }
    return inputs;
}

/// Now, or what SOURCE_DATE_EPOCH says (reproducible-builds.org).
std::string time_of_report() {
    std::time_t now = std::time(nullptr);
    if (const char* given = std::getenv("SOURCE_DATE_EPOCH")) {
        const auto seconds = parse_unsigned(given);
        if (!seconds) throw UsageError(fmt::format("SOURCE_DATE_EPOCH is '{}', expected seconds", given));
        now = static_cast<std::time_t>(*seconds);
    }
    return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(now));
}

/// Where figures are wanted as files.
void write_figure_files(const cli::StageCall& call, const std::vector<report::Section>& sections,
                        const report::WebFiles& web) {
    const auto folder = call.get_optional<std::string>("figures");
    if (!folder) return;
    const auto files = write_figures(sections, web, *folder, figure_width_pt(call));
    cli::note(call, fmt::format("{} figures in {}: .vl.json{}{}", files.figures, *folder, files.has_svg ? ", .svg" : "",
                                files.has_pdf ? ", .pdf" : ""));
    if (!files.has_svg) cli::warn(call, "node is not there: no figure was rendered");
    if (files.has_svg && !files.has_pdf) cli::warn(call, "rsvg-convert is not there: no PDF was made");
}

report::ReportLog log_of(const cli::StageCall& call) {
    return {[&](const std::string& text) { cli::warn(call, text); },
            [&](const std::string& text) { cli::note(call, text); },
            [](const std::string& unit) -> report::Progress {
                const auto bar = std::make_shared<cli::ProgressBar>(unit);
                return [bar](std::size_t done, std::size_t all) { bar->show(done, all); };
            }};
}

int write_page(const cli::StageCall& call) {
    auto input = read_inputs(call);
    if (input.with_replay && (input.outs.empty() || input.missions.empty()))
        throw UsageError(
            "--replay flies missions on a batch's flights: give a folder of flightwatt batch and missions");
    const bool wants_page = call.output || (!call.json && !call.has("figures"));
    std::optional<report::WebFiles> web;  // read before the work: where they are missing, that is told at once
    if (wants_page || call.has("figures")) web = report::read_web_files(report::web_folder());
    report::PageHead head{"FlightWatt report",
                          {{"computed", time_of_report()}, {"by", "flightwatt " FLIGHTWATT_VERSION}}};
    if (const auto title = call.get_optional<std::string>("title")) head.title = valid_utf8(*title);
    if (const auto folder = call.get_optional<std::string>("reference-figures")) {
        input.figures = report::read_published_figures(*folder);
        head.facts.emplace_back("beside", "the paper's Figs. 2 (c-e), 3 (a, b) and 4, digitised");
    }
    const auto content = make_report(input, log_of(call));
    std::ranges::copy(content.facts, std::back_inserter(head.facts));
    if (web) write_figure_files(call, content.sections, *web);
    if (wants_page) cli::write_result(call, page_html(head, content.sections, *web));
    if (!call.json) return cli::ok;
    cli::Json json{{"title", head.title}};
    json.update(content.summary);
    cli::print(cli::json_text(json));
    return cli::ok;
}

}  // namespace

int flightwatt::stages::report_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "report", "[OUT...] [MISSION.toml...] -o report.html",
        R"(Writes one HTML page, to be opened offline, of what flightwatt batch left in the folder OUT (flights,
model, validation, battery; of several folders each its own) and of missions (software, schedules, quality
of service, plan). Its figures are Vega-Lite specifications with their data; --figures writes them as files
for papers: .vl.json, .svg (by node) and .pdf (where rsvg-convert is). The model is the batch's own, with
the bands that the batch stored.)"};
    auto add = stage.options.add_options();
    add("figures", cli::output_file("DIR"), "write every figure to DIR");
    add("figure-width", cli::value("WIDTH"), "of those files: 3.5in, 89mm ...; their type is then set at 8 points");
    add("published", cli::input_file("MODEL.toml"), "show Table I beside this model's");
    add("reference-figures", cli::input_file("DIR"),
        "show the paper's figures, digitised, beside ours: fig2_cruise.csv and others");
    add("title", cli::value("TITLE"), "of the page");
    add("capacity", cli::value<double>("AH"),
        "the capacity of the flights' battery; without it that of the missions' pack, if it is of these flights, or "
        "else what flightwatt battery would say");
    add("replay", "fly the missions' schedules on the power that the batch's flights measured (flightwatt replay)");
    return cli::run_stage(argc, argv, stage, write_page);
}
