#include "exchange/parameters/pack_facts.h"

#include "base/error.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::exchange {
namespace {

constexpr double full_soc_percent = 100.0;
constexpr double max_charged_cell_v = 4.25;

}  // namespace

PackSummary summarize_pack(const EstimatorInput& input, const std::string& reader) {
    if (!input.battery) {
        throw InputError({}, fmt::format("{} needs a battery, and none is given", reader),
                         "give a pack of `flightwatt battery`, or a mission");
    }
    PackSummary facts;
    facts.battery = *input.battery;
    if (facts.battery.thevenin) {
        facts.battery.resistance_ohm += facts.battery.thevenin->rc_resistance_ohm;
        facts.battery.thevenin->rc_resistance_ohm = 0.0;
    }
    const double full_v = open_circuit_voltage_v(facts.battery, full_soc_percent);
    const auto fewest = static_cast<int>(std::max(1.0, std::ceil(full_v / max_charged_cell_v)));
    facts.cells = input.cells_in_series.value_or(facts.battery.cells.value_or(fewest));
    facts.capacity_mah = facts.battery.capacity_ah / units::milli;
    facts.energy_wh = full_energy_wh(facts.battery);
    return facts;
}

const mechanical::MechanicalModel& required_model(const EstimatorInput& input, const std::string& reader) {
    if (!input.model) {
        throw InputError({}, fmt::format("{} needs a mechanical model, and none is given", reader),
                         "give a model of `flightwatt fit` or `batch` beside the battery, or a mission");
    }
    return *input.model;
}

double mean_power_w(const EstimatorInput& input, flight::Phase phase) {
    const auto& curve = input.model.value().phases[phase];
    return energy_j(curve.fourier, curve.duration_s) / curve.duration_s + input.compute_w;
}

}  // namespace flightwatt::exchange
