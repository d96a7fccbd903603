#include "base/statistics.h"
#include "base/text.h"
#include "base/units.h"
#include "battery/identification.h"
#include "mechanical/validation.h"
#include "report/figures/flight_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

VegaJson area_rows(const std::vector<double>& time_s, const std::vector<double>& low_w,
                   const std::vector<double>& high_w) {
    if (low_w.empty()) return nullptr;
    FigureData data({"time_s", "low_w", "high_w"});
    for (std::size_t i = 0; i < time_s.size(); ++i) data.add({time_s[i], low_w[i], high_w[i]});
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

VegaJson published_rows(const PublishedCurve& curve) {
    if (curve.time_s.empty()) return nullptr;
    FigureData data({"time_s", "power_w"});
    for (std::size_t i = 0; i < curve.time_s.size(); ++i) data.add({curve.time_s[i], curve.value[i]});
    return data.json();
}

/// RMS difference of published and model, over the points within the phase.
double rms_w(const mechanical::PhaseModel& phase, const PublishedCurve& curve) {
    double squares = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < curve.time_s.size(); ++i) {
        if (curve.time_s[i] > phase.duration_s) continue;
        squares += std::pow(curve.value[i] - power_w(phase.fourier, curve.time_s[i]), 2);
        ++count;
    }
    return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(count, 1)));
}

std::string model_caption(const mechanical::MechanicalModel& model, const PublishedFigures& published) {
    std::string text = "Power of each phase (Eq. 1).";
    if (published.power[flight::Phase::cruise].time_s.empty()) return text;
    text += " Points: the paper's Fig. 2 (c-e), digitised; RMS difference";
    for (const auto phase : flight::all_phases) {
        text += fmt::format("{} {} {:.3f} W", phase == flight::Phase::takeoff ? "" : ",", phase_word(phase),
                            rms_w(model.phases[phase], published.power[phase]));
    }
    return text + ".";
}

FigureData error_rows(std::span<const mechanical::ValidatedFlight> flights) {
    FigureData data({"error_wh", "measured_wh", "predicted_wh"}, {"model", "flight"});
    for (const auto& model : model_names(flights)) {
        for (const auto& flight : flights) {
            const auto energy = predicted_energy(flight, model, std::nullopt);
            if (!energy) continue;
            const double predicted_wh = energy->estimate.energy_wh;
            data.add({predicted_wh - energy->measured_wh, energy->measured_wh, predicted_wh}, {model, flight.flight});
        }
    }
    return data;
}

constexpr int points_of_line = 41;

FigureData bin_rows(std::span<const mechanical::BinnedFlight> flights) {
    FigureData data({"airspeed_m_per_s", "power_w", "climb_m_per_s", "start_s"}, {"flight"});
    for (const auto& flight : flights) {
        for (const auto& bin : flight.bins) {
            data.add({bin.airspeed_m_per_s, bin.power_w, bin.values[mechanical::PowerTerm::climb], bin.start_s},
                     {valid_utf8(flight.flight)});
        }
    }
    return data;
}

/// Drawn climb rates: 0, and half of the flown extremes.
std::vector<double> drawn_climbs(const mechanical::PhysicalModel& model) {
    std::vector<double> climbs{0.0};
    if (model.climb_m_per_s.low < 0.0) climbs.insert(climbs.begin(), 0.5 * model.climb_m_per_s.low);
    if (model.climb_m_per_s.high > 0.0) climbs.push_back(0.5 * model.climb_m_per_s.high);
    return climbs;
}

FigureData line_rows(const mechanical::PhysicalModel& model) {
    FigureData data({"airspeed_m_per_s", "power_w", "climb_m_per_s"}, {"line"});
    const auto& range = model.airspeed_m_per_s;
    for (const double climb : drawn_climbs(model)) {
        for (int i = 0; i < points_of_line; ++i) {
            const double airspeed = range.low + (range.high - range.low) * i / (points_of_line - 1);
            if (!(airspeed > 0.0)) continue;
            data.add({airspeed, power_w(model, {airspeed, climb}), climb}, {fmt::format("{:+.1f} m/s", climb)});
        }
    }
    return data;
}

}  // namespace

Figure model_figure(const mechanical::MechanicalModel& model, const flight::PerPhase<mechanical::CurveBand>& bands,
                    const PublishedFigures& published, const std::string& id) {
    auto drawn = VegaJson::array({"model"});
    const auto& cruise = bands[flight::Phase::cruise];
    if (!cruise.time_s.empty()) drawn.push_back("95 % band of the mean");
    if (!cruise.flights_low_w.empty()) drawn.push_back("envelope of the flights");
    if (!published.power[flight::Phase::cruise].time_s.empty()) drawn.push_back("published, Fig. 2");
    auto panels = VegaJson::array();
    for (const auto phase : flight::all_phases) {
        const auto& band = bands[phase];
        panels.push_back({{"phase", phase_word(phase)},
                          {"drawn", drawn},
                          {"envelope", area_rows(band.time_s, band.flights_low_w, band.flights_high_w)},
                          {"band", area_rows(band.time_s, band.low_95_w, band.high_95_w)},
                          {"model", model_rows(model.phases[phase])},
                          {"published", published_rows(published.power[phase])}});
    }
    return new_figure("model", id, model_caption(model, published),
                      fmt::format("Mechanical power model {} over each phase.", model.name), {{"panels", panels}});
}

Figure validation_figure(std::span<const mechanical::ValidatedFlight> flights, const std::string& id) {
    return new_figure("validation", id,
                      "Predicted less measured energy of the whole flight; the prediction is from its durations by the "
                      "other flights. A ring is a flight.",
                      fmt::format("Error of the predicted energy of {} flights by leave-one-out.", flights.size()),
                      {{"errors", error_rows(flights).json()}});
}

Figure physical_figure(const mechanical::PhysicalModel& model, std::span<const mechanical::BinnedFlight> flights,
                       const std::string& id) {
    return new_figure(
        "physical", id,
        "Power over airspeed. A ring is a bin of about 30 s of a flight; lines are the model in level flight, "
        "climb and descent. The colour is the climb rate.",
        fmt::format("Power over airspeed of {} bins of {} flights, and the model.", model.bins, model.flights.size()),
        {{"bins", bin_rows(flights).json()}, {"lines", line_rows(model).json()}});
}

namespace {

constexpr std::size_t battery_columns = 130;  // of a panel

/// A downsampled curve, broken where the record is not used.
void add_curve(FigureData& data, const battery::DischargeRecord& record, const std::vector<double>& voltage_v,
               std::string_view name) {
    for (const auto i : downsample_m4(record.time_s, voltage_v, battery_columns)) {
        data.add({record.time_s[i], record.used[i] ? voltage_v[i] : std::nan("")}, {name});
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
