#include "report/trends_section.h"

#include "base/error.h"
#include "base/units.h"
#include "cli/output/pack_output.h"
#include "flight/flight_identity.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <utility>

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
    {"energy_wh_per_km", "over ground [Wh/km]",
     [](const FlightTrendData& f) { return per(f.facts.energy_wh, f.facts.distance_m.value_or(0.0) / metres_per_km); }},
    {"energy_wh_per_air_km", "through air [Wh/km]",
     [](const FlightTrendData& f) {
         return per(f.facts.energy_wh, f.facts.air_distance_m.value_or(0.0) / metres_per_km);
     }},
    {"cruise_power_w", "cruise power [W]",
     [](const FlightTrendData& f) { return f.facts.mean_power_w[flight::Phase::cruise]; }},
    {"resistance_ohm", "resistance [ohm]",
     [](const FlightTrendData& f) { return f.resistance ? std::optional(f.resistance->value_ohm) : std::nullopt; }},
    {"capacity_percent", "capacity [% of mean]", [](const FlightTrendData& f) { return f.capacity_percent; }},
}};

std::set<std::string> aircraft_names(std::span<const FlightTrendData> flights) {
    std::set<std::string> names;
    for (const auto& flight : flights) names.insert(flight.aircraft);
    return names;
}

constexpr double relative_margin = 0.05;  // of equal values
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
    // The interval of few flights is cut: it would hide them.
    const auto [low, high] = std::ranges::minmax(trend.values, {}, &batch::DatedValue::value);
    const double margin = std::max(high.value - low.value, relative_margin * std::abs(high.value));
    const VegaJson domain{low.value - margin, high.value + margin};
    return {{"flights", flights.json()}, {"slopes", slopes.json()}, {"domain", domain}, {"title", title_of(trend)}};
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

FlightTrendData extract_trend_data(const ReportFlight& flight, const std::string& folder) {
    FlightTrendData flown;
    flown.name = flight.name;
    flown.aircraft = flight::describe_aircraft(flight.data.aircraft_id, flight.data.aircraft_name);
    flown.aircraft_id = flight.data.aircraft_id;
    flown.aircraft_name = flight.data.aircraft_name;
    flown.facts = summarize_flight(flight);
    try {
        flown.uses = answer::pack_uses(flight.data, battery::discharge_records(flight.data).records, folder);
    } catch (const InputError& error) {
        flown.no_uses_reason = error.what();
    }
    for (const auto& use : flown.uses) flown.charge_ah = flown.charge_ah.value_or(0.0) + use.record.charge_ah.back();
    return flown;
}

std::vector<answer::PackUse> take_uses(std::vector<FlightTrendData>& flights) {
    std::vector<answer::PackUse> uses;
    for (auto& flight : flights) std::ranges::move(std::exchange(flight.uses, {}), std::back_inserter(uses));
    return uses;
}

answer::PackLedger add_state_of_health(std::vector<FlightTrendData>& flights, std::vector<answer::PackUse> uses,
                                       const answer::LedgerOptions& options) {
    std::map<std::string, FlightTrendData*> by_use;
    for (auto& flight : flights) by_use.emplace(flight.name, &flight);
    auto ledger = answer::make_pack_ledger(std::move(uses), options);
    for (const auto& use : ledger.uses) {
        const auto flight = by_use.find(use.flight);
        if (flight == by_use.end() || !use.found) continue;
        auto& found = *flight->second;
        found.resistance = use.found->resistance;
        const auto& capacity = use.found->capacity;
        if (!capacity) continue;
        const double mean_ah = use.mean_capacity_ah;
        found.capacity_percent = units::percentage(capacity->ratio, 1.0);
        found.capacity_ah = mean_ah * capacity->ratio;
        found.capacity_interval_ah = {mean_ah * capacity->ratio_interval.low, mean_ah * capacity->ratio_interval.high};
    }
    return ledger;
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

std::optional<Section> trends_section(const std::vector<AircraftTrend>& trends, const answer::PackLedger& ledger) {
    std::set<std::string> aircraft;
    for (const auto& trend : trends)
        if (trend.answer.trend) aircraft.insert(trend.aircraft);
    const bool has_packs =
        std::ranges::any_of(ledger.packs, [](const auto& pack) { return pack.named_by != answer::PackNaming::none; });
    if (aircraft.empty() && !has_packs) return std::nullopt;
    Section section{"trends", "Packs and trends"};
    std::vector<std::string> lines;
    for (const auto& pack : ledger.packs) lines.push_back(describe(pack));
    if (!ledger.packs.empty()) {
        section.html += heading("Packs") + list_html(lines);
        add_table(section, {table_of(ledger.packs), "Packs with their flights", "tab:packs"}, {.sortable = true});
    }
    section.html += list_html(ledger.notes);
    if (aircraft.empty()) return section;
    section.html +=
        heading("Trends") +
        paragraph(
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
