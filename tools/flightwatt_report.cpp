// flightwatt report: a batch's folder and missions to one HTML page, and to figures for papers.

#include "base/error.h"
#include "base/number.h"
#include "base/parallel.h"
#include "base/utf8.h"
#include "cli/numeric_options.h"
#include "cli/output/battery_output.h"
#include "cli/output/fit_output.h"
#include "cli/output/json_text.h"
#include "cli/output/mission_output.h"
#include "cli/progress.h"
#include "cli/stage.h"
#include "mechanical/model_check.h"
#include "mission/mission_file.h"
#include "report/batch_content.h"
#include "report/battery_section.h"
#include "report/figure_files.h"
#include "report/flights_section.h"
#include "report/missions_section.h"
#include "report/model_section.h"
#include "report/page.h"
#include "report/replay_section.h"
#include "report/summary_section.h"
#include "report/trends_section.h"
#include "stages.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <future>
#include <iterator>
#include <map>
#include <span>

#include <fmt/chrono.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;

struct ReportInputs {
    std::vector<std::filesystem::path> outs;
    std::vector<mission::MissionVariant> missions;
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

struct Page {
    report::PageHead head;
    std::vector<report::Section> sections;
    report::PageSummary answers;
    std::vector<report::ReportFlight> flights;
    std::vector<mechanical::MechanicalModel> models;  ///< of the folders that have one
};

/// "There is no model of these flights", with the folder where there are several.
std::string of_folder(const report::SectionScope& of, const std::string& text) {
    return of.folder.empty() ? text : of.folder + ": " + text;
}

/// The flights' model with its validation.
void add_model(Page& page, const cli::StageCall& call, const report::BatchContent& content,
               const report::PublishedFigures& figures, const report::SectionScope& of) {
    auto& notes = page.answers.notes;
    if (!content.fit) {
        notes.push_back(of_folder(of, "There is no model of these flights: the batch could not fit them."));
        return;
    }
    page.models.push_back(content.fit->model);
    for (const auto& warning : model_warnings(content.fit->model))
        page.answers.warnings.push_back(of_folder(of, warning));
    auto model = report::model_of(*content.fit, cli::read_published(call));
    const auto flights = of.folder.empty() ? "flights above" : fmt::format("flights of {} above", of.folder);
    model.origin = fmt::format("Fitted by flightwatt batch to the {}.", flights);
    const bool synthetic = report::any_synthetic(content.flights);
    if (synthetic) {
        model.origin =
            report::all_synthetic(content.flights)
                ? fmt::format("Fitted by flightwatt batch to the SYNTHETIC {}: no aircraft flew them.", flights)
                : fmt::format("Fitted by flightwatt batch to the {}. Some are SYNTHETIC: no aircraft flew these.",
                              flights);
    }
    page.sections.push_back(model_section(model, figures, of.id("model")));
    page.sections.back().title = of.title(page.sections.back().title);
    const auto most = cli::count_option(call, "max-validation-flights");
    if (content.measured.size() < 2 || content.measured.size() > most) {
        notes.push_back(of_folder(
            of,
            fmt::format("The model is validated with 2 to {} flights, and there are {}; flightwatt validate does it.",
                        most, content.measured.size())));
        return;
    }
    if (auto section = report::physical_section(content.measured, of)) page.sections.push_back(std::move(*section));
    cli::TerminalProgress validating("fits");
    auto validated = leave_one_out(content.measured, content.fit->options, {}, validating.callback());
    for (const auto& rejected : remove_rejected(validated)) notes.push_back(of_folder(of, rejected + "."));
    page.answers.validated.push_back({of.folder, std::move(validated), synthetic});
    page.sections.push_back(report::validation_section(page.answers.validated.back().flights, synthetic, of));
}

/// What was predicted in flight, of the flights that stand under the folder.
std::map<std::string, report::PredictedFlight> predicted_of(const report::BatchContent& content, std::size_t most) {
    auto predicted = predict_each_minute(content, most);
    for (const auto& flight : content.flights)
        if (flight.is_shown_elsewhere) predicted.erase(flight.name);
    return predicted;
}

/// What the flights of all folders are drawn with.
struct FigureContext {
    std::vector<std::optional<mechanical::MechanicalModel>> models;  ///< one a folder
    std::map<std::string, report::PredictedFlight> predicted;
};

FigureContext drawn_beside(std::span<const report::BatchContent> batches, std::size_t max_predicted) {
    FigureContext beside;
    for (const auto& content : batches) {
        beside.models.push_back(content.fit ? std::optional(content.fit->model) : std::nullopt);
        beside.predicted.merge(predicted_of(content, max_predicted));
    }
    return beside;
}

report::Section section_of_flights(std::span<const report::ReportFlight> flights, const FigureContext& beside) {
    cli::TerminalProgress drawing("flights");
    return report::flights_section(flights, beside.models, beside.predicted, drawing.callback());
}

/// What the folders have to say: flights, and of each folder model, validation and battery.
void add_batches(Page& page, const cli::StageCall& call, std::vector<report::BatchContent>& batches,
                 std::span<const mission::MissionVariant> missions, const report::PublishedFigures& figures) {
    battery::IdentificationOptions identification;
    identification.capacity_ah = cli::capacity_option(call);
    std::vector<std::future<std::optional<report::ReportBattery>>> batteries;
    std::vector<std::string> mixes;
    for (const auto& content : batches) {
        for (const auto& damaged : content.damaged) cli::warn(call, damaged);
        mixes.push_back(report::aircraft_mix(content));
        // Of many flights, it takes as long as their figures do.
        batteries.push_back(std::async(std::launch::async, [&, is_mix = !mixes.back().empty(),
                                                            most = cli::count_option(call, "max-battery-flights")] {
            return is_mix ? std::nullopt
                          : std::optional(identify_for_report(content.flights, identification, most, missions));
        }));
    }
    const auto at = page.sections.size();
    const auto beside = drawn_beside(batches, cli::count_option(call, "max-validation-flights"));
    if (batches.size() == 1) page.sections.push_back(section_of_flights(batches.front().flights, beside));
    for (std::size_t i = 0; i < batches.size(); ++i) {
        const report::SectionScope of{batches[i].folder, i == 0 ? "" : fmt::format("-{}", i + 1)};
        add_model(page, call, batches[i], figures, of);
        if (const auto identified = batteries[i].get()) {
            page.sections.push_back(report::battery_section(*identified, of));
        } else {
            page.answers.notes.push_back(
                of_folder(of, "There is no battery of flights of several aircraft: " + mixes[i] + "."));
        }
    }
    if (batches.size() == 1) {
        page.flights = std::move(batches.front().flights);
        return;
    }
    auto flights = report::take_shown_flights(batches);
    page.sections.insert(page.sections.begin() + static_cast<std::ptrdiff_t>(at), section_of_flights(flights, beside));
    page.flights = std::move(flights);
}

/// How the aircraft go over the dates of their flights; nothing where these tell no trend.
void add_trends(Page& page, const cli::StageCall& call) {
    std::vector<const report::ReportFlight*> usable;
    for (const auto& flight : page.flights)
        if (flight.rejected.empty() && flight.unusable_power.empty()) usable.push_back(&flight);
    std::vector<report::FlightTrendData> flights(usable.size());
    for_each_in_parallel(usable.size(), [&](std::size_t i) { flights[i] = extract_trend_data(*usable[i]); });
    if (!trends_section(trends_of(flights))) return;  // and so none of packs, whose work is long
    const auto notes =
        add_state_of_health(flights, cli::count_option(call, "max-battery-flights"), cli::capacity_option(call));
    auto section = trends_section(trends_of(flights));
    section->html += report::list_html(notes);
    page.sections.push_back(std::move(*section));
}

/// "3 logs, from out; 5 logs, from other".
std::string origin_of_flights(std::span<const std::filesystem::path> outs,
                              std::span<const report::BatchContent> batches) {
    std::string text;
    for (std::size_t i = 0; i < outs.size(); ++i) {
        text += fmt::format("{}{} logs, from {}", i == 0 ? "" : "; ", batches[i].flights.size(), outs[i].string());
    }
    return text;
}

/// What the missions come to: answers and evidence.
void add_missions(Page& page, const ReportInputs& inputs, const report::PublishedFigures& figures) {
    std::string names;
    for (const auto& mission : inputs.missions) names += (names.empty() ? "" : ", ") + setup_of(mission).file;
    page.head.facts.emplace_back("missions", names);
    cli::TerminalProgress flying("missions");
    page.answers.missions = report::simulate_for_report(inputs.missions, flying.callback());
    cli::TerminalProgress answering("answers");
    for (std::size_t i = 0; i < inputs.missions.size(); ++i) {
        answering.show(i, inputs.missions.size());
        const std::filesystem::path file = setup_of(inputs.missions[i]).file;
        page.answers.answers.push_back(report::assess_mission(
            page.answers.missions[i],
            [&](const mission::MissionReadOptions& reading) { return mission::read_mission(file, reading); }));
    }
    auto sections = mission_sections(page.answers.missions, figures, page.models);
    std::move(sections.begin(), sections.end(), std::back_inserter(page.sections));
}

/// The missions on the batch's flights.
void add_replay(Page& page, const cli::StageCall& call, const ReportInputs& inputs) {
    std::vector<mission::Replay> replays;
    for (const auto& content : report::read_batch_contents(inputs.outs).batches) {
        mission::ReplayOptions options;
        if (content.fit) options.fit = content.fit->options;
        auto flights = report::flights_with_power(content);
        for (const auto& shown : content.flights)
            if (shown.is_shown_elsewhere)
                std::erase_if(flights, [&](const auto& flight) { return flight.samples.flight == shown.name; });
        auto of_folder = replay_flights(inputs.missions, flights, options);
        for (const auto& left : of_folder.not_replayed)
            cli::warn(call, fmt::format("{}: {} is not flown on it: {}", left.flight, left.mission, left.reason));
        std::ranges::move(of_folder.replays, std::back_inserter(replays));
    }
    if (replays.empty())
        page.answers.notes.emplace_back("There is no replay: no mission could be flown on any flight.");
    else
        page.sections.push_back(report::replay_section(replays));
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
            {"prediction", fmt::format("{}", fmt::join(report::prediction_lines(page.answers.validated), "; "))},
            {"warnings", page.answers.warnings},
            {"notes", page.answers.notes},
            {"figures", figures}};
}

std::optional<double> figure_width_pt(const cli::StageCall& call) {
    const auto width = call.get_optional<std::string>("figure-width");
    if (!width) return std::nullopt;
    if (!call.has("figures")) throw UsageError("--figure-width is that of the files of --figures DIR");
    return report::parse_figure_width_pt(*width);
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

/// Before any work, and whether they will be needed or not.
void refuse_bad_numbers(const cli::StageCall& call) {
    for (const auto* option : {"max-validation-flights", "max-battery-flights"}) cli::count_option(call, option);
    cli::capacity_option(call);
    figure_width_pt(call);
}

int write_page(const cli::StageCall& call) {
    refuse_bad_numbers(call);
    const auto inputs = read_inputs(call);
    if (call.has("replay") && (inputs.outs.empty() || inputs.missions.empty()))
        throw UsageError(
            "--replay flies missions on a batch's flights: give a folder of flightwatt batch and missions");
    const bool wants_page = call.output || (!call.json && !call.has("figures"));
    std::optional<report::WebFiles> web;  // read before the work: where they are missing, that is told at once
    if (wants_page || call.has("figures")) web = report::read_web_files(report::web_folder());
    Page page;
    page.head.title = "FlightWatt report";
    if (const auto title = call.get_optional<std::string>("title")) page.head.title = valid_utf8(*title);
    auto& facts = page.head.facts;
    facts = {{"computed", time_of_report()}, {"by", "flightwatt " FLIGHTWATT_VERSION}};
    report::PublishedFigures published;
    if (const auto folder = call.get_optional<std::string>("reference-figures")) {
        published = report::read_published_figures(*folder);
        facts.emplace_back("beside", "the paper's Figs. 2 (c-e), 3 (a, b) and 4, digitised");
    }
    if (!inputs.outs.empty()) {
        auto contents = report::read_batch_contents(inputs.outs);
        page.answers.notes = contents.notes;
        facts.emplace_back("flights", origin_of_flights(inputs.outs, contents.batches));
        add_batches(page, call, contents.batches, inputs.missions, published);
        add_trends(page, call);
    }
    if (!inputs.missions.empty()) add_missions(page, inputs, published);
    if (call.has("replay")) add_replay(page, call, inputs);
    page.sections.insert(page.sections.begin(), report::summary_section(page.answers, page.flights));
    if (web) write_figure_files(call, page.sections, *web);
    if (wants_page) cli::write_result(call, page_html(page.head, page.sections, *web));
    if (call.json) cli::print(cli::json_text(summary_json(page)));
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
    add("max-validation-flights", cli::value("N")->default_value("30"),
        "validate by leave-one-out with no more than N flights: the work grows with their square");
    add("capacity", cli::value<double>("AH"),
        "the capacity of the flights' battery; without it that of the missions' pack, if it is of these flights, or "
        "else what flightwatt battery would say");
    add("replay", "fly the missions' schedules on the power that the batch's flights measured (flightwatt replay)");
    add("max-battery-flights", cli::value("N")->default_value("12"),
        "identify the battery from no more than N flights: the work grows with their square");
    return cli::run_stage(argc, argv, stage, write_page);
}
