#include "cli/output/battery_output.h"

#include "base/statistics.h"
#include "base/units.h"
#include "cli/output/records.h"

#include <tuple>

#include <fmt/format.h>

namespace flightwatt::cli {

std::string describe(const battery::Capacity& capacity) {
    auto text = fmt::format("capacity {:.3g} Ah ({})", capacity.value_ah, to_string(capacity.origin));
    if (!capacity.interval_ah) return text;
    return text +
           fmt::format(", {:.3g} to {:.3g} Ah in 95 % if packs differ from their chart by {:.0f} mV a cell (1 sd)",
                       capacity.interval_ah->low, capacity.interval_ah->high, units::mv_from_v(battery::chart_sd_v));
}

std::string describe_given_capacity(const battery::Battery& pack) {
    const auto text = fmt::format("using the given capacity of {:.4g} Ah; the flights ", pack.capacity_ah);
    if (!pack.flight_estimate) return text + "drew too little to estimate it";
    const auto& [low, high] = pack.flight_estimate->capacity_interval_ah;
    return text + fmt::format("indicate {:.3g} Ah ({:.3g} to {:.3g} Ah in 95 %)", pack.flight_estimate->capacity_ah,
                              low, high);
}

std::string cells_warning(const battery::BatteryIdentification& identified) {
    return battery::cells_warning(highest_resting_v(identified), identified.cells, identified.cells_are_given);
}

std::string describe_link(const battery::IdentifiedFlight& flight) {
    if (!flight.link) return "";
    return fmt::format(
        "{}: assumed to be flown on the pack of {}, as it begins {:.0f} min after that one ends, {}rests lower as far as "
        "was drawn, and its voltage under load agrees",
        flight.flight, flight.same_pack_as, units::minute_from_second(flight.link->pause_s),
        flight.link->counter_continues ? "its charge counter goes on, it " : "");
}

std::string describe(const battery::ResistanceTrend& trend) {
    const auto& [low, high] = trend.interval_ohm_a_flight;
    return fmt::format("series resistance over {} flights: {:+.2f} mohm a flight, {:+.2f} to {:+.2f} in 95 %{}",
                       trend.flights, units::mohm_from_ohm(trend.ohm_per_flight), units::mohm_from_ohm(low),
                       units::mohm_from_ohm(high), low <= 0.0 && high >= 0.0 ? ": no trend is seen" : "");
}

TextTable pack_table(const battery::Battery& pack) {
    TextTable table{{"parameter", "value", "95 %"}, {}};
    const auto add = [&](const char* name, double value, const std::optional<Interval>& interval) {
        table.rows.push_back({name, fmt::format("{:.4g}", value),
                              interval ? fmt::format("{:.4g} to {:.4g}", interval->low, interval->high) : "-"});
    };
    add("capacity [Ah]", pack.capacity_ah, pack.intervals.capacity_ah);
    if (const auto estimated = estimated_by_flights(pack))
        add("capacity by its flights [Ah]", estimated->capacity_ah, estimated->intervals.capacity_ah);
    if (!pack.thevenin) add("voltage [V]", pack.voltage_v, pack.intervals.voltage_v);
    add("resistance [ohm]", pack.resistance_ohm, pack.intervals.resistance_ohm);
    if (const auto& scatter = pack.intervals.resistance_scatter)
        add("resistance between flights, sd [ohm]", scatter->sd_ohm, std::nullopt);
    if (const auto& circuit = pack.thevenin; circuit && circuit->rc_resistance_ohm > 0.0) {
        add("RC resistance [ohm]", circuit->rc_resistance_ohm, pack.intervals.rc_resistance_ohm);
        add("RC time constant [s]", circuit->rc_time_constant_s, pack.intervals.rc_time_constant_s);
    }
    return table;
}

TextTable flights_table(const battery::BatteryIdentification& identified,
                        const std::vector<battery::LeaveOneOutCheck>& left_out) {
    const auto json = to_json(identified, left_out);
    auto flights = json["flights"];
    for (std::size_t i = 0; i < left_out.size(); ++i) flights[i]["check"] = json["left_out"][i];
    return table_of(
        flights,
        {"flight", "resting_voltage_v .3f: at rest V", "initial_charge_ah .3f: missing Ah",
         "initial_charge_interval_ah/low .3f: low Ah", "initial_charge_interval_ah/high .3f: high Ah",
         "drawn_ah .3f: drawn Ah", "resistance_ohm/value .4f: own ohm", "resistance_ohm/low .4f: low ohm",
         "resistance_ohm/high .4f: high ohm", "samples", "unused_samples: unused", "voltage_rms_mv .1f: fitted mV",
         "air_temperature_c? .1f: air C", "pack_of?: pack of", "check/voltage_rms_mv? .1f: leave-one-out mV",
         "check/load_voltage_rms_mv? .1f: under load mV", "check/placed_load_voltage_rms_mv? .1f: placed best mV",
         "check/beyond_others_percent? .0f: beyond the others %"});
}

std::vector<std::string> curve_limits(const battery::BatteryIdentification& identified) {
    std::vector<std::string> limits;
    if (identified.observed_min_soc_percent > 0.0)
        limits.push_back(fmt::format(
            "below {:.1f} % ({:.3f} Ah drawn) no flight shows the open-circuit voltage: it continues in parallel to the "
            "usual chart of {} {} cells, less certain the further down; a deeper flight would show it",
            identified.observed_min_soc_percent, identified.fit.knots_ah.back(), identified.cells,
            to_string(identified.chemistry)));
    if (identified.curve_start_depletion_ah > 0.0)
        limits.push_back(fmt::format(
            "no flight begins full: the fullest rests at {:.3f} V, {:.1f} % by the usual chart of {} {} cells{}",
            highest_resting_v(identified), identified.observed_max_soc_percent, identified.cells,
            to_string(identified.chemistry),
            identified.flights.size() == 1 ? "; one flight does not tell both capacity and initial charge" : ""));
    return limits;
}

std::string provenance(const battery::BatteryIdentification& identified) {
    std::string text = "# Identified by flightwatt battery from";
    for (const auto& flight : identified.flights) text += " " + flight.flight;
    text += fmt::format(".\n# {}; {} cells.\n", describe(identified.capacity), identified.cells);
    for (const auto& warning : {capacity_warning(identified.battery), cells_warning(identified)})
        if (!warning.empty()) text += fmt::format("# Warning: {}.\n", warning);
    for (const auto& limit : curve_limits(identified)) text += fmt::format("# {}.\n", limit);
    for (const auto& flight : identified.flights)
        if (flight.link) text += fmt::format("# {}.\n", describe_link(flight));
    text += fmt::format("# Voltages are met within {:.1f} mV RMS; intervals rest on {} blocks of {:.0f} s.\n",
                        units::mv_from_v(identified.fit.rms_v), identified.errors.blocks, identified.errors.block_s);
    return text;
}

namespace {

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json estimate(double value, const Interval& range) {
    return Json{{"value", value}, {"low", range.low}, {"high", range.high}};
}

Json flight_json(const battery::IdentifiedFlight& flight) {
    const auto& own = flight.resistance;
    return {{"flight", flight.flight},
            {"resting_voltage_v", flight.resting_voltage_v},
            {"initial_charge_ah", flight.initial_depletion_ah},
            {"initial_charge_interval_ah", interval_json(flight.initial_charge_interval_ah)},
            {"drawn_ah", flight.drawn_ah},
            {"pack_of", text_or_null(flight.same_pack_as)},
            {"pause_s", flight.link ? Json(flight.link->pause_s) : Json()},
            {"resistance_ohm", own ? estimate(own->value_ohm, own->interval_ohm) : Json()},
            {"air_temperature_c", optional_json(flight.air_temperature_c)},
            {"samples", flight.samples},
            {"unused_samples", flight.unused},
            {"voltage_rms_mv", units::mv_from_v(flight.voltage_rms_v)}};
}

Json check_json(const battery::LeaveOneOutCheck& check) {
    return {{"flight", check.flight},
            {"initial_charge_ah", check.initial_charge_ah},
            {"pack_of", text_or_null(check.pack_of)},
            {"voltage_rms_mv", units::mv_from_v(check.voltage_rms_v)},
            {"load_voltage_rms_mv", units::mv_from_v(check.load_rms_v)},
            {"placed_charge_ah", check.best_offset_ah},
            {"placed_load_voltage_rms_mv", units::mv_from_v(check.best_offset_load_rms_v)},
            {"beyond_others_percent", check.extrapolated_percent}};
}

}  // namespace

Json to_json(const battery::BatteryIdentification& identified, const std::vector<battery::LeaveOneOutCheck>& left_out) {
    const auto& [fit, errors] = std::tie(identified.fit, identified.errors);
    Json json;
    json["capacity_ah"] = identified.capacity.value_ah;
    json["capacity_from"] = to_string(identified.capacity.origin);
    json["chemistry"] = to_string(identified.chemistry);
    json["capacity_interval_ah"] = interval_json(identified.capacity.interval_ah);
    const auto& by_flights = identified.battery.flight_estimate;
    json["flight_estimate_ah"] =
        by_flights ? estimate(by_flights->capacity_ah, by_flights->capacity_interval_ah) : Json();
    json["cells"] = identified.cells;
    json["resistance_ohm"] = estimate(fit.resistance_ohm, errors.resistance_ohm);
    const auto& scatter = identified.battery.intervals.resistance_scatter;
    json["resistance_between_flights"] =
        scatter ? Json{{"sd_ohm", scatter->sd_ohm}, {"flights", scatter->flights}} : Json();
    json["rc_resistance_ohm"] = estimate(fit.rc_resistance_ohm, errors.rc_resistance_ohm);
    json["rc_time_constant_s"] = fit.rc_resistance_ohm > 0.0
                                     ? estimate(fit.rc_time_constant_s, errors.rc_time_constant_s)
                                     : Json{{"value", nullptr}, {"low", nullptr}, {"high", nullptr}};
    const auto& curve = identified.battery.thevenin->open_circuit;
    json["open_circuit"] = {{"soc_percent", curve.soc_percent},
                            {"voltage_v", curve.voltage_v},
                            {"standard_error_v", identified.battery.intervals.open_circuit_standard_error_v},
                            {"known_up_to_percent", identified.observed_max_soc_percent},
                            {"known_down_to_percent", identified.observed_min_soc_percent},
                            {"known_down_to_ah", fit.knots_ah.back()}};
    json["voltage_rms_mv"] = units::mv_from_v(fit.rms_v);
    json["flights"] = list_json(identified.flights, flight_json);
    json["resistance_trend"] = Json();
    if (const auto& trend = identified.trend) {
        json["resistance_trend"] = {{"flights", trend->flights},
                                    {"ohm_a_flight", estimate(trend->ohm_per_flight, trend->interval_ohm_a_flight)}};
    }
    json["left_out"] = list_json(left_out, check_json);
    return json;
}

}  // namespace flightwatt::cli
