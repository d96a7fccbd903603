#include "report/flight_trends.h"

#include "base/error.h"
#include "base/units.h"
#include "cli/output/pack_output.h"
#include "flight/flight_identity.h"
#include "flight/vtol_flight.h"
#include "report/document/columns.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

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
     [](const FlightTrendData& f) { return f.resistance ? std::optional(f.resistance->value_ohm) : std::nullopt; },
     true},
    {"capacity_percent", "capacity [% of mean]", [](const FlightTrendData& f) { return f.capacity_percent; }, true},
}};

std::set<std::string> aircraft_names(std::span<const FlightTrendData> flights) {
    std::set<std::string> names;
    for (const auto& flight : flights) names.insert(flight.aircraft);
    return names;
}

constexpr double seconds_per_day = answer::seconds_per_day;

/// The slope as a line through the middle of the flights, with the ends of its interval; null without a trend.
Json lines_of(const AircraftTrend& trend) {
    if (!trend.answer.trend) return nullptr;
    const auto& slope = *trend.answer.trend;
    std::vector<double> days;
    for (const auto& flown : trend.values) days.push_back(flown.day);
    const double middle_day = median(days);
    const auto range = std::ranges::minmax(days);
    std::vector<double> offsets;
    for (const auto& [day, value] : trend.values) offsets.push_back(value - slope.per_day * (day - middle_day));
    const double middle = median(std::move(offsets));
    auto lines = Json::array();
    for (const auto& [per_day, name] : std::initializer_list<std::pair<double, const char*>>{
             {slope.per_day, "median slope"}, {slope.low_per_day, "low, 95 %"}, {slope.high_per_day, "high, 95 %"}}) {
        const auto value_at = [&, of = per_day](double day) { return middle + of * (day - middle_day); };
        lines.push_back({{"name", name},
                         {"clock_s", rounded_column({range.min * seconds_per_day, range.max * seconds_per_day}, 0)},
                         {"value", column_of({value_at(range.min), value_at(range.max)})}});
    }
    return lines;
}

Json trend_json(const AircraftTrend& trend) {
    const auto& slope = trend.answer.trend;
    std::vector<double> clock_s;
    std::vector<double> values;
    for (const auto& [day, value] : trend.values) {
        clock_s.push_back(day * seconds_per_day);
        values.push_back(value);
    }
    return {{"aircraft", trend.aircraft},
            {"title", std::ranges::find(quantities, trend.quantity, &TrendQuantity::name)->title},
            {"direction", trend_direction(trend)},
            {"change_in_30_days", slope ? Json(shown_days * slope->per_day) : Json()},
            {"change_in_30_days_interval_95",
             slope ? JsonType<Interval>::write({shown_days * slope->low_per_day, shown_days * slope->high_per_day})
                   : Json()},
            {"flights", {{"clock_s", rounded_column(clock_s, 0)}, {"value", column_of(values)}}},
            {"lines", lines_of(trend)}};
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
    flown.only_hovers = std::ranges::all_of(
        flight.phases.sorties, [&](const auto& sortie) { return flight::only_hovers(flight.data, sortie); });
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
    std::vector<AircraftTrend> trends;
    for (const auto& aircraft : aircraft_names(flights)) {
        const bool all_hover = std::ranges::all_of(
            flights, [&](const auto& flight) { return flight.aircraft != aircraft || flight.only_hovers; });
        for (const auto& [name, title, of, is_of_pack] : quantities) {
            AircraftTrend trend{aircraft, name, {}, {}};
            for (const auto& flight : flights) {
                if (flight.aircraft != aircraft || (flight.only_hovers && !all_hover && !is_of_pack)) continue;
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

Json trends_json(const std::vector<AircraftTrend>& trends, const answer::PackLedger& ledger, LatexTables& tables) {
    const bool has_trend = std::ranges::any_of(trends, [](const auto& one) { return one.answer.trend.has_value(); });
    const bool has_packs =
        std::ranges::any_of(ledger.packs, [](const auto& pack) { return pack.named_by != answer::PackNaming::none; });
    if (!has_trend && !has_packs) return nullptr;
    tables.add({table_of(ledger.packs), "Packs with their flights", "tab:packs"});
    if (has_trend) tables.add({table_of(trends), "Trends over the dates of flights", "tab:trends"});
    auto all = Json::array();
    for (const auto& trend : trends) all.push_back(trend_json(trend));
    return {{"packs", json_list<answer::Pack>(ledger.packs)},
            {"notes", ledger.notes},
            {"text",
             "Aircraft and packs over the dates of their flights. A trend is significant if its interval excludes 0; "
             "one in 20 is by chance. Wind, season and different packs have effects too."},
            {"trends", std::move(all)}};
}

}  // namespace flightwatt::report
