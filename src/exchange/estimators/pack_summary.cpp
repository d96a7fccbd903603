#include "exchange/estimators/pack_summary.h"

#include "base/error.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace flightwatt::exchange {

PackSummary summarize_pack(const EstimatorInput& input, const std::string& reader) {
    if (!input.battery) {
        throw InputError({}, fmt::format("{} needs a battery, and none is given", reader),
                         "give a pack of `flightwatt battery`, or a mission");
    }
    constexpr double max_charged_cell_v = 4.25;
    constexpr double max_reserve_percent = 50.0;  // less charge does not determine a line
    PackSummary pack;
    pack.battery = settled(*input.battery);
    const double full_v = open_circuit_voltage_v(pack.battery, units::percent_per_whole);
    const auto min_cells = static_cast<int>(std::max(1.0, std::ceil(full_v / max_charged_cell_v)));
    pack.cells = input.cells_in_series.value_or(pack.battery.cells.value_or(min_cells));
    pack.capacity_mah = pack.battery.capacity_ah / units::milli;
    pack.energy_wh = full_energy_wh(pack.battery);
    if (input.reserve_percent) pack.lowest_percent = std::min(*input.reserve_percent, max_reserve_percent);
    return pack;
}

std::vector<flight::MonitorShare> noted_monitors(const EstimatorInput& input, ParameterText& result) {
    if (!input.battery || input.battery->monitors.empty()) return {{1, 1.0}};
    const auto& monitors = input.battery->monitors;
    auto note = describe_monitors(*input.battery);
    if (monitors.front().part == 0.0)
        note += ": values of charge are omitted; flights with the same packs show the parts";
    else if (monitors.size() > 1)
        note += ": each has values, and an action, of its own";
    result.text += fmt::format("# {}\n", note);
    result.notes.push_back(std::move(note));
    return monitors;
}

const mechanical::MechanicalModel& required_model(const EstimatorInput& input, const std::string& reader) {
    if (!input.model) {
        throw InputError({}, fmt::format("{} needs a mechanical model, and none is given", reader),
                         "give a model of `flightwatt fit` or `batch` with the battery, or a mission");
    }
    return *input.model;
}

double mean_power_w(const EstimatorInput& input, flight::Phase phase) {
    return mean_power_w(input.model.value().phases[phase]) + input.compute_w;
}

double cruise_current_a(const EstimatorInput& input, const PackSummary& pack) {
    return internal_current_a(pack.battery, mean_power_w(input, flight::Phase::cruise), {half_charged_percent, 0.0});
}

CurveFit fit_polynomial(const Interval& range, int points, int order, const std::function<double(double)>& curve) {
    Eigen::MatrixXd powers(points, order + 1);
    Eigen::VectorXd values(points);
    for (int i = 0; i < points; ++i) {
        const double x = std::lerp(range.low, range.high, i / (points - 1.0));
        for (int k = 0; k <= order; ++k) powers(i, k) = std::pow(x, k);
        values[i] = curve(x);
    }
    CurveFit fit{powers.colPivHouseholderQr().solve(values)};
    fit.max_error = (values - powers * fit.coefficients).cwiseAbs().maxCoeff();
    return fit;
}

VoltageLine fit_voltage_line(const battery::Battery& battery, double lowest_percent) {
    constexpr int charges = 91;
    constexpr double full_percent = units::percent_per_whole;
    const auto curve_v = [&](double soc_percent) { return open_circuit_voltage_v(battery, soc_percent); };
    const auto fit = fit_polynomial({lowest_percent, full_percent}, charges, 1, curve_v);
    const double empty_v = fit.coefficients[0];
    VoltageLine line{empty_v, empty_v + fit.coefficients[1] * full_percent, lowest_percent};
    // The curve is straight between knots: it deviates most at one of them, or where the fit ends.
    auto percents = battery.thevenin ? battery.thevenin->open_circuit.soc_percent : std::vector{0.0, full_percent};
    percents.push_back(lowest_percent);
    for (const double soc_percent : percents) {
        auto& error_v = soc_percent < lowest_percent ? line.error_below_v : line.error_v;
        error_v = std::max(
            error_v, std::abs(curve_v(soc_percent) - std::lerp(empty_v, line.full_v, soc_percent / full_percent)));
    }
    return line;
}

std::string power_limit(const EstimatorInput& input) {
    using enum flight::Phase;
    return fmt::format("power by phase: it is the cruise's {:.4g} W, not {:.4g} W in take-off and {:.4g} W in landing",
                       mean_power_w(input, cruise), mean_power_w(input, takeoff), mean_power_w(input, landing));
}

std::string voltage_limit(const VoltageLine& line) {
    return fmt::format(
        "the pack's open-circuit voltage: a line is up to {:.0f} mV off from 100 to {:g} %, and up to {:.0f} mV below",
        units::mv_from_v(line.error_v), line.lowest_percent, units::mv_from_v(line.error_below_v));
}

std::string note_limits(const std::vector<std::string>& limits, const std::string& prefix, ParameterText& result) {
    std::string text;
    for (const auto& limit : limits) {
        result.notes.push_back("not represented: " + limit);
        text += prefix + result.notes.back() + "\n";
    }
    return text;
}

}  // namespace flightwatt::exchange
