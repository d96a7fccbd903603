#include "report/trends_section.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/flight_identity.h"

#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

std::optional<double> per(const std::optional<double>& energy_wh, const std::optional<double>& much) {
    if (!energy_wh || !much || *much <= 0.0) return std::nullopt;
    return *energy_wh / *much;
}

constexpr double metres_per_km = 1000.0;

constexpr std::array<TrendQuantity, 6> quantities{{
    {"energy_wh_per_min", "energy [Wh/min]",
     [](const FlightTrendData& f) { return per(f.facts.energy_wh, units::minute_from_second(f.facts.in_air_s)); }},
    {"energy_wh_per_km", "ground [Wh/km]",
     [](const FlightTrendData& f) { return per(f.facts.energy_wh, f.facts.distance_m.value_or(0.0) / metres_per_km); }},
    {"energy_wh_per_air_km", "air [Wh/km]",
     [](const FlightTrendData& f) {
         return per(f.facts.energy_wh, f.facts.air_distance_m.value_or(0.0) / metres_per_km);
     }},
    {"cruise_power_w", "cruise [W]", [](const FlightTrendData& f) { return f.facts.cruise_power_w; }},
    {"resistance_ohm", "pack [ohm]",
     [](const FlightTrendData& f) { return f.resistance ? std::optional(f.resistance->value_ohm) : std::nullopt; }},
    {"capacity_ah", "pack [Ah]", [](const FlightTrendData& f) { return f.capacity_ah; }},
}};

std::set<std::string> aircraft_names(std::span<const FlightTrendData> flights) {
    std::set<std::string> names;
    for (const auto& flight : flights) names.insert(flight.aircraft);
    return names;
}

/// Of one aircraft's flights; returns the reasons for missing values.
std::string add_health_of(std::span<FlightTrendData* const> flights, std::size_t max_flights,
                          const std::optional<double>& capacity_ah) {
    if (flights.empty()) return "";
    if (flights.size() > max_flights)
        return fmt::format("no resistance and no capacity of {} flights, expected at most {}", flights.size(),
                           max_flights);
    std::vector<battery::DischargeRecord> records;
    for (const auto* flight : flights) records.push_back(flight->records.front());
    battery::BatteryIdentification identified;
    try {
        identified =
            identify_battery(records, {.capacity_ah = capacity_ah, .cells = {}, .name = "", .with_capacities = true});
    } catch (const NoResultError& error) {
        return fmt::format("no resistances and no capacities: {}", error.what());
    }
    const bool is_guess = identified.capacity.origin == battery::CapacityOrigin::chart;
    std::size_t unknown = 0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        auto& flight = *flights[i];
        flight.resistance = identified.flights.at(i).resistance;
        const auto& capacity = identified.flights.at(i).capacity;
        if (!capacity) {
            ++unknown;
            continue;
        }
        const double mean_ah = identified.capacity.value_ah;
        flight.capacity_ah = mean_ah * capacity->ratio;
        flight.capacity_level_is_guess = is_guess;
        flight.capacity_interval_ah = {mean_ah * capacity->ratio_interval.low, mean_ah * capacity->ratio_interval.high};
    }
    if (flights.size() == 1) return unknown > 0 ? "a single flight does not determine a capacity" : "";
    if (unknown > 0)
        return fmt::format("no capacity of {} of {} flights: their charge does not determine it within 15 %", unknown,
                           flights.size());
    return is_guess ? "the mean capacity is a guess from charts of lithium cells, trends are in percent of it; give it "
                      "with --capacity"
                    : "";
}

constexpr double ms_per_day = 86400.0 * 1000.0;

std::string title_of(const AircraftTrend& trend) {
    const auto all = trend_quantities();
    const std::string title = std::ranges::find(all, trend.quantity, &TrendQuantity::name)->title;
    return trend.level_is_guess ? title + ", level a guess" : title;
}

/// Flights as points, the slope as a line through their middle, with the ends of its interval.
VegaJson trend_panel(const AircraftTrend& trend) {
    FigureData flights({"date", "value"});
    flights.round_to({0, 6});
    std::vector<double> days;
    for (const auto& [day, value] : trend.values) {
        flights.add({day * ms_per_day, value});
        days.push_back(day);
    }
    const auto& slope = *trend.answer.trend;
    const double middle_day = median(days);
    const auto range = std::ranges::minmax(days);
    std::vector<double> offsets;
    for (const auto& [day, value] : trend.values) offsets.push_back(value - slope.per_day * (day - middle_day));
    const double middle = median(std::move(offsets));
    FigureData slopes({"date", "value"}, {"slope"});
    slopes.round_to({0, 6});
    for (const auto& [per_day, name] : std::initializer_list<std::pair<double, std::string_view>>{
             {slope.per_day, "median slope"}, {slope.low_per_day, "low, 95 %"}, {slope.high_per_day, "high, 95 %"}})
        for (const double day : {range.min, range.max})
            slopes.add({day * ms_per_day, middle + per_day * (day - middle_day)}, {name});
    return {{"flights", flights.json()}, {"slopes", slopes.json()}, {"title", title_of(trend)}};
}

/// The known trends of one aircraft.
Figure trend_figure(std::span<const AircraftTrend> trends, const std::string& aircraft, const std::string& id) {
    auto description = "Trends of " + aircraft + " and its pack over the dates of flights.";
    auto panels = VegaJson::array();
    for (const auto& trend : trends) {
        if (trend.aircraft != aircraft || !trend.answer.trend) continue;
        const auto [slope, low, high, unit] = shown_slope(trend);
        description +=
            fmt::format(" {}: {:.3g}, {:+.3g}{} in 30 days ({:+.3g}{} to {:+.3g}{}), {}.", title_of(trend),
                        trend.answer.trend->median, slope, unit, low, unit, high, unit, trend_direction(trend));
        panels.push_back(trend_panel(trend));
    }
    return new_figure("trends", id,
                      "A point is a flight; the line has the median of the slopes between all pairs of flights, the "
                      "dashed lines the ends of its 95 % interval.",
                      description, {{"panels", panels}});
}

}  // namespace

std::span<const TrendQuantity> trend_quantities() { return quantities; }

FlightTrendData extract_trend_data(const ReportFlight& flight) {
    FlightTrendData flown;
    flown.name = flight.name;
    flown.aircraft = flight::describe_aircraft(flight.series.aircraft_id, flight.series.aircraft_name);
    flown.aircraft_id = flight.series.aircraft_id;
    flown.aircraft_name = flight.series.aircraft_name;
    flown.facts = summarize_flight(flight);
    try {
        flown.records = battery::discharge_records(flight.series).records;
    } catch (const InputError& error) {
        flown.no_record_reason = error.what();
    }
    for (const auto& record : flown.records) flown.charge_ah = flown.charge_ah.value_or(0.0) + record.charge_ah.back();
    return flown;
}

std::vector<std::string> add_state_of_health(std::vector<FlightTrendData>& flights, std::size_t max_flights,
                                             std::optional<double> capacity_ah) {
    std::vector<std::string> notes;
    for (const auto& aircraft : aircraft_names(flights)) {
        std::vector<FlightTrendData*> flown;
        for (auto& flight : flights)
            if (flight.aircraft == aircraft && !flight.records.empty()) flown.push_back(&flight);
        const auto note = add_health_of(flown, max_flights, capacity_ah);
        if (!note.empty()) notes.push_back(fmt::format("{}: {}", aircraft, note));
    }
    return notes;
}

std::vector<AircraftTrend> trends_of(std::span<const FlightTrendData> flights) {
    constexpr double seconds_per_day = 86400.0;
    std::vector<AircraftTrend> trends;
    for (const auto& aircraft : aircraft_names(flights)) {
        for (const auto& [name, title, of] : quantities) {
            AircraftTrend trend{aircraft, name, {}, {}};
            const bool is_capacity = std::string_view(name) == "capacity_ah";
            for (const auto& flight : flights) {
                const auto value = of(flight);
                if (flight.aircraft == aircraft) {
                    trend.aircraft_id = flight.aircraft_id;
                    trend.aircraft_name = flight.aircraft_name;
                }
                if (flight.aircraft == aircraft && flight.facts.start_clock_s && value)
                    trend.values.push_back({*flight.facts.start_clock_s / seconds_per_day, *value});
                trend.level_is_guess = trend.level_is_guess ||
                                       (is_capacity && flight.aircraft == aircraft && flight.capacity_level_is_guess);
            }
            trend.answer = estimate_trend(trend.values);
            if (trend.values.empty()) trend.answer.no_trend_reason = "no dated flight has this quantity";
            trends.push_back(std::move(trend));
        }
    }
    return trends;
}

std::string trend_direction(const AircraftTrend& trend) {
    const auto& slope = trend.answer.trend;
    if (!slope) return "unknown: " + trend.answer.no_trend_reason;
    if (!is_significant(*slope)) return "not significant";
    return slope->per_day > 0.0 ? "rises" : "falls";
}

ShownSlope shown_slope(const AircraftTrend& trend) {
    constexpr double days = 30.0;
    const auto& slope = trend.answer.trend.value();
    const auto relative = trend.level_is_guess ? relative_trend(slope) : std::nullopt;
    const auto shown = relative.value_or(slope);
    return {days * shown.per_day, days * shown.low_per_day, days * shown.high_per_day, relative ? " %" : ""};
}

TextTable trend_table(std::span<const AircraftTrend> trends) {
    TextTable table{{"aircraft", "quantity", "flights", "median", "in 30 days", "low", "high", "trend"}, {}};
    for (const auto& row : trends) {
        std::vector<std::string> cells{row.aircraft, row.quantity};
        if (const auto& trend = row.answer.trend) {
            cells.push_back(fmt::format("{}", trend->flights));
            const auto [slope, low, high, unit] = shown_slope(row);
            cells.push_back(fmt::format("{:.3g}", trend->median));
            for (const double value : {slope, low, high}) cells.push_back(fmt::format("{:.3g}{}", value, unit));
        } else {
            cells.insert(cells.end(), 5, "-");
        }
        cells.push_back(trend_direction(row));
        table.rows.push_back(std::move(cells));
    }
    return table;
}

std::optional<Section> trends_section(std::span<const AircraftTrend> trends) {
    std::set<std::string> aircraft;
    for (const auto& trend : trends)
        if (trend.answer.trend) aircraft.insert(trend.aircraft);
    if (aircraft.empty()) return std::nullopt;
    Section section{"trends", "Trends"};
    section.html += paragraph(
        "Aircraft and packs over the dates of their flights. A trend is significant if its interval excludes 0; one in "
        "20 is by chance. Wind, season and different packs have effects too.");
    for (const auto& name : aircraft) {
        if (aircraft.size() > 1) section.html += heading(name);
        add_figure(section, trend_figure(trends, name, fmt::format("trends-{}", section.figures.size() + 1)));
    }
    add_table(section, {trend_table(trends), "Trends over the dates of flights", "tab:trends"}, {.sortable = true});
    return section;
}

}  // namespace flightwatt::report
