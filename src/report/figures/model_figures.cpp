#include "report/figures/model_figures.h"

#include "base/statistics.h"
#include "base/text.h"
#include "battery/identification.h"
#include "mechanical/validation.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// The band ends at 0 W where the fit held the curve above it.
VegaJson area_rows(const mechanical::PhaseModel& phase, const std::vector<double>& time_s,
                   const std::vector<double>& low_w, const std::vector<double>& high_w) {
    if (low_w.empty()) return nullptr;
    FigureData data({"time_s", "low_w", "high_w"});
    for (std::size_t i = 0; i < time_s.size(); ++i)
        data.add({time_s[i], phase.not_negative ? std::max(low_w[i], 0.0) : low_w[i], high_w[i]});
    return data.json();
}

VegaJson model_rows(const mechanical::PhaseModel& phase) {
    FigureData data({"time_s", "power_w"});
    constexpr int intervals = 100;
    for (int i = 0; i <= intervals; ++i) {
        const double time_s = phase.duration_s * i / intervals;
        data.add({time_s, power_w(phase.fourier, time_s)});
    }
    return data.json();
}

/// The name of a model for an axis.
std::string words_of_model(const std::string& model) {
    static const std::map<std::string, std::string> words{{"constant_mean", "mean power"},
                                                          {"fourier", "Fourier series"},
                                                          {"by_phase", "chosen by phase"},
                                                          {"physical", "physical model"}};
    const auto found = words.find(model);
    return found == words.end() ? model : found->second;
}

FigureData error_rows(std::span<const mechanical::ValidatedFlight> flights) {
    FigureData data({"error_wh", "measured_wh", "predicted_wh"}, {"model", "flight"});
    for (const auto& model : model_names(flights)) {
        for (const auto& flight : flights) {
            const auto energy = predicted_energy(flight, model, std::nullopt);
            if (!energy) continue;
            const double predicted_wh = energy->estimate.energy_wh;
            data.add({predicted_wh - energy->measured_wh, energy->measured_wh, predicted_wh},
                     {words_of_model(model), flight.flight});
        }
    }
    return data;
}

/// The power of each bin as if it had been flown level and straight.
FigureData bin_rows(const mechanical::PhysicalModel& model, std::span<const mechanical::BinnedFlight> flights) {
    using enum mechanical::PowerTerm;
    FigureData data({"airspeed_m_per_s", "power_w", "climb_m_per_s", "measured_w", "start_s"}, {"flight"});
    for (const auto& flight : flights) {
        for (const auto& bin : flight.bins) {
            double power_w = bin.power_w;
            for (const auto term : {climb, descent, turn}) power_w -= model.coefficients[term] * bin.values[term];
            data.add({bin.airspeed_m_per_s, power_w, bin.values[climb], bin.power_w, bin.start_s},
                     {valid_utf8(flight.flight)});
        }
    }
    return data;
}

/// Level flight between two airspeeds, with the 95 % band where it is known.
void add_level_rows(FigureData& data, const mechanical::PhysicalModel& model, const mechanical::FlownRange& range,
                    std::string_view name) {
    constexpr int steps = 40;
    for (int i = 0; i <= steps; ++i) {
        const double airspeed = std::lerp(range.low, range.high, static_cast<double>(i) / steps);
        if (!(airspeed > 0.0)) continue;
        const auto terms = mechanical::term_values({airspeed}, model.load);
        const double power_w = sum_of_terms_w(model, terms);
        const double reach_w = model.level_sd ? student_t_half_width(model.degrees_of_freedom) *
                                                    std::sqrt(coefficient_variance_w2(model, terms))
                                              : std::nan("");
        data.add({airspeed, power_w, power_w - reach_w, power_w + reach_w}, {name});
    }
}

/// The best speeds; what is beyond the drawn airspeeds ends there.
FigureData best_rows(const mechanical::SpeedToFly& speeds, const mechanical::FlownRange& drawn) {
    FigureData data({"airspeed_m_per_s", "power_w", "low_m_per_s", "high_m_per_s"}, {"purpose"});
    const auto inside = [&](double airspeed) { return std::clamp(airspeed, drawn.low, drawn.high); };
    for (const auto& best : speeds.best) {
        const double airspeed = best.airspeed_m_per_s.value_or(best.below_flown ? 0.0 : 2.0 * drawn.high);
        const double power_w = mechanical::power_w(speeds.model, {inside(airspeed)});
        data.add({airspeed == inside(airspeed) ? airspeed : std::nan(""), power_w,
                  inside(best.low_m_per_s.value_or(drawn.low)), inside(best.high_m_per_s.value_or(drawn.high))},
                 {best.purpose});
    }
    return data;
}

}  // namespace

Figure model_figure(const mechanical::MechanicalModel& model, const flight::PerPhase<mechanical::CurveBand>& bands,
                    const std::string& id) {
    auto drawn = VegaJson::array({"model"});
    const auto& cruise = bands[flight::Phase::cruise];
    if (!cruise.time_s.empty()) drawn.push_back("95 % band");
    if (!cruise.flights_low_w.empty()) drawn.push_back("range of the flights");
    VegaJson legend = nullptr;
    if (drawn.size() > 1) legend = {{"values", drawn}, {"symbolType", "square"}, {"symbolOpacity", 1}, {"columns", 3}};
    auto panels = VegaJson::array();
    for (const auto phase : flight::all_phases) {
        const auto& band = bands[phase];
        const auto& fitted = model.phases[phase];
        panels.push_back({{"phase", phase_word(phase)},
                          {"legend", legend},
                          {"envelope", area_rows(fitted, band.time_s, band.flights_low_w, band.flights_high_w)},
                          {"band", area_rows(fitted, band.time_s, band.low_95_w, band.high_95_w)},
                          {"model", model_rows(fitted)}});
    }
    return new_figure(
        "model", id,
        "Power of each phase (Eq. 1), with the 95 % band of the mean and the range of the flights where they are known.",
        fmt::format("Mechanical power model {} over each phase.", model.name), {{"panels", panels}});
}

Figure validation_figure(std::span<const mechanical::ValidatedFlight> flights, const std::string& id) {
    return new_figure("validation", id,
                      "Predicted less measured energy of the whole flight; the prediction is from its durations by the "
                      "other flights. A ring is a flight.",
                      fmt::format("Error of the predicted energy of {} flights by leave-one-out.", flights.size()),
                      {{"errors", error_rows(flights).json()}});
}

Figure physical_figure(const mechanical::PhysicalFit& fit, std::span<const mechanical::BinnedFlight> flights,
                       const std::string& id) {
    constexpr double slower = 0.75;  // of the slowest airspeed flown
    const auto& flown = fit.model.airspeed_m_per_s;
    const mechanical::FlownRange drawn{fit.speeds ? slower * flown.low : flown.low, flown.high};
    const auto& model = fit.speeds ? fit.speeds->model : fit.model;
    FigureData level({"airspeed_m_per_s", "power_w", "low_w", "high_w"}, {"range"});
    add_level_rows(level, model, flown, "flown");
    if (fit.speeds) add_level_rows(level, model, {drawn.low, flown.low}, "slower than flown");
    auto description = fmt::format("Power over airspeed in level flight, with {} bins of {} flights.", fit.model.bins,
                                   fit.model.flights.size());
    VegaJson best = nullptr;
    if (fit.speeds) {
        best = best_rows(*fit.speeds, drawn).json();
        for (const auto& speed : fit.speeds->best)
            description += fmt::format(" {}: {}.", speed.purpose, describe(speed, flown));
    }
    return new_figure(
        "physical", id,
        "Power over airspeed in level flight, dashed where it is slower than flown. A ring is a bin of about "
        "30 s of a flight, less the power of its climb and turns. A bar is the 95 % interval of a best "
        "speed.",
        description,
        {{"level", level.json()},
         {"bins", bin_rows(fit.model, flights).json()},
         {"best", best},
         {"flown", {{"values", {{{"low", flown.low}, {"high", flown.high}}}}}},
         {"domain", {drawn.low, drawn.high}}});
}

namespace {

constexpr std::size_t battery_columns = 130;  // of a panel

/// A downsampled curve, broken where the record is not used.
void add_curve(FigureData& data, const battery::DischargeRecord& record, const std::vector<double>& voltage_v,
               std::string_view name) {
    for (const auto i : downsample_m4(record.time_s, voltage_v, battery_columns)) {
        data.add({record.time_s[i] - record.time_s.front(), record.used[i] ? voltage_v[i] : std::nan("")}, {name});
    }
}

FigureData voltage_rows(const battery::Battery& battery, const battery::DischargeRecord& record,
                        double initial_charge_ah) {
    FigureData data({"time_s", "voltage_v"}, {"curve"});
    add_curve(data, record, record.voltage_v, "measured");
    add_curve(data, record, predict_voltage(battery, record, initial_charge_ah).voltage_v, "model");
    return data;
}

/// The knots with their 95 % intervals, where those are known.
FigureData knot_rows(const battery::BatteryIdentification& identified) {
    const auto& curve = identified.battery.thevenin->open_circuit;
    const auto& errors_v = identified.battery.intervals.open_circuit_standard_error_v;
    FigureData data({"soc_percent", "voltage_v", "low_v", "high_v"}, {"origin"});
    for (std::size_t i = 0; i < curve.soc_percent.size(); ++i) {
        const double reach_v = errors_v.empty() ? std::nan("") : normal_half_width() * errors_v[i];
        // The last observed knot, whose state of charge is rounded, is from flights.
        const bool is_observed = curve.soc_percent[i] >= identified.observed_min_soc_percent - 1e-6;
        data.add({curve.soc_percent[i], curve.voltage_v[i], curve.voltage_v[i] - reach_v, curve.voltage_v[i] + reach_v},
                 {is_observed ? "from flights" : "by the chart"});
    }
    return data;
}

}  // namespace

Figure voltage_figure(const battery::BatteryIdentification& identified,
                      std::span<const battery::DischargeRecord> records, const std::string& id) {
    auto description = fmt::format("Terminal voltage of {} flights over time, measured and modelled.", records.size());
    auto panels = VegaJson::array();
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto& record = records[i];
        const auto [low, high] = std::ranges::minmax_element(record.voltage_v);
        description += fmt::format(" {}: {:.2f} to {:.2f} V.", record.flight, *low, *high);
        const auto rows = voltage_rows(identified.battery, record, identified.flights[i].initial_depletion_ah);
        panels.push_back({{"curves", rows.json()}, {"flight", valid_utf8(record.flight)}});
    }
    return new_figure(
        "voltage", id,
        "The modelled voltage is from the measured current and the charge missing at the start. Both curves are broken "
        "where the current contradicts the motor's state.",
        description, {{"panels", panels}});
}

Figure open_circuit_figure(const battery::BatteryIdentification& identified, const std::string& id) {
    const auto& curve = identified.battery.thevenin->open_circuit;
    std::string caption = "Open-circuit voltage with the 95 % intervals of its knots.";
    if (identified.observed_min_soc_percent > 0.0) {
        caption += fmt::format(
            " Below {:.0f} %, the range of the flights, it is parallel to the chart of {} {} cells, with growing "
            "uncertainty.",
            identified.observed_min_soc_percent, identified.cells, to_string(identified.chemistry));
    }
    auto figure =
        new_figure("open_circuit", id, caption,
                   fmt::format("Open-circuit voltage over state of charge: {:.2f} V empty, {:.2f} V full, observed "
                               "down to {:.0f} %.",
                               curve.voltage_v.front(), curve.voltage_v.back(), identified.observed_min_soc_percent),
                   {{"knots", knot_rows(identified).json()}});
    // The first layer is the intervals.
    if (identified.battery.intervals.open_circuit_standard_error_v.empty()) figure.spec["layer"].erase(0);
    return figure;
}

}  // namespace flightwatt::report
