#include "report/report.h"

#include "base/error.h"
#include "base/number.h"
#include "base/parallel.h"
#include "batch/manifest.h"
#include "cli/output/fit_output.h"
#include "cli/output/pack_output.h"
#include "cli/output/physical_output.h"
#include "mechanical/table_one.h"
#include "mission/mission_file.h"
#include "mission/mission_read_options.h"
#include "mission/replay.h"
#include "report/sections/aircraft_panel.h"
#include "report/sections/battery_section.h"
#include "report/sections/flights_section.h"
#include "report/sections/missions_section.h"
#include "report/sections/model_section.h"
#include "report/sections/page_summary.h"
#include "report/sections/summary_section.h"
#include "report/sections/tracks_section.h"
#include "report/trends_section.h"

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <future>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/chrono.h>
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
    std::vector<mechanical::MechanicalModel> models = {};  ///< the batch's, if it has one
};

std::string origin_of_model(const BatchContent& batch) {
    const auto& options = batch.fit->options;
    return fmt::format("Fitted by flightwatt batch to the flights above (order {}, weights: {}).{}",
                       options.phases.order, to_string(options.weighting),
                       any_synthetic(batch.flights) ? " SYNTHETIC flights are simulated, not flown." : "");
}

/// The flights' model with its validation.
void add_model(Draft& page, const BatchContent& batch) {
    auto& notes = page.answers.notes;
    auto& sections = page.content.sections;
    if (!batch.fit) {
        notes.emplace_back("There is no model of these flights: the batch could not fit them.");
        return;
    }
    const auto& fitted = batch.fit->model;
    page.models.push_back(fitted);
    page.answers.warnings = model_warnings(fitted);
    page.answers.model = fitted;
    const auto& published = page.input.published_file;
    ReportModel model{fitted, origin_of_model(batch), batch.fit->bands};
    model.table_one = cli::model_table(
        fitted, published ? std::optional(mechanical::read_mechanical_model(*published)) : std::nullopt,
        mechanical::TableIntervals::present);
    sections.push_back(model_section(model, "model"));
    sections.back().latex = model_latex(fitted);
    if (batch.measured.size() < 2) {
        notes.emplace_back(
            "The model is not validated: that needs 2 flights, of which each is predicted by the other.");
        return;
    }
    if (auto section = physical_section(batch.measured)) {
        auto curves = fitted;
        curves.physical.reset();  // its constants are in that section
        sections.back().latex = model_latex(curves);
        sections.push_back(std::move(*section));
    }
    auto& validated = page.answers.validated;
    const auto chosen = mechanical::validated_flights(batch.measured);
    validated = leave_one_out(chosen, batch.fit->options, page.log.progress("fits"));
    if (chosen.size() < batch.measured.size())
        notes.push_back(
            fmt::format("The model is validated on {} of {} flights, evenly chosen, as by flightwatt batch.",
                        chosen.size(), batch.measured.size()));
    if (const auto rejected = remove_rejected(validated); !rejected.empty()) notes.push_back(rejected + ".");
    sections.push_back(validation_section(validated, any_synthetic(batch.flights)));
}

/// Flights, model, validation and battery.
void add_batch(Draft& page, const BatchContent& batch) {
    for (const auto& damaged : batch.damaged) page.log.warn(damaged);
    const auto mix = aircraft_mix(batch);
    std::future<ReportBattery> battery;
    if (mix.empty())  // of many flights, it takes as long as their figures do
        battery = std::async(std::launch::async, [&] {
            battery::IdentificationOptions options;
            options.capacity_ah = page.input.capacity_ah;
            return identify_for_report(batch.flights, options, max_battery_flights, page.input.missions);
        });
    auto& sections = page.content.sections;
    sections.push_back(flights_section(batch, page.log.progress("flights")));
    const auto shown = sections.size();
    add_model(page, batch);
    std::optional<ReportBattery> found;
    if (mix.empty())
        found = battery.get();
    else
        page.answers.notes.push_back("There is no battery of flights of several aircraft: " + mix + ".");
    if (found) {
        sections.push_back(battery_section(*found));
        page.answers.pack = found->identified;
    }
    for (auto i = shown; i < sections.size(); ++i) sections[i].place = SectionPlace::folded;
    if (auto tracks = tracks_section(batch, found ? &*found : nullptr, page.input.outlines))
        sections.insert(sections.begin() + static_cast<std::ptrdiff_t>(shown), std::move(*tracks));
}

/// Trends of aircraft and packs over their flights' dates, where there are any.
void add_trends(Draft& page, const BatchContent& batch) {
    std::vector<const ReportFlight*> usable;
    for (const auto& flight : batch.flights)
        if (flight.rejected.empty() && flight.unusable_power.empty()) usable.push_back(&flight);
    std::vector<FlightTrendData> flights(usable.size());
    std::set<std::filesystem::path> folders{page.input.out};
    std::vector<std::string> names;
    cli::LogPlaces places;
    for (const auto* flight : usable) {
        const auto folder = places.folder(batch::result_path(page.input.out, flight->name, batch::series_suffix));
        folders.insert(folder);
        names.push_back(folder.filename().string());
    }
    for_each_in_parallel(usable.size(), [&](std::size_t i) { flights[i] = extract_trend_data(*usable[i], names[i]); });
    auto uses = take_uses(flights);
    auto notes = answer::name_packs(uses, answer::read_packs_beside(folders));
    const bool is_named = std::ranges::any_of(uses, [](const auto& use) { return !use.pack.empty(); });
    if (!is_named && !trends_section(estimate_trends(flights), {}))
        return;  // without dates, packs have no trend either: saves their time
    auto ledger = add_state_of_health(flights, std::move(uses), {page.input.capacity_ah, max_battery_flights});
    std::ranges::move(notes, std::back_inserter(ledger.notes));
    auto section = trends_section(estimate_trends(flights), ledger);
    section->place = SectionPlace::folded;
    page.content.sections.push_back(std::move(*section));
}

void add_missions(Draft& page) {
    const auto& missions = page.input.missions;
    std::vector<std::string> files;  // the page goes to others: without the folders
    files.reserve(missions.size());
    for (const auto& mission : missions)
        files.push_back(std::filesystem::path(setup_of(mission).file).filename().string());
    files.erase(std::unique(files.begin(), files.end()), files.end());  // a file may be several flights
    page.content.facts.emplace_back("missions", fmt::format("{}", fmt::join(files, ", ")));
    auto simulated = simulate_for_report(missions, page.log.progress("missions"));
    for (auto& one : simulated) one.is_longest = page.input.are_longest;
    for (const auto i : worst_first(simulated)) page.answers.missions.push_back(std::move(simulated[i]));
    const auto progress = page.log.progress("answers");
    for (const auto& one : page.answers.missions) {
        if (progress) progress(page.answers.answers.size(), missions.size());
        page.answers.answers.push_back(assess_mission(one, [&](const mission::MissionReadOptions& reading) {
            return mission::read_mission(one.mission.setup.file, reading);
        }));
    }
    std::ranges::move(mission_sections(page.answers.missions, page.models), std::back_inserter(page.content.sections));
}

/// The missions on the power that the batch's flights measured.
std::vector<mission::Replay> replay_missions(const ReportInput& input, const BatchContent& batch,
                                             const ReportLog& log) {
    mission::ReplayOptions options;
    if (batch.fit) options.fit = batch.fit->options;
    options.progress = log.progress("replays");
    auto result = replay_flights(input.missions, flights_with_power(batch), options);
    for (const auto& skipped : result.not_replayed)
        log.warn(fmt::format("{}: {} is not replayed on it: {}", skipped.flight, skipped.mission, skipped.reason));
    return std::move(result.replays);
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

Json summary_json(const Draft& page, const BatchContent& batch) {
    PageOutput output{.title = {},
                      .missions = {},
                      .aircraft = aircraft_lines(batch.flights),
                      .prediction = prediction_line(page.answers, any_synthetic(batch.flights)),
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

/// Now, or the time in SOURCE_DATE_EPOCH (reproducible-builds.org).
std::string time_of_report() {
    std::time_t now = std::time(nullptr);
    if (const char* given = std::getenv("SOURCE_DATE_EPOCH")) {
        const auto seconds = parse_unsigned(given);
        if (!seconds) throw UsageError(fmt::format("SOURCE_DATE_EPOCH is '{}', expected seconds", given));
        now = static_cast<std::time_t>(*seconds);
    }
    return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(now));
}

}  // namespace

ReportContent make_report(const ReportInput& input, const ReportLog& log) {
    Draft page{input, log};
    auto& [title, facts, sections, summary] = page.content;
    BatchContent batch;
    if (!input.out.empty()) {
        batch = read_batch_content(input.out);
        facts.emplace_back("flights",
                           fmt::format("{} logs, from {}", batch.flights.size(),
                                       std::filesystem::absolute(input.out).lexically_normal().filename().string()));
    }
    std::vector<mission::Replay> replays;
    if (input.with_replay) replays = replay_missions(input, batch, log);
    if (!input.out.empty()) {
        add_batch(page, batch);
        add_trends(page, batch);
    }
    if (!input.missions.empty()) add_missions(page);
    if (!input.packs.empty()) sections.push_back(packs_section(input.packs));
    if (!replays.empty()) {
        sections.push_back(replay_section(replays));
        sections.back().place = SectionPlace::folded;
    }
    if (input.with_replay && replays.empty())
        page.answers.notes.emplace_back("There is no replay: no mission could be replayed on any flight.");
    // What missions answer stands before the flights.
    std::stable_partition(sections.begin(), sections.end(), [](const Section& section) {
        return section.id == "packs" || section.id == "curves" || section.id == "quality-of-service";
    });
    sections.insert(sections.begin(), summary_section(page.answers, batch.flights, input.front ? "h2" : "h1"));
    if (input.front) sections.insert(sections.begin(), *input.front);
    if (auto notes = notes_section(page.answers)) sections.push_back(std::move(*notes));
    title = page_title(batch.flights, page.answers.missions.size());
    summary = summary_json(page, batch);
    return std::move(page.content);
}

PageHead page_head(const ReportContent& content) {
    PageHead head{.title = content.title,
                  .name = "FlightWatt report",
                  .facts = {{"computed", time_of_report()}, {"by", "flightwatt " FLIGHTWATT_VERSION}}};
    std::ranges::copy(content.facts, std::back_inserter(head.facts));
    return head;
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
