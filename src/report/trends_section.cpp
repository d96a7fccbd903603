#include "report/trends_section.h"

#include "base/error.h"
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
    {"cruise_power_w", "cruise [W]",
     [](const FlightTrendData& f) { return f.facts.mean_power_w[flight::Phase::cruise]; }},
    {"resistance_ohm", "pack [ohm]",
     [](const FlightTrendData& f) { return f.resistance ? std::optional(f.resistance->value_ohm) : std::nullopt; }},
    {"capacity_percent", "pack [% of its mean]", [](const FlightTrendData& f) { return f.capacity_percent; }},
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
        flight.capacity_percent = units::percentage(capacity->ratio, 1.0);
        flight.capacity_ah = mean_ah * capacity->ratio;
        flight.capacity_interval_ah = {mean_ah * capacity->ratio_interval.low, mean_ah * capacity->ratio_interval.high};
    }
    if (flights.size() == 1) return unknown > 0 ? "a single flight does not determine a capacity" : "";
    if (unknown > 0)
        return fmt::format("no capacity of {} of {} flights: their charge does not determine it within 15 %", unknown,
                           flights.size());
    const bool is_guess = identified.capacity.origin == battery::CapacityOrigin::chart;
    return is_guess ? "the mean capacity is a guess from charts of lithium cells; give it with --capacity" : "";
}

constexpr double ms_per_day = 86400.0 * 1000.0;

std::string title_of(const AircraftTrend& trend) {
    return std::ranges::find(quantities, trend.quantity, &TrendQuantity::name)->title;
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
        const auto& slope = *trend.answer.trend;
        description += fmt::format(" {}: {:.3g}, {:+.3g} in {} days ({:+.3g} to {:+.3g}), {}.", title_of(trend),
                                   slope.median, shown_days * slope.per_day, shown_days, shown_days * slope.low_per_day,
                                   shown_days * slope.high_per_day, trend_direction(trend));
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
    flown.aircraft = flight::describe_aircraft(flight.data.aircraft_id, flight.data.aircraft_name);
    flown.aircraft_id = flight.data.aircraft_id;
    flown.aircraft_name = flight.data.aircraft_name;
    flown.facts = summarize_flight(flight);
    try {
        flown.records = battery::discharge_records(flight.data).records;
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

std::vector<AircraftTrend> estimate_trends(std::span<const FlightTrendData> flights) {
    constexpr double seconds_per_day = 86400.0;
    std::vector<AircraftTrend> trends;
    for (const auto& aircraft : aircraft_names(flights)) {
        for (const auto& [name, title, of] : quantities) {
            AircraftTrend trend{aircraft, name, {}, {}};
            for (const auto& flight : flights) {
                if (flight.aircraft != aircraft) continue;
                const auto value = of(flight);
                trend.aircraft_id = flight.aircraft_id;
                trend.aircraft_name = flight.aircraft_name;
                if (flight.facts.start_clock_s && value)
                    trend.values.push_back({*flight.facts.start_clock_s / seconds_per_day, *value});
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

Fields<AircraftTrend> record_fields(const AircraftTrend*) {
    using R = AircraftTrend;
    using T = batch::Trend;
    using A = batch::TrendResult;
    const auto interval = [](const T& trend) { return Interval{trend.low_per_day, trend.high_per_day}; };
    const auto change = [](const T& trend) { return shown_days * trend.per_day; };
    const auto change_interval = [](const T& trend) {
        return Interval{shown_days * trend.low_per_day, shown_days * trend.high_per_day};
    };
    return {field("aircraft", &R::aircraft, "", column{}, not_in_json{}),
            field("aircraft_id", &R::aircraft_id, "id of the aircraft"),
            field("aircraft_name", &R::aircraft_name, "name of the aircraft"),
            field("quantity", &R::quantity, "key of `flights[]`", column{}),
            field("dated_flights", at(&R::answer, &A::trend, &T::flights), "flights of the trend", column{"flights"}),
            field("median", at(&R::answer, &A::trend, &T::median), "of these flights", column{"median", ".3g"}),
            field("per_day", at(&R::answer, &A::trend, &T::per_day), "slope"),
            field("per_day_interval_95", at(&R::answer, &A::trend, interval)),
            field("change", at(&R::answer, &A::trend, change), "", column{"in 30 days", ".3g"}, not_in_json{}),
            field("change_interval_95", at(&R::answer, &A::trend, change_interval), "", column{"low|high", ".3g"},
                  not_in_json{}),
            field("significant", at(&R::answer, &A::trend, batch::is_significant), "the interval excludes 0"),
            field("no_trend_reason", at(&R::answer, &A::no_trend_reason), "reason without a trend"),
            field("trend", trend_direction, "", column{}, not_in_json{})};
}

std::optional<Section> trends_section(const std::vector<AircraftTrend>& trends) {
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
    add_table(section, {table_of(trends), "Trends over the dates of flights", "tab:trends"}, {.sortable = true});
    return section;
}

}  // namespace flightwatt::report
