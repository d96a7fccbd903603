#include "report/report.h"

#include "base/parallel.h"
#include "cli/output/physical_output.h"
#include "cli/output/prediction_output.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/table_one.h"
#include "mission/mission_file.h"
#include "mission/replay.h"
#include "report/sections/sections.h"
#include "report/trends_section.h"

#include <algorithm>
#include <future>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

/// The page as it grows.
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
    const auto flights = of.folder.empty() ? "flights above" : fmt::format("flights of {} above", of.folder);
    if (!any_synthetic(content.flights)) return fmt::format("Fitted by flightwatt batch to the {}.", flights);
    return all_synthetic(content.flights)
               ? fmt::format("Fitted by flightwatt batch to the SYNTHETIC {}: no aircraft flew them.", flights)
               : fmt::format("Fitted by flightwatt batch to the {}. Some are SYNTHETIC: no aircraft flew these.",
                             flights);
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
    auto model =
        model_of(*content.fit, published ? std::optional(mechanical::read_mechanical_model(*published)) : std::nullopt);
    model.origin = origin_of_model(content, of);
    sections.push_back(model_section(model, page.input.figures, of.id("model")));
    sections.back().title = of.title(sections.back().title);
    const auto most = page.input.max_validation_flights;
    if (content.measured.size() < 2 || content.measured.size() > most) {
        notes.push_back(of_folder(
            of,
            fmt::format("The model is validated with 2 to {} flights, and there are {}; flightwatt validate does it.",
                        most, content.measured.size())));
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

/// What the flights of all folders are drawn with.
struct FigureContext {
    std::vector<std::optional<mechanical::MechanicalModel>> models;  ///< one a folder
    std::map<std::string, PredictedFlight> predicted;
};

FigureContext drawn_beside(std::span<const BatchContent> batches, std::size_t max_predicted) {
    FigureContext beside;
    for (const auto& content : batches) {
        beside.models.push_back(content.fit ? std::optional(content.fit->model) : std::nullopt);
        auto predicted = predict_each_minute(content, max_predicted);
        for (const auto& flight : content.flights)
            if (flight.is_shown_elsewhere) predicted.erase(flight.name);
        beside.predicted.merge(predicted);
    }
    return beside;
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
                          : std::optional(identify_for_report(content.flights, identification,
                                                              input.max_battery_flights, input.missions));
        }));
    }
    auto& sections = page.content.sections;
    const auto at = static_cast<std::ptrdiff_t>(sections.size());
    const auto beside = drawn_beside(batches, input.max_validation_flights);
    const auto add_flights = [&](std::span<const ReportFlight> flights) {
        sections.insert(sections.begin() + at,
                        flights_section(flights, beside.models, beside.predicted, page.log.progress("flights")));
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
    if (batches.size() == 1) {
        page.flights = std::move(batches.front().flights);
        return;
    }
    page.flights = take_shown_flights(batches);
    add_flights(page.flights);
}

/// How the aircraft go over the dates of their flights; nothing where these tell no trend.
void add_trends(Draft& page) {
    std::vector<const ReportFlight*> usable;
    for (const auto& flight : page.flights)
        if (flight.rejected.empty() && flight.unusable_power.empty()) usable.push_back(&flight);
    std::vector<FlightTrendData> flights(usable.size());
    for_each_in_parallel(usable.size(), [&](std::size_t i) { flights[i] = extract_trend_data(*usable[i]); });
    if (!trends_section(trends_of(flights))) return;  // and so none of packs, whose work is long
    const auto notes = add_state_of_health(flights, page.input.max_battery_flights, page.input.capacity_ah);
    auto section = trends_section(trends_of(flights));
    section->html += list_html(notes);
    page.content.sections.push_back(std::move(*section));
}

/// "3 logs, from out; 5 logs, from other".
std::string origin_of_flights(std::span<const std::filesystem::path> outs, std::span<const BatchContent> batches) {
    std::string text;
    for (std::size_t i = 0; i < outs.size(); ++i) {
        text += fmt::format("{}{} logs, from {}", i == 0 ? "" : "; ", batches[i].flights.size(), outs[i].string());
    }
    return text;
}

/// What the missions come to: answers and evidence.
void add_missions(Draft& page) {
    const auto& missions = page.input.missions;
    std::vector<std::string> names;
    names.reserve(missions.size());
    for (const auto& mission : missions) names.push_back(setup_of(mission).file);
    page.content.facts.emplace_back("missions", fmt::format("{}", fmt::join(names, ", ")));
    page.answers.missions = simulate_for_report(missions, page.log.progress("missions"));
    const auto answering = page.log.progress("answers");
    for (std::size_t i = 0; i < missions.size(); ++i) {
        answering(i, missions.size());
        const std::filesystem::path file = setup_of(missions[i]).file;
        page.answers.answers.push_back(assess_mission(
            page.answers.missions[i],
            [&](const mission::MissionReadOptions& reading) { return mission::read_mission(file, reading); }));
    }
    std::ranges::move(mission_sections(page.answers.missions, page.input.figures, page.models),
                      std::back_inserter(page.content.sections));
}

mission::Replays replay_on(const BatchContent& content, const std::vector<mission::MissionVariant>& missions,
                           const ReportLog& log) {
    mission::ReplayOptions options;
    if (content.fit) options.fit = content.fit->options;
    auto flights = flights_with_power(content);
    for (const auto& shown : content.flights)
        if (shown.is_shown_elsewhere)
            std::erase_if(flights, [&](const auto& flight) { return flight.samples.flight == shown.name; });
    auto replays = replay_flights(missions, flights, options);
    for (const auto& left : replays.not_replayed)
        log.warn(fmt::format("{}: {} is not flown on it: {}", left.flight, left.mission, left.reason));
    return replays;
}

/// The missions on the batch's flights.
void add_replay(Draft& page) {
    std::vector<mission::Replay> replays;
    for (const auto& content : read_batch_contents(page.input.outs).batches)
        std::ranges::move(replay_on(content, page.input.missions, page.log).replays, std::back_inserter(replays));
    if (replays.empty())
        page.answers.notes.emplace_back("There is no replay: no mission could be flown on any flight.");
    else
        page.content.sections.push_back(replay_section(replays));
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

/// Of flights that are left out in turn, as the report has them: the work grows with their square.
std::string validation_latex(const BatchContent& content) {
    constexpr std::size_t max_flights = 30;
    if (content.measured.size() < 2 || content.measured.size() > max_flights) return "";
    auto tables = physical_section(content.measured).value_or(Section{}).tables;
    tables.push_back(
        {predictions_table(predict_each_minute(content, max_flights)),
         "Energy of each flight as it would have been predicted while it cruised, from what was flown until "
         "then and a model of the other flights",
         "tab:predictions"});
    tables.push_back({cli::scores_table(leave_one_out(content.measured, content.fit->options)),
                      "Errors of the models on flights that they were not fitted to", "tab:validation"});
    return to_latex(tables);
}

}  // namespace

ReportContent make_report(const ReportInput& input, const ReportLog& log) {
    Draft page{input, log};
    auto& [facts, sections, summary] = page.content;
    if (!input.outs.empty()) {
        auto contents = read_batch_contents(input.outs);
        page.answers.notes = contents.notes;
        facts.emplace_back("flights", origin_of_flights(input.outs, contents.batches));
        add_batches(page, contents.batches);
        add_trends(page);
    }
    if (!input.missions.empty()) add_missions(page);
    if (input.with_replay) add_replay(page);
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

std::string batch_latex(const BatchContent& content, std::span<const mission::MissionVariant> missions,
                        const std::optional<double>& capacity_ah, const ReportLog& log) {
    for (const auto& damaged : content.damaged) log.warn(damaged);
    auto text = to_latex(flights_tables(content.flights)) + "\n";
    if (content.fit) text += model_latex(content.fit->model) + "\n" + validation_latex(content) + "\n";
    if (!aircraft_mix(content).empty()) return text;
    battery::IdentificationOptions options;
    options.capacity_ah = capacity_ah;
    const auto battery = identify_for_report(content.flights, options, usual_battery_flights, missions);
    if (!battery.identified) log.note("no table of the battery: " + battery.no_result_reason);
    return text + to_latex(battery_section(battery).tables);
}

std::string missions_latex(const std::vector<mission::MissionVariant>& missions) {
    const auto simulated = simulate_for_report(missions);
    auto text = to_latex(ranking_table(simulated), "Missions by final state of charge", "tab:missions");
    const auto plans = plans_table(simulated);
    if (!plans.rows.empty()) text += "\n" + to_latex(plans, "Planned missions", "tab:plans");
    return text;
}

std::string replay_latex(const BatchContent& content, const std::vector<mission::MissionVariant>& missions,
                         const ReportLog& log) {
    return to_latex(replay_section(replay_on(content, missions, log).replays).tables);
}

Json summary_schema() { return record_schema<PageOutput>(); }

}  // namespace flightwatt::report
