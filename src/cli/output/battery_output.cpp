#include "cli/output/battery_output.h"

#include "base/statistics.h"
#include "base/units.h"

#include <optional>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::battery {
Fields<ResistanceScatter> record_fields(const ResistanceScatter*) {
    using R = ResistanceScatter;
    return {field("sd_ohm", &R::sd_ohm, "standard deviation between flights"),
            field("flights", &R::flights, "flights with a resistance of their own")};
}

Fields<IdentifiedFlight> record_fields(const IdentifiedFlight*) {
    using R = IdentifiedFlight;
    using Own = FlightResistance;
    return {
        field("flight", &R::flight, "name of the flight", column{}),
        field("resting_voltage_v", &R::resting_voltage_v, "before take-off", column{"at rest V", ".3f"}),
        field("initial_depletion_ah", &R::initial_depletion_ah, "missing at the start", column{"missing Ah"}),
        field("initial_depletion_ah_interval_95", &R::initial_charge_interval_ah, "", column{"low Ah|high Ah"}),
        field("drawn_ah", &R::drawn_ah, "charge drawn in flight", column{"drawn Ah"}),
        field("resistance_ohm", at(&R::resistance, &Own::value_ohm), "by this flight alone", column{"own ohm"}),
        field("resistance_ohm_interval_95", at(&R::resistance, &Own::interval_ohm), "", column{"low ohm|high ohm"}),
        field("samples", &R::samples, "samples of the fit", column{}),
        field("unused_samples", &R::unused, "samples with a current that is not the motor's", column{"unused"}),
        field("voltage_rms_mv", at(&R::voltage_rms_v, units::mv_from_v), "residual", column{"fitted mV"}),
        field("air_temperature_c", &R::air_temperature_c, "mean air temperature", column_if_any("air C")),
        field("battery_temperature_c", &R::battery_temperature_c, "its mean temperature", column_if_any("battery C")),
        field("battery_start_c", &R::battery_start_c, "its temperature at take-off", column_if_any("at take-off C"))};
}

Fields<LeaveOneOutCheck> record_fields(const LeaveOneOutCheck*) {
    using R = LeaveOneOutCheck;
    return {
        field("flight", &R::flight, "flight that is predicted by the others"),
        field("initial_depletion_ah", &R::initial_charge_ah, "missing charge as known before take-off"),
        field("voltage_rms_mv", at(&R::voltage_rms_v, units::mv_from_v), "error", column_if_any("leave-one-out mV")),
        field("load_voltage_rms_mv", at(&R::load_rms_v, units::mv_from_v), "error from 3 s after the first load on",
              column_if_any("under load mV")),
        field("load_mean_error_mv", at(&R::load_mean_error_v, units::mv_from_v), "mean |error| of these"),
        field("load_interval_95_mv", at(&R::load_half_width_v, units::mv_from_v),
              "half width of their 95 % interval, mean"),
        field("load_interval_95_holds_percent", &R::load_held_percent, "part of the samples within that interval"),
        field("forecast_error_mv", at(&R::forecast_error_v, units::mv_from_v),
              "mean |error| by the others' power, 3 s after the first load; null: below a minute"),
        field("updated_forecast_error_mv", at(&R::updated_forecast_error_v, units::mv_from_v),
              "the same of all that remains, every 30 s in flight"),
        field("ahead_30_s_error_mv", at(&R::ahead_error_v, units::mv_from_v), "mean |error| 30 s ahead in flight",
              column_if_any("30 s ahead mV")),
        field("extrapolated_percent", &R::extrapolated_percent, "part of its charge that no other flight reached",
              column_if_any("extrapolated %", ".0f"))};
}

Fields<BatteryIdentification> record_fields(const BatteryIdentification*) {
    using R = BatteryIdentification;
    using Fit = decltype(R::fit);
    using Errors = decltype(R::errors);
    using Estimate = std::remove_cvref_t<decltype(*Battery::flight_estimate)>;
    const auto has_rc = [](const auto& value) {
        return [value](const R& r) { return r.fit.rc_resistance_ohm > 0.0 ? std::optional(value(r)) : std::nullopt; };
    };
    const auto curve = [](auto member) {
        return at(&R::battery, &Battery::thevenin, &TheveninCircuit::open_circuit, member);
    };
    const auto error_v = at(&R::battery, &Battery::intervals, &BatteryIntervals::open_circuit_standard_error_v);
    return {
        field("capacity_ah", at(&R::capacity, &Capacity::value_ah), "capacity of the pack"),
        field("capacity_ah_interval_95", at(&R::capacity, &Capacity::interval_ah), "null: it was given"),
        field("capacity_from", at(&R::capacity, &Capacity::origin), "origin of the capacity"),
        field("chemistry", &R::chemistry, "`LiPo`, `NMC` or `high-voltage LiPo`"),
        field("flight_estimate_ah", at(&R::battery, &Battery::flight_estimate, &Estimate::capacity_ah),
              "by the flights"),
        field("flight_estimate_ah_interval_95",
              at(&R::battery, &Battery::flight_estimate, &Estimate::capacity_interval_ah)),
        field("cells", &R::cells, "cells in series"),
        field("resistance_ohm", at(&R::fit, &Fit::resistance_ohm), "series resistance"),
        field("resistance_ohm_interval_95", at(&R::errors, &Errors::resistance_ohm)),
        field("resistance_between_flights", at(&R::battery, &Battery::intervals, &BatteryIntervals::resistance_scatter),
              "scatter of the flights' own resistances; null: of a single flight"),
        field("rc_resistance_ohm", at(&R::fit, &Fit::rc_resistance_ohm), "resistance of the RC pair"),
        field("rc_resistance_ohm_interval_95", at(&R::errors, &Errors::rc_resistance_ohm)),
        field("rc_time_constant_s", has_rc(at(&R::fit, &Fit::rc_time_constant_s)), "null: without an RC pair"),
        field("rc_time_constant_s_interval_95", has_rc(at(&R::errors, &Errors::rc_time_constant_s))),
        object<R>("open_circuit", "open-circuit voltage",
                  {field("soc_percent", curve(&OpenCircuitVoltage::soc_percent), "knots of the curve"),
                   field("voltage_v", curve(&OpenCircuitVoltage::voltage_v), "at the knots"),
                   field("standard_error_v", error_v, "at the knots"),
                   field("known_up_to_percent", &R::observed_max_soc_percent, "highest in the flights"),
                   field("known_down_to_percent", &R::observed_min_soc_percent, "lowest in the flights"),
                   field(
                       "known_down_to_ah", [](const R& r) { return r.fit.knots_ah.back(); },
                       "the same as charge from the beginning of the curve")}),
        field("voltage_rms_mv", at(&R::fit, &Fit::rms_v, units::mv_from_v), "residual of all flights"),
        field("flights", &R::flights, "flights of the fit")};
}

}  // namespace flightwatt::battery

namespace flightwatt::cli {
namespace {

/// A flight of an identification and its hold-out check.
struct CheckedFlight {
    const battery::IdentifiedFlight* flight = nullptr;
    const battery::LeaveOneOutCheck* check = nullptr;
};

Fields<CheckedFlight> record_fields(const CheckedFlight*) {
    using R = CheckedFlight;
    return list_fields<R>(embedded(at(&R::flight)), embedded(at(&R::check), {"flight"}));
}

/// "using the given capacity of 3.2 Ah; the flights indicate 5.4 Ah (2.45 to 11.5 Ah in 95 %)".
std::string describe_given_capacity(const battery::Battery& pack) {
    const auto text = fmt::format("using the given capacity of {:.4g} Ah; the flights ", pack.capacity_ah);
    if (!pack.flight_estimate) return text + "drew too little to estimate it";
    const auto& [low, high] = pack.flight_estimate->capacity_interval_ah;
    return text + fmt::format("indicate {:.3g} Ah ({:.3g} to {:.3g} Ah in 95 %)", pack.flight_estimate->capacity_ah,
                              low, high);
}

/// Warning of an implausible number of cells, or empty.
std::string cells_warning(const battery::BatteryIdentification& identified) {
    const auto& fullest = fullest_flight(identified);
    const auto warning =
        battery::cells_warning(fullest.resting_voltage_v, identified.cells, identified.cells_are_given);
    return warning.empty() ? "" : fullest.flight + ": " + warning;
}

/// Limits of the measured open-circuit curve, a sentence each for below and above.
std::vector<std::string> curve_limits(const battery::BatteryIdentification& identified) {
    std::vector<std::string> limits;
    if (identified.observed_min_soc_percent > 0.0)
        limits.push_back(fmt::format(
            "no data below {:.1f} % ({:.3f} Ah drawn): the open-circuit voltage is extrapolated parallel to the chart "
            "of {} {} cells; a deeper flight would measure it",
            identified.observed_min_soc_percent, identified.fit.knots_ah.back(), identified.cells,
            to_string(identified.chemistry)));
    if (identified.curve_start_depletion_ah > 0.0)
        limits.push_back(fmt::format(
            "no flight begins full: the fullest, {}, rests at {:.3f} V, {:.1f} % by the usual chart of {} {} cells{}",
            fullest_flight(identified).flight, fullest_flight(identified).resting_voltage_v,
            identified.observed_max_soc_percent, identified.cells, to_string(identified.chemistry),
            identified.flights.size() == 1 ? "; one flight does not determine both capacity and initial charge" : ""));
    return limits;
}

}  // namespace

Fields<BatteryOutput> record_fields(const BatteryOutput*) {
    using R = BatteryOutput;
    return list_fields<R>(embedded(at(&R::identified)),
                          field("leave_one_out", at(&R::left_out), "each flight predicted by the others"),
                          field("folds", &R::folds, "groups of flights for the prediction", optional_key{}));
}

std::string describe(const battery::Capacity& capacity) {
    auto text = fmt::format("capacity {:.3g} Ah ({})", capacity.value_ah, to_string(capacity.origin));
    if (!capacity.interval_ah) return text;
    return text +
           fmt::format(", {:.3g} to {:.3g} Ah in 95 % if packs differ from their chart by {:.0f} mV a cell (1 sd)",
                       capacity.interval_ah->low, capacity.interval_ah->high, units::mv_from_v(battery::chart_sd_v));
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
    std::vector<CheckedFlight> flights;
    for (std::size_t i = 0; i < identified.flights.size(); ++i)
        flights.push_back({&identified.flights[i], i < left_out.size() ? &left_out[i] : nullptr});
    return table_of(flights);
}

std::vector<BatteryRemark> battery_remarks(const battery::BatteryIdentification& identified) {
    std::vector<BatteryRemark> remarks;
    const auto warn = [&](std::string text) {
        if (!text.empty()) remarks.push_back({std::move(text), true});
    };
    const auto note = [&](std::string text) { remarks.push_back({std::move(text)}); };
    warn(identified.cells_warning);
    warn(cells_warning(identified));
    for (auto& limit : curve_limits(identified)) note(std::move(limit));
    if (!identified.battery.intervals.resistance_scatter)
        note(
            "how the series resistance differs between flights is not known, as fewer than two flights have one of "
            "their own: missions draw it by its interval alone");
    if (identified.capacity.origin == battery::CapacityOrigin::given) {
        auto warning = capacity_warning(identified.battery);
        if (warning.empty()) note(describe_given_capacity(identified.battery));
        warn(std::move(warning));
    }
    if (identified.capacity.origin == battery::CapacityOrigin::chart)
        warn(
            fmt::format("the flights do not determine the capacity, as none runs empty: {}; give the capacity on the "
                        "label with --capacity",
                        describe(identified.capacity)));
    if (identified.fit.rc_resistance_ohm == 0.0)
        warn("no RC pair explains anything: the battery has none");
    else if (identified.errors.rc_resistance_ohm.low == 0.0)
        warn("the RC pair may be none: its resistance's interval reaches down to 0");
    return remarks;
}

std::string provenance(const battery::BatteryIdentification& identified) {
    std::string text = "# Identified by flightwatt battery from";
    for (const auto& flight : identified.flights) text += " " + flight.flight;
    text += fmt::format(".\n# {}; {} cells.\n", describe(identified.capacity), identified.cells);
    for (const auto& warning : {capacity_warning(identified.battery), cells_warning(identified)})
        if (!warning.empty()) text += fmt::format("# Warning: {}.\n", warning);
    return text + fmt::format("# Voltages are met within {:.1f} mV RMS.\n", units::mv_from_v(identified.fit.rms_v));
}

}  // namespace flightwatt::cli
