// flightwatt trends: ageing of aircraft and pack over the dates of their flights.

#include "base/error.h"
#include "batch/trend.h"
#include "cli/output/flight_options.h"
#include "cli/output/records.h"
#include "cli/output/stage_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "report/page.h"
#include "report/trends_section.h"
#include "stages.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;
using Json = nlohmann::ordered_json;

struct TrendsArguments {
    std::optional<double> capacity_ah;
    std::optional<std::string> figures;
    cli::FlightFilter filter;
    cli::FlightArguments flights;
};

std::vector<report::FlightTrendData> read_flights(const cli::StageCall& call, const TrendsArguments& arguments) {
    const auto chosen = cli::with_chosen_flights(call, arguments.filter, arguments.flights.load);
    return cli::from_flights<report::FlightTrendData>(
        chosen, arguments.flights, [&](const std::string& file, flight::LoadedFlight& loaded) {
            if (!loaded.exclusion.empty()) {
                cli::warn(call, fmt::format("excluded: {}: {}", loaded.series.flight, loaded.exclusion));
                return std::vector<report::FlightTrendData>{};
            }
            report::ReportFlight flight;
            flight.name = loaded.series.flight;
            flight.series = std::move(loaded.series);
            flight.phases = std::move(loaded.phases);
            auto flown = extract_trend_data(flight);
            if (!flown.no_record.empty())
                cli::note(call, fmt::format("no resistance and no capacity of {}: {}", file, flown.no_record));
            return std::vector{std::move(flown)};
        });
}

Json flight_json(const report::FlightTrendData& flight) {
    const auto& facts = flight.facts;
    Json json{{"flight", flight.name},
              {"aircraft", flight.aircraft},
              {"date", facts.date},
              {"in_air_s", facts.in_air_s},
              {"energy_wh", cli::optional_json(facts.energy_wh)},
              {"distance_m", cli::optional_json(facts.distance_m)},
              {"air_distance_m", cli::optional_json(facts.air_distance_m)}};
    for (const auto& [name, title, of] : report::trend_quantities()) json[name] = cli::optional_json(of(flight));
    json["resistance_interval_ohm"] =
        flight.resistance ? Json::array({flight.resistance->interval_ohm.low, flight.resistance->interval_ohm.high})
                          : Json(nullptr);
    json["capacity_interval_ah"] =
        flight.capacity_ah ? Json::array({flight.capacity_interval_ah.low, flight.capacity_interval_ah.high})
                           : Json(nullptr);
    json["charge_ah"] = cli::optional_json(flight.charge_ah);
    return json;
}

std::string flights_csv(const std::vector<report::FlightTrendData>& flights) {
    std::vector<std::string_view> columns{"flight",    "aircraft",   "date",          "in_air_s",
                                          "energy_wh", "distance_m", "air_distance_m"};
    for (const auto& quantity : report::trend_quantities()) columns.emplace_back(quantity.name);
    columns.insert(
        columns.end(),
        {"resistance_interval_ohm/0: resistance_low_ohm", "resistance_interval_ohm/1: resistance_high_ohm",
         "capacity_interval_ah/0: capacity_low_ah", "capacity_interval_ah/1: capacity_high_ah", "charge_ah"});
    return cli::csv_of(cli::list_json(flights, flight_json), columns);
}

Json trends_json(const std::vector<report::FlightTrendData>& flights,
                 const std::vector<report::AircraftTrend>& trends) {
    Json json{{"flights", cli::list_json(flights, flight_json)}, {"trends", Json::array()}};
    for (const auto& row : trends) {
        Json item{{"aircraft", row.aircraft}, {"quantity", row.quantity}};
        const auto& trend = row.answer.trend;
        item["dated_flights"] = trend ? Json(trend->flights) : Json(nullptr);
        item["median"] = trend ? Json(trend->median) : Json(nullptr);
        const bool knows_unit = trend && !row.level_is_guess;
        item["per_day"] = knows_unit ? Json(trend->per_day) : Json(nullptr);
        item["per_day_interval"] = knows_unit ? Json::array({trend->low_per_day, trend->high_per_day}) : Json(nullptr);
        const auto relative = trend ? relative_trend(*trend) : std::nullopt;
        item["percent_per_day"] = relative ? Json(relative->per_day) : Json(nullptr);
        item["percent_per_day_interval"] =
            relative ? Json::array({relative->low_per_day, relative->high_per_day}) : Json(nullptr);
        item["level_is_guess"] = row.level_is_guess;
        item["significant"] = trend ? Json(is_significant(*trend)) : Json(nullptr);
        item["why_not"] = row.answer.no_trend_reason;
        json["trends"].push_back(std::move(item));
    }
    return json;
}

void note_trends(const cli::StageCall& call, const std::vector<report::FlightTrendData>& flights,
                 const std::vector<report::AircraftTrend>& trends) {
    std::vector<std::string> undated;
    for (const auto& flight : flights)
        if (!flight.facts.start_clock_s) undated.push_back(flight.name);
    if (!undated.empty()) {
        cli::note(call, fmt::format("in no trend, as neither clock nor name contains the date: {}",
                                    fmt::join(undated, ", ")));
    }
    std::size_t tested = 0;
    std::vector<std::string> changing;
    for (const auto& row : trends) {
        const auto& trend = row.answer.trend;
        if (!trend) continue;
        ++tested;
        if (!is_significant(*trend)) continue;
        const auto [slope, low, high, unit] = shown_slope(row);
        const auto [least, most] = std::minmax({std::abs(low), std::abs(high)});
        changing.push_back(fmt::format("{} of {} {} by {:.3g}{} in 30 days ({:.3g} to {:.3g}{})", row.quantity,
                                       row.aircraft, trend_direction(row), std::abs(slope),
                                       unit.empty() ? "" : " % of its level", least, most, unit));
    }
    for (const auto& text : changing) cli::note(call, text);
    if (tested == 0)
        cli::note(call, "no trend can be determined: " + trends.front().answer.no_trend_reason);
    else if (changing.empty())
        cli::note(call, fmt::format("none of {} quantities has a trend beyond its 95 % interval", tested));
    else
        cli::note(call, fmt::format("{} of {} quantities have a trend; one in 20 has one by chance", changing.size(),
                                    tested));
}

void write_figure_files(const cli::StageCall& call, const std::string& folder,
                        const std::vector<report::AircraftTrend>& trends, const report::WebFiles& web) {
    const auto section = trends_section(trends);
    if (!section) {
        cli::note(call, "there is no figure, as there is no trend");
        return;
    }
    const auto files = report::write_figures({*section}, web, folder);
    cli::note(call, fmt::format("{} figure{} in {}: .vl.json{}{}", files.figures, files.figures == 1 ? "" : "s", folder,
                                files.has_svg ? ", .svg" : "", files.has_pdf ? ", .pdf" : ""));
    if (!files.has_svg) cli::warn(call, "node is not there: no figure was rendered");
}

int show_trends(const cli::StageCall& call, const TrendsArguments& arguments) {
    std::optional<report::WebFiles> web;  // read first: missing files are an error before any work
    if (arguments.figures) web = report::read_web_files(report::web_folder());
    auto flights = read_flights(call, arguments);
    if (flights.empty()) throw InputError({}, "no flight is left", "see the reasons above");
    std::ranges::stable_sort(flights, {}, [](const auto& flight) {
        return std::pair(flight.aircraft, flight.facts.start_clock_s.value_or(0.0));
    });
    constexpr std::size_t max_records = 60;
    for (const auto& note : add_state_of_health(flights, max_records, arguments.capacity_ah)) cli::note(call, note);
    const auto trends = trends_of(flights);
    const auto screen = screen_of(call);
    write_csv_result(call, flights_csv(flights),
                     {fmt::format("{} flight{}", flights.size(), flights.size() == 1 ? "" : "s"),
                      {"flight", "date", "energy_wh_per_min", "energy_wh_per_km", "cruise_power_w", "resistance_ohm",
                       "capacity_ah", "charge_ah"}});
    if (call.json)
        cli::print(cli::json_text(trends_json(flights, trends)));
    else if (call.output || screen.is_terminal)
        cli::print(screen_text(trend_table(trends), screen, {"trends", {"quantity", "verdict", "in 30 days"}}));
    note_trends(call, flights, trends);
    if (web) write_figure_files(call, *arguments.figures, trends, *web);
    return cli::ok;
}

}  // namespace

int flightwatt::stages::trends_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "trends", "FLIGHT.data|SERIES.csv|FOLDER...",
        R"(Shows the ageing of aircraft and pack: for each flight its energy per minute and per kilometre over ground and
through the air, the mean power of its cruise, the pack's resistance, its capacity if the flight draws enough to
determine it, and the charge drawn, as CSV; and their trends over the flights' dates, with 95 % intervals, for
each aircraft. A flight that is in two folders of batch counts once.)" +
            std::string(cli::several_flights_text)};
    stage.examples = {"flightwatt trends my -o trends.csv",
                      "flightwatt trends season1 season2 --capacity 2.2 --figures figures"};
    stage.reads_logs = stage.uses_threads = stage.shows_table = true;
    TrendsArguments arguments;
    auto& options = stage.options;
    cli::add_capacity_option(
        options, arguments.capacity_ah,
        "the pack's capacity, the mean over these flights; default: trends of capacities are in percent "
        "where no flight determines their level");
    options.add("figures", arguments.figures, cli::output_file("DIR"),
                "draw each aircraft's trends into DIR, as flightwatt report --figures does");
    cli::add_filter_options(options, arguments.filter);
    cli::add_flight_options(options, arguments.flights);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return show_trends(call, arguments); });
}
