// flightwatt trends: ageing of aircraft and pack over the dates of their flights.

#include "answer/pack_life.h"
#include "base/atomic_file.h"
#include "batch/trend.h"
#include "cli/output/flight_options.h"
#include "cli/output/pack_output.h"
#include "cli/output/stage_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mission/mission_file.h"
#include "mission/prepared_mission.h"
#include "report/batch_content.h"
#include "report/flight_trends.h"
#include "stages.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;

struct TrendsArguments {
    std::optional<double> capacity_ah;
    cli::PackArguments packs;
    std::optional<std::string> ledger;
    std::optional<std::string> mission;
    cli::FlightFilter filter;
    cli::FlightArguments flights;
};

std::vector<report::FlightTrendData> read_flights(const cli::StageCall& call, const cli::StageCall& chosen,
                                                  const TrendsArguments& arguments) {
    cli::LogPlaces places;
    return cli::from_flights<report::FlightTrendData>(
        chosen, arguments.flights, [&](const std::string& file, flight::LoadedFlight& loaded) {
            if (!loaded.exclusion.empty()) {
                if (!cli::is_shown_by_batch(call, file))
                    cli::add_diagnostic(call, {Severity::warning, "not used: " + kind_of_reason(loaded.exclusion),
                                               "it is not used: " + loaded.exclusion, loaded.data.flight});
                return std::vector<report::FlightTrendData>{};
            }
            report::ReportFlight flight;
            flight.name = loaded.data.flight;
            flight.data = std::move(loaded.data);
            flight.phases = std::move(loaded.phases);
            auto flown = extract_trend_data(flight, places.folder(file).filename().string());
            if (!flown.no_uses_reason.empty())
                cli::add_diagnostic(
                    call, {Severity::note, "no resistance and no capacity", flown.no_uses_reason, flown.name});
            return std::vector{std::move(flown)};
        });
}

}  // namespace

namespace flightwatt::report {

Fields<FlightTrendData> record_fields(const FlightTrendData*) {
    using R = FlightTrendData;
    using S = FlightSummary;
    const auto capacity = [](const R& r) {
        return r.capacity_ah ? std::optional(r.capacity_interval_ah) : std::nullopt;
    };
    Fields<R> quantities;
    for (const auto& quantity : trend_quantities()) {
        const auto get = [of = quantity.value](const R& r) { return of(r); };
        quantities.push_back(field(quantity.name, get, quantity.title, csv_column{}));
    }
    return list_fields<R>(
        field("flight", &R::name, "name of the flight", csv_column{}),
        field("aircraft_id", &R::aircraft_id, "id of the aircraft", csv_column{}),
        field("aircraft_name", &R::aircraft_name, "name of the aircraft", csv_column{}),
        field("date", at(&R::facts, &S::date), "UTC of the log's clock, or of its name", csv_column{}),
        field("in_air_s", at(&R::facts, &S::in_air_s), "of all sorties", csv_column{}),
        field("energy_wh", at(&R::facts, &S::energy_wh), "in the air", csv_column{}),
        field("distance_m", at(&R::facts, &S::distance_m), "over ground", csv_column{}),
        field("air_distance_m", at(&R::facts, &S::air_distance_m), "through the air", csv_column{}),
        std::move(quantities),
        field("resistance_ohm_interval_95", at(&R::resistance, &battery::FlightResistance::interval_ohm), "",
              csv_column{}),
        field("capacity_ah", &R::capacity_ah, "of the pack", csv_column{}),
        field("capacity_ah_interval_95", capacity, "without the error of the level", csv_column{}),
        field("charge_ah", &R::charge_ah, "drawn from the pack", csv_column{}));
}

}  // namespace flightwatt::report

namespace {

/// JSON of the stage.
struct TrendsOutput {
    const std::vector<report::FlightTrendData>* flights = nullptr;
    const std::vector<report::AircraftTrend>* trends = nullptr;
    const std::vector<answer::Pack>* packs = nullptr;
};

Fields<TrendsOutput> record_fields(const TrendsOutput*) {
    return {field("flights", &TrendsOutput::flights, "flights by aircraft and date"),
            field("trends", &TrendsOutput::trends, "trends by aircraft and quantity"),
            field("packs", &TrendsOutput::packs, "the ledger of packs")};
}

void note_trends(const cli::StageCall& call, const std::vector<report::FlightTrendData>& flights,
                 const std::vector<report::AircraftTrend>& trends) {
    std::vector<std::string> undated;
    for (const auto& flight : flights)
        if (!flight.facts.start_clock_s) undated.push_back(flight.name);
    if (!undated.empty()) {
        cli::note(call, fmt::format("in no trend, as neither clock nor name (YY_MM_DD__hh_mm_ss) contains the date: {}",
                                    fmt::join(undated, ", ")));
    }
    const auto tested = std::ranges::count_if(trends, [](const auto& row) { return row.answer.trend.has_value(); });
    std::vector<std::string> changing;
    for (const auto& row : trends)
        if (row.answer.trend && is_significant(*row.answer.trend))
            changing.push_back(fmt::format("{} of {} {}", row.quantity, row.aircraft, trend_direction(row)));
    if (tested == 0)
        cli::note(call, "no trend can be determined: " + trends.front().answer.no_trend_reason);
    else if (changing.empty())
        cli::note(call, fmt::format("none of {} quantities has a trend beyond its 95 % interval", tested));
    else
        cli::note(call, fmt::format("{} of {} quantities have a trend; one in 20 has one by chance: {}",
                                    changing.size(), tested, fmt::join(changing, ", ")));
}

/// Leaves the flights with a use of a pack.
void leave_used(std::vector<report::FlightTrendData>& flights, const std::vector<answer::PackUse>& uses) {
    std::erase_if(flights, [&](const auto& flight) {
        return std::ranges::none_of(uses, [&](const auto& use) {
            return use.flight == flight.name || use.flight.starts_with(flight.name + "#");
        });
    });
}

answer::PackLedger make_ledger(const cli::StageCall& call, const std::vector<std::string>& files,
                               const TrendsArguments& arguments, std::vector<report::FlightTrendData>& flights) {
    auto uses = take_uses(flights);
    name_packs(call, arguments.packs, files, uses);
    if (arguments.packs.pack) leave_used(flights, uses);
    auto ledger = add_state_of_health(flights, std::move(uses), {.capacity_ah = arguments.capacity_ah});
    if (arguments.mission) {
        const auto mission = mission::prepare_mission(mission::read_mission(*arguments.mission));
        for (auto& pack : ledger.packs) pack.mission_until = mission_life(pack, mission);
    }
    for (const auto& note : ledger.notes) cli::note(call, note);
    if (arguments.ledger) write_file_atomically(*arguments.ledger, csv_of(ledger.packs));
    return ledger;
}

int show_trends(const cli::StageCall& call, const TrendsArguments& arguments) {
    const auto chosen = cli::with_chosen_flights(call, arguments.filter, arguments.flights.load);
    auto flights = read_flights(call, chosen, arguments);
    if (flights.empty()) throw InputError({}, "no flight is left", "see the reasons above");
    std::ranges::stable_sort(flights, {}, [](const auto& flight) {
        return std::pair(flight.aircraft, flight.facts.start_clock_s.value_or(0.0));
    });
    const auto ledger = make_ledger(call, chosen.inputs, arguments, flights);
    const auto trends = estimate_trends(flights);
    const auto screen = screen_of(call);
    write_csv_result(call, csv_of(flights),
                     {fmt::format("{} flight{}", flights.size(), flights.size() == 1 ? "" : "s"),
                      {"flight", "date", "energy_wh_per_min", "energy_wh_per_km", "cruise_power_w", "resistance_ohm",
                       "capacity_ah", "charge_ah"}});
    if (call.json)
        cli::print_json(call, TrendsOutput{&flights, &trends, &ledger.packs});
    else if (call.output || screen.is_terminal)
        cli::print(screen_text(table_of(trends), screen, {"trends", {"quantity", "trend", "in 30 days"}}));
    note_trends(call, flights, trends);
    for (const auto& pack : ledger.packs) cli::note(call, describe(pack));
    return cli::ok;
}

}  // namespace

int flightwatt::stages::trends_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "trends", "LOG|SERIES.csv|FOLDER...",
        R"(Shows the ageing of aircraft and pack: for each flight its energy per minute and per kilometre over ground and
through the air, the mean power of its cruise, the pack's resistance, its capacity if the flight draws enough to
determine it, and the charge drawn, as CSV; and their trends over the flights' dates, with 95 % intervals, for
each aircraft; and the health of each pack: healthy, watch or retire. A flight that is in two folders of batch counts
once.)" + std::string(cli::several_flights_text)};
    stage.next = [](const auto&) { return "flightwatt validate {in}"; };
    stage.json_schema = cli::document_schema<TrendsOutput>;
    stage.examples = {"flightwatt trends my -o trends.csv", "flightwatt trends season1 season2 --capacity 2.2"};
    stage.reads_logs = stage.uses_threads = stage.shows_table = true;
    TrendsArguments arguments;
    auto& options = stage.options;
    cli::add_capacity_option(
        options, arguments.capacity_ah,
        "the pack's capacity, the mean over these flights; default: by the flights, or a guess from charts");
    cli::add_pack_options(options, arguments.packs);
    options.add("ledger", arguments.ledger, {.value = "FILE"}, "write the packs with their health as CSV: packs.csv");
    options.add("mission", arguments.mission, {.value = "FILE"},
                "also until when each pack lands this mission with its reserve in 95 of 100 flights");
    cli::add_filter_options(options, arguments.filter);
    cli::add_flight_options(options, arguments.flights);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return show_trends(call, arguments); });
}
