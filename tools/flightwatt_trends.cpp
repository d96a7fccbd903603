// flightwatt trends: how aircraft and pack go over the dates of their flights.

#include "base/csv.h"
#include "base/error.h"
#include "base/units.h"
#include "batch/trend.h"
#include "battery/identification.h"
#include "cli/output/flight_options.h"
#include "cli/output/json_text.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "flight/flight_identity.h"
#include "report/flight_facts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;
using Json = nlohmann::ordered_json;

/// One flight, with all that may change with age.
struct FlownFlight {
    std::string name;
    std::string aircraft;
    report::FlightFacts facts;
    std::vector<battery::DischargeRecord> records;
    std::optional<battery::FlightResistance> resistance;
    std::optional<double> charge_ah;  ///< drawn from the pack, on the ground too
};

std::optional<double> per(const std::optional<double>& energy_wh, const std::optional<double>& much) {
    if (!energy_wh || !much || *much <= 0.0) return std::nullopt;
    return *energy_wh / *much;
}

struct Quantity {
    const char* name;
    std::optional<double> (*of)(const FlownFlight&);
};

constexpr double metres_per_km = 1000.0;

/// What has a trend. The charge that was drawn has none: it says how long the flight was.
constexpr std::array<Quantity, 5> quantities{{
    {"energy_wh_per_min",
     [](const FlownFlight& f) { return per(f.facts.energy_wh, units::minute_from_second(f.facts.in_air_s)); }},
    {"energy_wh_per_km",
     [](const FlownFlight& f) { return per(f.facts.energy_wh, f.facts.distance_m.value_or(0.0) / metres_per_km); }},
    {"energy_wh_per_air_km",
     [](const FlownFlight& f) { return per(f.facts.energy_wh, f.facts.air_distance_m.value_or(0.0) / metres_per_km); }},
    {"cruise_power_w", [](const FlownFlight& f) { return f.facts.cruise_power_w; }},
    {"resistance_ohm",
     [](const FlownFlight& f) { return f.resistance ? std::optional(f.resistance->value_ohm) : std::nullopt; }},
}};

/// A quantity of one aircraft over its flights' dates.
struct AircraftTrend {
    std::string aircraft;
    std::string quantity;
    batch::TrendAnswer answer;
};

std::vector<FlownFlight> read_flights(const cli::StageCall& call) {
    const auto options = cli::read_flight_options(call);
    const auto chosen = cli::with_chosen_flights(call, options);
    return cli::from_flights<FlownFlight>(chosen, options, [&](const std::string& file, flight::LoadedFlight& loaded) {
        if (!loaded.exclusion.empty()) {
            cli::warn(call, fmt::format("excluded: {}: {}", loaded.series.flight, loaded.exclusion));
            return std::vector<FlownFlight>{};
        }
        FlownFlight flown;
        flown.name = loaded.series.flight;
        flown.aircraft = flight::describe_aircraft(loaded.series.aircraft_id, loaded.series.aircraft_name);
        try {
            flown.records = battery::discharge_records(loaded.series).records;
        } catch (const InputError& error) {
            cli::note(call, fmt::format("no resistance of {}: {}", file, error.what()));
        }
        for (const auto& record : flown.records)
            flown.charge_ah = flown.charge_ah.value_or(0.0) + record.charge_ah.back();
        report::ReportFlight facts_from;
        facts_from.name = flown.name;
        facts_from.series = std::move(loaded.series);
        facts_from.phases = std::move(loaded.phases);
        flown.facts = facts_of(facts_from);
        return std::vector{std::move(flown)};
    });
}

std::vector<std::string> aircraft_of(const std::vector<FlownFlight>& flights) {
    std::vector<std::string> names;
    names.reserve(flights.size());
    for (const auto& flight : flights) names.push_back(flight.aircraft);
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

/// By the pack that all flights of the aircraft tell together. The work grows with the square of the flights.
void add_resistances(const cli::StageCall& call, std::vector<FlownFlight>& flights, const std::string& aircraft) {
    constexpr std::size_t most_records = 60;
    std::vector<battery::DischargeRecord> records;
    std::vector<FlownFlight*> flown;
    for (auto& flight : flights) {
        if (flight.aircraft != aircraft || flight.records.empty()) continue;
        flown.push_back(&flight);
        records.push_back(flight.records.front());
    }
    if (records.empty()) return;
    if (records.size() > most_records) {
        cli::note(call, fmt::format("{}: no resistance of {} flights, expected {} at most; choose some with --since",
                                    aircraft, records.size(), most_records));
        return;
    }
    try {
        const auto identified = identify_battery(records, {});
        for (std::size_t i = 0; i < flown.size(); ++i) flown[i]->resistance = identified.flights.at(i).resistance;
    } catch (const NoAnswerError& error) {
        cli::note(call, fmt::format("{}: no resistances: {}", aircraft, error.what()));
    }
}

std::vector<AircraftTrend> trends_of(const std::vector<FlownFlight>& flights) {
    constexpr double seconds_per_day = 86400.0;
    std::vector<AircraftTrend> trends;
    for (const auto& aircraft : aircraft_of(flights)) {
        for (const auto& [name, of] : quantities) {
            std::vector<batch::DatedValue> values;
            for (const auto& flight : flights) {
                const auto value = of(flight);
                if (flight.aircraft == aircraft && flight.facts.start_clock_s && value)
                    values.push_back({*flight.facts.start_clock_s / seconds_per_day, *value});
            }
            auto answer = trend_over(values);
            if (values.empty()) answer.why_not = "of no flight with a date is it known";
            trends.push_back({aircraft, name, std::move(answer)});
        }
    }
    return trends;
}

std::string verdict(const AircraftTrend& row) {
    if (!row.answer.trend) return "-";
    if (!is_significant(*row.answer.trend)) return "no trend";
    return row.answer.trend->per_day > 0.0 ? "rises" : "falls";
}

constexpr double shown_days = 30.0;

TextTable trend_table(const std::vector<AircraftTrend>& trends) {
    TextTable table{{"aircraft", "quantity", "flights", "median", "in 30 days", "low", "high", "verdict"}, {}};
    for (const auto& row : trends) {
        std::vector<std::string> cells{row.aircraft, row.quantity};
        if (const auto& trend = row.answer.trend) {
            cells.push_back(fmt::format("{}", trend->flights));
            for (const double value : {trend->median, shown_days * trend->per_day, shown_days * trend->low_per_day,
                                       shown_days * trend->high_per_day})
                cells.push_back(fmt::format("{:.3g}", value));
            cells.push_back(verdict(row));
        } else {
            cells.insert(cells.end(), 5, "-");
            cells.push_back("none: " + row.answer.why_not);
        }
        table.rows.push_back(std::move(cells));
    }
    return table;
}

std::string flights_csv(const std::vector<FlownFlight>& flights) {
    CsvWriter csv({"flight", "aircraft", "date", "in_air_s", "energy_wh", "distance_m", "air_distance_m",
                   quantities[0].name, quantities[1].name, quantities[2].name, quantities[3].name, quantities[4].name,
                   "resistance_low_ohm", "resistance_high_ohm", "charge_ah"});
    for (const auto& flight : flights) {
        const auto& facts = flight.facts;
        std::optional<double> low;
        std::optional<double> high;
        if (flight.resistance) {
            low = flight.resistance->interval_ohm.low;
            high = flight.resistance->interval_ohm.high;
        }
        csv.add(flight.name, flight.aircraft, facts.date, facts.in_air_s, facts.energy_wh, facts.distance_m,
                facts.air_distance_m, quantities[0].of(flight), quantities[1].of(flight), quantities[2].of(flight),
                quantities[3].of(flight), quantities[4].of(flight), low, high, flight.charge_ah);
    }
    return csv.text();
}

Json flight_json(const FlownFlight& flight) {
    const auto& facts = flight.facts;
    Json json{{"flight", flight.name},
              {"aircraft", flight.aircraft},
              {"date", facts.date},
              {"in_air_s", facts.in_air_s},
              {"energy_wh", cli::optional_json(facts.energy_wh)},
              {"distance_m", cli::optional_json(facts.distance_m)},
              {"air_distance_m", cli::optional_json(facts.air_distance_m)}};
    for (const auto& [name, of] : quantities) json[name] = cli::optional_json(of(flight));
    json["resistance_interval_ohm"] =
        flight.resistance ? Json::array({flight.resistance->interval_ohm.low, flight.resistance->interval_ohm.high})
                          : Json(nullptr);
    json["charge_ah"] = cli::optional_json(flight.charge_ah);
    return json;
}

Json trends_json(const std::vector<FlownFlight>& flights, const std::vector<AircraftTrend>& trends) {
    Json json{{"flights", Json::array()}, {"trends", Json::array()}};
    for (const auto& flight : flights) json["flights"].push_back(flight_json(flight));
    for (const auto& row : trends) {
        Json item{{"aircraft", row.aircraft}, {"quantity", row.quantity}};
        const auto& trend = row.answer.trend;
        item["dated_flights"] = trend ? Json(trend->flights) : Json(nullptr);
        item["median"] = trend ? Json(trend->median) : Json(nullptr);
        item["per_day"] = trend ? Json(trend->per_day) : Json(nullptr);
        item["per_day_interval"] = trend ? Json::array({trend->low_per_day, trend->high_per_day}) : Json(nullptr);
        item["significant"] = trend ? Json(is_significant(*trend)) : Json(nullptr);
        item["why_not"] = row.answer.why_not;
        json["trends"].push_back(std::move(item));
    }
    return json;
}

void say_what_changes(const cli::StageCall& call, const std::vector<FlownFlight>& flights,
                      const std::vector<AircraftTrend>& trends) {
    std::vector<std::string> undated;
    for (const auto& flight : flights)
        if (!flight.facts.start_clock_s) undated.push_back(flight.name);
    if (!undated.empty()) {
        cli::note(call,
                  fmt::format("in no trend, as neither clock nor name tells the date: {}", fmt::join(undated, ", ")));
    }
    std::size_t judged = 0;
    std::vector<std::string> changing;
    for (const auto& row : trends) {
        const auto& trend = row.answer.trend;
        if (!trend) continue;
        ++judged;
        if (!is_significant(*trend)) continue;
        changing.push_back(
            fmt::format("{} of {} {} by {:.3g} in 30 days ({:.3g} to {:.3g})", row.quantity, row.aircraft, verdict(row),
                        shown_days * std::abs(trend->per_day),
                        shown_days * std::min(std::abs(trend->low_per_day), std::abs(trend->high_per_day)),
                        shown_days * std::max(std::abs(trend->low_per_day), std::abs(trend->high_per_day))));
    }
    for (const auto& text : changing) cli::note(call, text);
    if (judged == 0)
        cli::note(call, "no trend can be told: " + trends.front().answer.why_not);
    else if (changing.empty())
        cli::note(call, fmt::format("none of {} quantities has a trend beyond its 95 % interval", judged));
    else
        cli::note(call,
                  fmt::format("{} of {} quantities judged; one in 20 has a trend by chance", changing.size(), judged));
}

int show_trends(const cli::StageCall& call) {
    auto flights = read_flights(call);
    if (flights.empty()) throw InputError({}, "no flight is left", "see the reasons above");
    std::ranges::stable_sort(flights, {}, [](const auto& flight) {
        return std::pair(flight.aircraft, flight.facts.start_clock_s.value_or(0.0));
    });
    for (const auto& aircraft : aircraft_of(flights)) add_resistances(call, flights, aircraft);
    const auto trends = trends_of(flights);
    const auto screen = screen_of(call);
    write_csv_result(call, flights_csv(flights),
                     {fmt::format("{} flights", flights.size()),
                      {"flight", "date", quantities[0].name, quantities[1].name, quantities[3].name, quantities[4].name,
                       "charge_ah"}});
    if (call.json)
        cli::print(cli::json_text(trends_json(flights, trends)));
    else if (call.output || screen.is_terminal)
        cli::print(screen_text(trend_table(trends), screen, {"trends", {"quantity", "verdict", "in 30 days"}}));
    say_what_changes(call, flights, trends);
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    cli::StageDefinition stage{
        "trends", "OUT|FLIGHT.data|SERIES.csv...",
        R"(Says how aircraft and pack age: of every flight its energy by minute and by kilometre over ground and through
the air, the mean power of its cruise, the pack's resistance and the charge drawn, as CSV; and whether they rise
or fall over the flights' dates, with 95 % intervals, each aircraft by itself. OUT is a folder of flightwatt
batch: the flights that it accepted; a flight that is in two of them counts once.)"};
    stage.shows_table = true;
    stage.options.add_options()("mix-aircraft", "take flights of several aircraft: each gets its own trends");
    cli::add_choice_options(stage.options);
    cli::add_flight_options(stage.options);
    return cli::run_stage(argc, argv, stage, show_trends);
}
