#include "report/report.h"

#include "base/parallel.h"
#include "cli/output/fit_output.h"
#include "cli/output/physical_output.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/table_one.h"
#include "mission/mission_file.h"
#include "mission/replay.h"
#include "report/sections/sections.h"
#include "report/trends_section.h"

#include <algorithm>
#include <future>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

/// The report while its sections are added.
struct Draft {
    const ReportInput& input;
    const ReportLog& log;
    ReportContent content = {};
    PageSummary answers = {};
    std::vector<ReportFlight> flights = {};
    std::vector<mechanical::MechanicalModel> models = {};  ///< of the folders that have one
};

/// "There is no model of these flights", with the folder where there are several.
std::string of_folder(const SectionScope& of, const std::string& text) {
    return of.folder.empty() ? text : of.folder + ": " + text;
}

std::string origin_of_model(const BatchContent& content, const SectionScope& of) {
    const auto& options = content.fit->options;
    auto text = fmt::format("Fitted by flightwatt batch to the flights {}above (order {}, weights: {}).",
                            of.folder.empty() ? "" : fmt::format("of {} ", of.folder), options.phases.order,
                            to_string(options.weighting));
    return any_synthetic(content.flights) ? text + " SYNTHETIC flights are simulated, not flown." : text;
}

/// The flights' model with its validation.
void add_model(Draft& page, const BatchContent& content, const SectionScope& of) {
    auto& notes = page.answers.notes;
    auto& sections = page.content.sections;
    if (!content.fit) {
        notes.push_back(of_folder(of, "There is no model of these flights: the batch could not fit them."));
        return;
    }
    page.models.push_back(content.fit->model);
    for (const auto& warning : model_warnings(content.fit->model))
        page.answers.warnings.push_back(of_folder(of, warning));
    const auto& published = page.input.published_file;
    ReportModel model{content.fit->model, origin_of_model(content, of), content.fit->bands};
    model.table_one = cli::model_table(
        content.fit->model, published ? std::optional(mechanical::read_mechanical_model(*published)) : std::nullopt,
        mechanical::TableIntervals::present);
    sections.push_back(model_section(model, page.input.figures, of.id("model")));
    sections.back().title = of.title(sections.back().title);
    sections.back().latex = model_latex(content.fit->model);
    if (content.measured.size() < 2 || content.measured.size() > max_validation_flights) {
        notes.push_back(
            of_folder(of, fmt::format("The model is not validated: it needs 2 to {} flights and has {}; use "
                                      "flightwatt validate.",
                                      max_validation_flights, content.measured.size())));
        return;
    }
    if (auto section = physical_section(content.measured, of)) sections.push_back(std::move(*section));
    auto validated = leave_one_out(content.measured, content.fit->options, page.log.progress("fits"));
    if (const auto rejected = remove_rejected(validated); !rejected.empty())
        notes.push_back(of_folder(of, rejected + "."));
    const bool synthetic = any_synthetic(content.flights);
    page.answers.validated.push_back({of.folder, std::move(validated), synthetic});
    sections.push_back(validation_section(page.answers.validated.back().flights, synthetic, of));
}

/// Flights, and of each folder model, validation and battery.
void add_batches(Draft& page, std::vector<BatchContent>& batches) {
    const auto& input = page.input;
    battery::IdentificationOptions identification;
    identification.capacity_ah = input.capacity_ah;
    std::vector<std::future<std::optional<ReportBattery>>> batteries;
    std::vector<std::string> mixes;
    for (const auto& content : batches) {
        for (const auto& damaged : content.damaged) page.log.warn(damaged);
        mixes.push_back(aircraft_mix(content));
        // Of many flights, it takes as long as their figures do.
        batteries.push_back(std::async(std::launch::async, [&, is_mix = !mixes.back().empty()] {
            return is_mix ? std::nullopt
                          : std::optional(identify_for_report(content.flights, identification, max_battery_flights,
                                                              input.missions));
        }));
    }
    auto& sections = page.content.sections;
    const auto at = static_cast<std::ptrdiff_t>(sections.size());
    const auto add_flights = [&](std::span<const ReportFlight> flights) {
        sections.insert(sections.begin() + at, flights_section(flights, batches, page.log.progress("flights")));
    };
    if (batches.size() == 1) add_flights(batches.front().flights);
    for (std::size_t i = 0; i < batches.size(); ++i) {
        const SectionScope of{batches[i].folder, i == 0 ? "" : fmt::format("-{}", i + 1)};
        add_model(page, batches[i], of);
        if (const auto identified = batteries[i].get()) {
            sections.push_back(battery_section(*identified, of));
        } else {
            page.answers.notes.push_back(
                of_folder(of, "There is no battery of flights of several aircraft: " + mixes[i] + "."));
        }
    }
    page.flights = take_shown_flights(batches);
    if (batches.size() > 1) add_flights(page.flights);
}

/// Trends of aircraft and packs over their flights' dates, where there are any.
void add_trends(Draft& page) {
    std::vector<const ReportFlight*> usable;
    for (const auto& flight : page.flights)
        if (flight.rejected.empty() && flight.unusable_power.empty()) usable.push_back(&flight);
    std::vector<FlightTrendData> flights(usable.size());
    for_each_in_parallel(usable.size(), [&](std::size_t i) { flights[i] = extract_trend_data(*usable[i]); });
    if (!trends_section(trends_of(flights))) return;  // without dates, packs have no trend either: saves their time
    const auto notes = add_state_of_health(flights, max_battery_flights, page.input.capacity_ah);
    auto section = trends_section(trends_of(flights));
    section->html += list_html(notes);
    page.content.sections.push_back(std::move(*section));
}

/// "3 logs, from out; 5 logs, from other".
std::string origin_of_flights(std::span<const std::filesystem::path> outs, std::span<const BatchContent> batches) {
    std::vector<std::string> origins;
    for (std::size_t i = 0; i < outs.size(); ++i)
        origins.push_back(fmt::format("{} logs, from {}", batches[i].flights.size(), outs[i].string()));
    return fmt::format("{}", fmt::join(origins, "; "));
}

void add_missions(Draft& page) {
    const auto& missions = page.input.missions;
    std::vector<std::string> names;
    for (const auto& mission : missions) names.push_back(setup_of(mission).file);
    page.content.facts.emplace_back("missions", fmt::format("{}", fmt::join(names, ", ")));
    page.answers.missions = simulate_for_report(missions, page.log.progress("missions"));
    const auto progress = page.log.progress("answers");
    for (const auto& simulated : page.answers.missions) {
        if (progress) progress(page.answers.answers.size(), missions.size());
        const std::filesystem::path file = names[page.answers.answers.size()];
        page.answers.answers.push_back(assess_mission(simulated, [&](const mission::MissionReadOptions& reading) {
            return mission::read_mission(file, reading);
        }));
    }
    std::ranges::move(mission_sections(page.answers.missions, page.input.figures, page.models),
                      std::back_inserter(page.content.sections));
}

/// The missions on the power that the flights of the batches measured.
std::vector<mission::Replay> replay_missions(const ReportInput& input, std::span<const BatchContent> batches,
                                             const ReportLog& log) {
    std::vector<mission::Replay> replays;
    for (const auto& content : batches) {
        mission::ReplayOptions options;
        if (content.fit) options.fit = content.fit->options;
        auto flights = flights_with_power(content);
        for (const auto& shown : content.flights)
            if (shown.is_shown_elsewhere)
                std::erase_if(flights, [&](const auto& flight) { return flight.samples.flight == shown.name; });
        auto result = replay_flights(input.missions, flights, options);
        for (const auto& skipped : result.not_replayed)
            log.warn(fmt::format("{}: {} is not replayed on it: {}", skipped.flight, skipped.mission, skipped.reason));
        std::ranges::move(result.replays, std::back_inserter(replays));
    }
    return replays;
}

struct FigureOutput {
    std::string id, section, description;
};

Fields<FigureOutput> record_fields(const FigureOutput*) {
    using R = FigureOutput;
    return {field("id", &R::id, "file name of the figure"), field("section", &R::section, "section of the page"),
            field("description", &R::description, "description of the figure")};
}

/// JSON of the page.
struct PageOutput {
    std::string title;
    std::vector<MissionOutput> missions;
    std::vector<std::string> aircraft;
    std::string prediction;
    std::vector<std::string> warnings, notes;
    std::vector<FigureOutput> figures;
};

Fields<PageOutput> record_fields(const PageOutput*) {
    using R = PageOutput;
    return {field("title", &R::title, "title of the page"),
            field("missions", &R::missions, "missions"),
            field("aircraft", &R::aircraft, "each aircraft with its flights"),
            field("prediction", &R::prediction, "errors of the models for hold-out flights"),
            field("warnings", &R::warnings, "warnings of the fit"),
            field("notes", &R::notes, "missing contents"),
            field("figures", &R::figures, "figures")};
}

Json summary_json(const Draft& page) {
    PageOutput output{.title = {},
                      .missions = {},
                      .aircraft = aircraft_lines(page.flights),
                      .prediction = fmt::format("{}", fmt::join(prediction_lines(page.answers.validated), "; ")),
                      .warnings = page.answers.warnings,
                      .notes = page.answers.notes,
                      .figures = {}};
    for (const auto& section : page.content.sections)
        for (const auto& figure : section.figures)
            output.figures.push_back({figure.id, section.title, figure.description});
    for (std::size_t i = 0; i < page.answers.missions.size(); ++i)
        output.missions.push_back({&page.answers.missions[i], &page.answers.answers[i]});
    return record_json(output);
}

}  // namespace

ReportContent make_report(const ReportInput& input, const ReportLog& log) {
    Draft page{input, log};
    auto& [facts, sections, summary] = page.content;
    auto batches = read_batch_contents(input.outs);
    std::vector<mission::Replay> replays;
    if (input.with_replay) replays = replay_missions(input, batches, log);
    if (!batches.empty()) {
        facts.emplace_back("flights", origin_of_flights(input.outs, batches));
        add_batches(page, batches);
        add_trends(page);
    }
    if (!input.missions.empty()) add_missions(page);
    if (!replays.empty()) sections.push_back(replay_section(replays));
    if (input.with_replay && replays.empty())
        page.answers.notes.emplace_back("There is no replay: no mission could be replayed on any flight.");
    sections.insert(sections.begin(), summary_section(page.answers, page.flights));
    summary = summary_json(page);
    return std::move(page.content);
}

std::string model_latex(const mechanical::MechanicalModel& model) {
    const bool has_errors =
        std::ranges::any_of(flight::all_phases, [&](auto phase) { return model.phases[phase].errors.has_value(); });
    auto text = mechanical::to_latex(
        table_one(model, has_errors ? mechanical::TableIntervals::present : mechanical::TableIntervals::absent));
    if (model.physical) {
        text += "\n" + to_latex(cli::constants_table(*model.physical),
                                "Constants of the physical model, with 95 % intervals", "tab:physical-model");
    }
    return text;
}

Json summary_schema() { return record_schema<PageOutput>(); }

}  // namespace flightwatt::report
