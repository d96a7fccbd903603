#include "report/report.h"

#include "base/error.h"
#include "base/number.h"
#include "base/text.h"
#include "batch/manifest.h"
#include "cli/output/fit_output.h"
#include "cli/output/pack_output.h"
#include "cli/output/physical_output.h"
#include "mechanical/table_one.h"
#include "mission/mission_file.h"
#include "mission/mission_read_options.h"
#include "mission/replay.h"
#include "report/document/aircraft_panel.h"
#include "report/document/battery_document.h"
#include "report/document/findings.h"
#include "report/document/flights_document.h"
#include "report/document/mission_sliders.h"
#include "report/document/missions_document.h"
#include "report/document/model_document.h"
#include "report/flight_trends.h"

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <future>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

/// The report while its parts are added.
struct Draft {
    const ReportInput& input;
    const ReportLog& log;
    ReportContent content = {};
    Findings findings = {};
    std::vector<mechanical::MechanicalModel> models = {};  ///< the batch's, if it has one

    void add_fact(const char* name, std::string text) {
        content.document["facts"].push_back({{"name", name}, {"text", std::move(text)}});
    }
};

/// A document without any part.
Json empty_document() {
    auto document = Json::object();
    document["format"] = 1;
    for (const auto* key : {"title", "name", "command", "headline"}) document[key] = "";
    for (const auto* key : {"facts", "aircraft", "missions", "quality", "software", "packs", "flights", "exclusions",
                            "outlines", "models", "warnings", "notes", "files"})
        document[key] = Json::array();
    for (const auto* key : {"answer", "panel", "schedules", "physical", "validation", "battery", "trends", "replay"})
        document[key] = nullptr;
    return document;
}

std::string origin_of_model(const BatchContent& batch) {
    const auto& options = batch.fit->options;
    return fmt::format("Fitted by flightwatt batch to the flights above (order {}, weights: {}).{}",
                       options.phases.order, to_string(options.weighting),
                       any_synthetic(batch.flights) ? " SYNTHETIC flights are simulated, not flown." : "");
}

/// The flights' model with its validation.
void add_fit(Draft& page, const BatchContent& batch) {
    auto& notes = page.findings.notes;
    auto& [document, latex, summary] = page.content;
    if (!batch.fit) {
        notes.emplace_back("There is no model of these flights: the batch could not fit them.");
        return;
    }
    const auto& fitted = batch.fit->model;
    page.models.push_back(fitted);
    page.findings.warnings = model_warnings(fitted);
    page.findings.model = fitted;
    const auto& published = page.input.published_file;
    ReportModel model{fitted, origin_of_model(batch), batch.fit->bands};
    model.table_one = cli::model_table(
        fitted, published ? std::optional(mechanical::read_mechanical_model(*published)) : std::nullopt,
        mechanical::TableIntervals::present);
    document["models"].push_back(model_json(model));
    LatexTables of_physical;
    if (batch.measured.size() >= 2) document["physical"] = physical_json(batch.measured, of_physical);
    auto curves = fitted;
    if (!document["physical"].is_null()) curves.physical.reset();  // its constants are in those tables
    latex.add(model_latex(curves));
    latex.add(of_physical.text);
    if (batch.measured.size() < 2) {
        notes.emplace_back(
            "The model is not validated: that needs 2 flights, of which each is predicted by the other.");
        return;
    }
    auto& validated = page.findings.validated;
    const auto chosen = mechanical::validated_flights(batch.measured);
    validated = leave_one_out(chosen, batch.fit->options, page.log.progress("fits"));
    if (chosen.size() < batch.measured.size())
        notes.push_back(
            fmt::format("The model is validated on {} of {} flights, evenly chosen, as by flightwatt batch.",
                        chosen.size(), batch.measured.size()));
    if (const auto rejected = remove_rejected(validated); !rejected.empty()) notes.push_back(rejected + ".");
    document["validation"] = validation_json(validated, any_synthetic(batch.flights), latex);
}

/// Flights, model, validation and battery.
void add_batch(Draft& page, const BatchContent& batch) {
    for (const auto& damaged : batch.damaged) page.log.warn(damaged);
    const auto mix = aircraft_mix(batch);
    std::future<ReportBattery> battery;
    if (mix.empty())  // takes as long as the model's validation
        battery = std::async(std::launch::async, [&] {
            battery::IdentificationOptions options;
            options.capacity_ah = page.input.capacity_ah;
            return identify_for_report(batch.flights, options, max_battery_flights, page.input.missions);
        });
    auto& [document, latex, summary] = page.content;
    LatexTables of_flights;
    std::swap(latex, of_flights);
    add_fit(page, batch);
    std::swap(latex, of_flights);
    std::optional<ReportBattery> found;
    if (mix.empty())
        found = battery.get();
    else
        page.findings.notes.push_back("There is no battery of flights of several aircraft: " + mix + ".");
    auto flights =
        make_flights(batch, found ? &*found : nullptr, page.input.with_figures, latex, page.log.progress("flights"));
    document["flights"] = std::move(flights.flights);
    document["exclusions"] = std::move(flights.exclusions);
    latex.add(of_flights.text);
    if (!found) return;
    page.findings.pack = found->identified;
    document["battery"] = battery_json(*found, latex);
    for (const auto& group : group_exclusions(found->exclusions)) document["exclusions"].push_back(record_json(group));
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
    LatexTables unused;
    if (!is_named && trends_json(estimate_trends(flights), {}, unused).is_null())
        return;  // without dates, packs have no trend either: saves their time
    auto ledger = add_state_of_health(flights, std::move(uses), {page.input.capacity_ah, max_battery_flights});
    std::ranges::move(notes, std::back_inserter(ledger.notes));
    page.content.document["trends"] = trends_json(estimate_trends(flights), ledger, page.content.latex);
}

void add_missions(Draft& page) {
    const auto& missions = page.input.missions;
    auto& [document, latex, summary] = page.content;
    std::vector<std::string> files;  // the page goes to others: without the folders
    files.reserve(missions.size());
    for (const auto& mission : missions)
        files.push_back(std::filesystem::path(setup_of(mission).file).filename().string());
    files.erase(std::unique(files.begin(), files.end()), files.end());  // a file may be several flights
    page.add_fact("missions", fmt::format("{}", fmt::join(files, ", ")));
    auto simulated = simulate_for_report(missions, page.log.progress("missions"));
    for (auto& one : simulated) one.is_longest = page.input.are_longest;
    auto& flown = page.findings.missions;
    for (const auto i : worst_first(simulated)) flown.push_back(std::move(simulated[i]));
    const auto progress = page.log.progress("answers");
    for (const auto& one : flown) {
        if (progress) progress(page.findings.assessments.size(), missions.size());
        page.findings.assessments.push_back(assess_mission(one, [&](const mission::MissionReadOptions& reading) {
            return mission::read_mission(one.mission.setup.file, reading);
        }));
    }
    document["quality"] = quality_json(flown, page.input.with_figures);
    for (const auto& model : other_models(flown, page.models))
        document["models"].push_back(model_json({model, "The missions' model.", {}, table_one(model), true}));
    document["software"] = software_json(flown);
    document["schedules"] = schedule_notes(flown);
    document["missions"] = missions_json(page.findings, latex);
    if (page.input.is_interactive) add_sliders(flown, document);
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

/// JSON of the page.
struct PageOutput {
    std::string title;
    std::vector<MissionOutput> missions;
    std::vector<std::string> aircraft;
    std::string prediction;
    std::vector<std::string> warnings, notes;
    std::vector<std::string> figures;
};

Fields<PageOutput> record_fields(const PageOutput*) {
    using R = PageOutput;
    return {field("title", &R::title, "title of the page"),
            field("missions", &R::missions, "missions"),
            field("aircraft", &R::aircraft, "each aircraft with its flights"),
            field("prediction", &R::prediction, "errors of the models for hold-out flights"),
            field("warnings", &R::warnings, "warnings of the fit"),
            field("notes", &R::notes, "missing contents"),
            field("figures", &R::figures, "names of the files of --figures, without their endings")};
}

Json summary_json(const Draft& page, const BatchContent& batch) {
    PageOutput output{.title = page.content.document["title"],
                      .missions = {},
                      .aircraft = {},
                      .prediction = prediction_line(page.findings, any_synthetic(batch.flights)),
                      .warnings = page.findings.warnings,
                      .notes = page.findings.notes,
                      .figures = {}};
    for (const auto& [name, text] : aircraft_lines(batch.flights))
        output.aircraft.push_back(fmt::format("{}: {}", name, text));
    for (std::size_t i = 0; i < page.findings.missions.size(); ++i)
        output.missions.push_back({&page.findings.missions[i], &page.findings.assessments[i]});
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
    auto& [document, latex, summary] = page.content;
    document = empty_document();
    page.add_fact("computed", time_of_report());
    page.add_fact("by", "flightwatt " FLIGHTWATT_VERSION);
    BatchContent batch;
    if (!input.out.empty()) {
        batch = read_batch_content(input.out);
        page.add_fact("flights",
                      fmt::format("{} logs, from {}", batch.flights.size(),
                                  std::filesystem::absolute(input.out).lexically_normal().filename().string()));
    }
    std::vector<mission::Replay> replays;
    if (input.with_replay) replays = replay_missions(input, batch, log);
    document["packs"] = packs_json(input.packs, latex);
    if (!input.out.empty()) {
        add_batch(page, batch);
        add_trends(page, batch);
    }
    if (!input.missions.empty()) add_missions(page);
    auto& findings = page.findings;
    if (!replays.empty()) document["replay"] = replay_json(replays, latex);
    if (input.with_replay && replays.empty())
        findings.notes.emplace_back("There is no replay: no mission could be replayed on any flight.");
    const auto aircraft = aircraft_lines(batch.flights);
    document["title"] = page_title(batch.flights, findings.missions.size());
    document["name"] = "FlightWatt report";
    document["command"] = input.command;
    document["headline"] = !findings.missions.empty() ? missions_headline(findings)
                           : aircraft.empty()
                               ? "No flights"
                               : fmt::format("{}: {} and no mission", aircraft.front().name,
                                             aircraft.front().text.substr(0, aircraft.front().text.find(" \u00b7")));
    document["aircraft"] = json_list<AircraftLine>(aircraft);
    document["answer"] = input.answer;
    document["panel"] = aircraft_panel(findings, batch.flights);
    document["outlines"] = input.outlines;
    document["warnings"] = findings.warnings;
    document["notes"] = findings.notes;
    summary = summary_json(page, batch);
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
