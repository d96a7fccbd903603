// flightwatt report: a batch's folder and missions to one HTML page, and to figures for papers.

#include "base/error.h"
#include "base/number.h"
#include "cli/numeric_options.h"
#include "cli/output/fit_output.h"
#include "cli/output/json_text.h"
#include "cli/output/mission_output.h"
#include "cli/progress.h"
#include "cli/stage.h"
#include "mechanical/model_check.h"
#include "mission/mission_file.h"
#include "report/answers_section.h"
#include "report/batch_content.h"
#include "report/battery_section.h"
#include "report/figure_files.h"
#include "report/flights_section.h"
#include "report/missions_section.h"
#include "report/model_section.h"
#include "report/page.h"
#include "report/physical_section.h"
#include "report/replay_section.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <future>
#include <iterator>

#include <fmt/chrono.h>

namespace {

using namespace flightwatt;

struct ReportInputs {
    std::optional<std::filesystem::path> out;
    std::vector<mission::AnyMission> missions;
};

ReportInputs read_inputs(const cli::StageCall& call) {
    ReportInputs inputs;
    for (const auto& input : call.inputs) {
        std::error_code error;
        if (!std::filesystem::is_directory(input, error)) {
            inputs.missions.push_back(mission::read_mission(input, {true, std::nullopt}));
            cli::warn_of_setup(call, setup_of(inputs.missions.back()));
            continue;
        }
        if (inputs.out) {
            throw UsageError(fmt::format("two folders are given, {} and {}: expected one of flightwatt batch",
                                         inputs.out->string(), input));
        }
        inputs.out = input;
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

struct Page {
    report::PageHead head;
    std::vector<report::Section> sections;
    report::PageAnswers answers;
    std::vector<report::ReportFlight> flights;
    std::optional<mechanical::MechanicalModel> model;  ///< of the flights
};

/// The flights' model with its validation.
void add_model(Page& page, const cli::StageCall& call, const report::BatchContent& content,
               const report::PublishedFigures& figures) {
    if (!content.fit) {
        page.answers.notes.push_back("There is no model of these flights: the batch could not fit them.");
        return;
    }
    page.model = content.fit->model;
    page.answers.warnings = model_warnings(*page.model);
    auto model = report::model_of(*content.fit, cli::read_published(call));
    const bool synthetic = report::any_synthetic(content.flights);
    if (synthetic) {
        model.origin =
            report::all_synthetic(content.flights)
                ? "Fitted by flightwatt batch to the SYNTHETIC flights above: no aircraft flew them."
                : "Fitted by flightwatt batch to the flights above. Some are SYNTHETIC: no aircraft flew these.";
    }
    page.sections.push_back(model_section(model, figures, "model"));
    const auto most = cli::count_option(call, "max-validation-flights");
    if (content.measured.size() < 2 || content.measured.size() > most) {
        page.answers.notes.push_back(
            fmt::format("The model is validated with 2 to {} flights, and there are {}; flightwatt validate does it.",
                        most, content.measured.size()));
        return;
    }
    if (auto section = report::physical_section(content.measured)) page.sections.push_back(std::move(*section));
    cli::TerminalProgress validating("fits");
    page.answers.validated = leave_one_out(content.measured, content.fit->options, {}, validating.shown());
    page.sections.push_back(report::validation_section(page.answers.validated, synthetic));
}

/// What the batch's folder has to say: flights, model, validation and battery.
void add_batch(Page& page, const cli::StageCall& call, const std::filesystem::path& out,
               const report::PublishedFigures& figures) {
    battery::IdentificationOptions identification;
    identification.capacity_ah = cli::positive_option(call, "capacity", "Ah");
    auto content = report::read_batch_content(out);
    for (const auto& damaged : content.damaged) cli::warn(call, damaged);
    page.head.facts.emplace_back("flights", fmt::format("{} logs, from {}", content.flights.size(), out.string()));
    const auto mix = report::aircraft_mix(content);
    // Of many flights, it takes as long as their figures do.
    auto battery = std::async(std::launch::async, [&, most = cli::count_option(call, "max-battery-flights")] {
        return mix.empty() ? std::optional(identify_for_report(content.flights, identification, most)) : std::nullopt;
    });
    cli::TerminalProgress drawing("flights");
    page.sections.push_back(report::flights_section(
        content.flights, content.fit ? std::optional(content.fit->model) : std::nullopt,
        predict_each_minute(content, cli::count_option(call, "max-validation-flights")), drawing.shown()));
    add_model(page, call, content, figures);
    if (const auto identified = battery.get()) {
        page.sections.push_back(report::battery_section(*identified));
    } else {
        page.answers.notes.push_back("There is no battery of flights of several aircraft: " + mix + ".");
    }
    page.flights = std::move(content.flights);
}

/// What the missions come to: answers and evidence.
void add_missions(Page& page, const ReportInputs& inputs, const report::PublishedFigures& figures) {
    std::string names;
    for (const auto& mission : inputs.missions) names += (names.empty() ? "" : ", ") + setup_of(mission).file;
    page.head.facts.emplace_back("missions", names);
    cli::TerminalProgress flying("missions");
    page.answers.missions = report::simulate_for_report(inputs.missions, flying.shown());
    cli::TerminalProgress answering("answers");
    for (std::size_t i = 0; i < inputs.missions.size(); ++i) {
        answering.show(i, inputs.missions.size());
        const std::filesystem::path file = setup_of(inputs.missions[i]).file;
        page.answers.answers.push_back(report::answer_for(
            page.answers.missions[i],
            [&](const mission::MissionReading& reading) { return mission::read_mission(file, reading); }));
    }
    auto sections = mission_sections(page.answers.missions, figures, page.model);
    std::move(sections.begin(), sections.end(), std::back_inserter(page.sections));
}

/// The missions on the batch's flights.
void add_replay(Page& page, const cli::StageCall& call, const ReportInputs& inputs) {
    const auto content = report::read_batch_content(*inputs.out);
    mission::ReplayOptions options;
    if (content.fit) options.fit = content.fit->options;
    const auto replays = replay_flights(inputs.missions, report::flights_with_power(content), options);
    for (const auto& left : replays.not_replayed)
        cli::warn(call, fmt::format("{}: {} is not flown on it: {}", left.flight, left.mission, left.reason));
    if (replays.replays.empty())
        page.answers.notes.emplace_back("There is no replay: no mission could be flown on any flight.");
    else
        page.sections.push_back(report::replay_section(replays.replays));
}

nlohmann::ordered_json summary_json(const Page& page) {
    auto figures = nlohmann::ordered_json::array();
    for (const auto& section : page.sections) {
        for (const auto& figure : section.figures) {
            figures.push_back({{"id", figure.id}, {"section", section.title}, {"description", figure.description}});
        }
    }
    auto missions = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < page.answers.missions.size(); ++i)
        missions.push_back(to_json(page.answers.missions[i], page.answers.answers[i]));
    return {{"title", page.head.title},
            {"missions", missions},
            {"aircraft", report::aircraft_lines(page.flights)},
            {"prediction", report::prediction_line(page.answers.validated)},
            {"warnings", page.answers.warnings},
            {"notes", page.answers.notes},
            {"figures", figures}};
}

std::optional<double> figure_width_pt(const cli::StageCall& call) {
    const auto width = call.maybe<std::string>("figure-width");
    if (!width) return std::nullopt;
    if (!call.has("figures")) throw UsageError("--figure-width is that of the files of --figures DIR");
    return report::parse_figure_width_pt(*width);
}

/// Where figures are wanted as files.
void write_figure_files(const cli::StageCall& call, const std::vector<report::Section>& sections,
                        const report::WebFiles& web) {
    const auto folder = call.maybe<std::string>("figures");
    if (!folder) return;
    const auto files = write_figures(sections, web, *folder, figure_width_pt(call));
    cli::note(call, fmt::format("{} figures in {}: .vl.json{}{}", files.figures, *folder, files.has_svg ? ", .svg" : "",
                                files.has_pdf ? ", .pdf" : ""));
    if (!files.has_svg) cli::warn(call, "node is not there: no figure was rendered");
    if (files.has_svg && !files.has_pdf) cli::warn(call, "rsvg-convert is not there: no PDF was made");
}

/// Before any work, and whether they will be needed or not.
void refuse_bad_numbers(const cli::StageCall& call) {
    for (const auto* option : {"max-validation-flights", "max-battery-flights"}) cli::count_option(call, option);
    cli::positive_option(call, "capacity", "Ah");
    figure_width_pt(call);
}

int write_page(const cli::StageCall& call) {
    refuse_bad_numbers(call);
    const auto inputs = read_inputs(call);
    if (call.has("replay") && (!inputs.out || inputs.missions.empty()))
        throw UsageError(
            "--replay flies missions on a batch's flights: give a folder of flightwatt batch and missions");
    const bool wants_page = call.output || (!call.json && !call.has("figures"));
    std::optional<report::WebFiles> web;  // read before the work: where they are missing, that is told at once
    if (wants_page || call.has("figures")) web = report::read_web_files(report::web_folder());
    Page page;
    page.head.title = "FlightWatt report";
    if (const auto title = call.maybe<std::string>("title")) page.head.title = report::valid_utf8(*title);
    auto& facts = page.head.facts;
    facts = {{"computed", time_of_report()}, {"by", "flightwatt " FLIGHTWATT_VERSION}};
    report::PublishedFigures published;
    if (const auto folder = call.maybe<std::string>("reference-figures")) {
        published = report::read_published_figures(*folder);
        facts.emplace_back("beside", "the paper's Figs. 2 (c-e), 3 (a, b) and 4, digitised");
    }
    if (inputs.out) add_batch(page, call, *inputs.out, published);
    if (!inputs.missions.empty()) add_missions(page, inputs, published);
    if (call.has("replay")) add_replay(page, call, inputs);
    page.sections.insert(page.sections.begin(), report::answers_section(page.answers, page.flights));
    if (web) write_figure_files(call, page.sections, *web);
    if (wants_page) cli::write_result(call, page_html(page.head, page.sections, *web));
    if (call.json) cli::print(cli::json_text(summary_json(page)));
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    cli::StageDefinition stage{
        "report", "[OUT] [MISSION.toml...] -o report.html",
        R"(Writes one HTML page, to be opened offline, of what flightwatt batch left in the folder OUT (flights,
model, validation, battery) and of missions (software, schedules, quality of service, plan). Its figures are
Vega-Lite specifications with their data; --figures writes them as files for papers: .vl.json, .svg (by node)
and .pdf (where rsvg-convert is). The model is the batch's own, with the bands that the batch stored.)"};
    auto add = stage.options.add_options();
    add("figures", cli::output_file("DIR"), "write every figure to DIR");
    add("figure-width", cli::value("WIDTH"), "of those files: 3.5in, 89mm ...; their type is then set at 8 points");
    add("published", cli::input_file("MODEL.toml"), "show Table I beside this model's");
    add("reference-figures", cli::input_file("DIR"),
        "show the paper's figures, digitised, beside ours: fig2_cruise.csv and others");
    add("title", cli::value("TITLE"), "of the page");
    add("max-validation-flights", cli::value("N")->default_value("30"),
        "validate by leave-one-out with no more than N flights: the work grows with their square");
    add("capacity", cli::value<double>("AH"),
        "the capacity of the flights' battery; without it, what flightwatt battery would say");
    add("replay", "fly the missions' schedules on the power that the batch's flights measured (flightwatt replay)");
    add("max-battery-flights", cli::value("N")->default_value("12"),
        "identify the battery from no more than N flights: the work grows with their square");
    return cli::run_stage(argc, argv, stage, write_page);
}
