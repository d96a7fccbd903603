#include "mission/planning/depletion_table.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <boost/math/quadrature/gauss.hpp>

namespace flightwatt::mission {
namespace {

constexpr double wanted_error_percent = 1e-8;
constexpr double wanted_error_along_source_percent = 1e-6;  // straight lines between the course's points
constexpr std::size_t fewest_cells = 16;
constexpr std::size_t first_cells_at_most = 4096;
constexpr std::size_t most_cells = 65536;

/// The load of one configuration in one phase.
struct PhaseLoad {
    battery::Battery battery;     ///< the paper's
    const SourceVoltage* source;  ///< none: the battery's own
    double cutoff_voltage_v;
    double phase_begins_s;
    const std::optional<mechanical::FourierModel>& mechanical;
    double compute_w;

    /// Its RC voltage takes the battery's constant source to where the course is.
    battery::BatteryState state(double time_s) const {
        if (!source) return {};
        return {100.0, battery.voltage_v - voltage_v(*source, phase_begins_s + time_s)};
    }
    bool is_deliverable(double time_s) const {
        const auto now = state(time_s);
        const double demand_w = power_w(time_s);
        if (demand_w > power_limit_w(battery, now)) return false;
        return cutoff_voltage_v == 0.0 ||
               terminal_voltage_v(battery, now, internal_current_a(battery, demand_w, now)) >=
                   cutoff_voltage_v;
    }

    double power_w(double time_s) const {
        return (mechanical ? mechanical::power_w(*mechanical, time_s) : 0.0) + compute_w;
    }
    double energy_j(double time_s) const {
        return (mechanical ? mechanical::energy_j(*mechanical, time_s) : 0.0) + compute_w * time_s;
    }
    double percent_per_s(double time_s) const {
        const auto now = state(time_s);
        const double current_a =
            internal_current_a(battery, std::min(power_w(time_s), power_limit_w(battery, now)), now);
        return units::percent_of(current_a, units::coulomb_from_ah(battery.capacity_ah));
    }
    /// The drain from one time to another.
    double percent(double from_s, double to_s) const {
        if (battery.resistance_ohm == 0.0 && !source) {
            const double charge_as = (energy_j(to_s) - energy_j(from_s)) / battery.voltage_v;
            return units::percent_of(charge_as, units::coulomb_from_ah(battery.capacity_ah));
        }
        const auto rate = [&](double time_s) { return percent_per_s(time_s); };
        return boost::math::quadrature::gauss<double, 7>::integrate(rate, from_s, to_s);
    }
};

double at_cell(const PhaseDrain& drain, std::size_t cell, double part) {
    const auto& a = drain.nodes[cell];
    const auto& b = drain.nodes[cell + 1];
    // The cubic of Hermite, from the cell's begin: only differences of the cumulative values matter.
    const double rise = b.drained_percent - a.drained_percent;
    const double slope_a = a.percent_per_s / drain.cells_per_s;
    const double slope_b = b.percent_per_s / drain.cells_per_s;
    return a.drained_percent + part * (slope_a + part * (3.0 * rise - 2.0 * slope_a - slope_b +
                                                         part * (slope_a + slope_b - 2.0 * rise)));
}

/// How many points the battery has drained since the phase began.
double drained_percent(const PhaseDrain& drain, double time_s) {
    const double position = std::clamp(time_s, 0.0, drain.duration_s) * drain.cells_per_s;
    const auto cell = std::min(static_cast<std::size_t>(position), drain.nodes.size() - 2);
    const double part = position - static_cast<double>(cell);
    return part == 0.0 ? drain.nodes[cell].drained_percent : at_cell(drain, cell, part);
}

/// The table of one load with so many cells. `error_percent` becomes what the values halfway tell.
PhaseDrain tabulate(const PhaseLoad& load, double duration_s, std::size_t cells, double& error_percent) {
    PhaseDrain drain;
    drain.duration_s = duration_s;
    drain.cells_per_s = static_cast<double>(cells) / duration_s;
    drain.nodes.resize(cells + 1);
    drain.undeliverable_cells.assign(cells + 1, 0);
    const auto time_s = [&](double k) { return k / drain.cells_per_s; };
    drain.nodes[0].percent_per_s = load.percent_per_s(0.0);
    error_percent = 0.0;
    double quadrature_error_percent = 0.0;
    for (std::size_t k = 0; k < cells; ++k) {
        const double begin_s = time_s(static_cast<double>(k));
        const double middle_s = time_s(static_cast<double>(k) + 0.5);
        const double end_s = time_s(static_cast<double>(k) + 1.0);
        const double first = load.percent(begin_s, middle_s);
        const double both = first + load.percent(middle_s, end_s);
        drain.nodes[k + 1] = {drain.nodes[k].drained_percent + both, load.percent_per_s(end_s)};
        quadrature_error_percent += std::abs(both - load.percent(begin_s, end_s));
        const double interpolated = at_cell(drain, k, 0.5) - drain.nodes[k].drained_percent;
        error_percent = std::max(error_percent, std::abs(interpolated - first));
        const bool beyond =
            !load.is_deliverable(begin_s) || !load.is_deliverable(middle_s) || !load.is_deliverable(end_s);
        drain.undeliverable_cells[k + 1] = drain.undeliverable_cells[k] + (beyond ? 1 : 0);
    }
    error_percent += quadrature_error_percent;
    drain.deliverable = drain.undeliverable_cells.back() == 0;
    return drain;
}

PhaseDrain tabulate(const PhaseLoad& load, double duration_s, double& error_percent) {
    auto cells =
        std::clamp(static_cast<std::size_t>(std::ceil(duration_s)), fewest_cells, first_cells_at_most);
    auto drain = tabulate(load, duration_s, cells, error_percent);
    const double wanted_percent = load.source ? wanted_error_along_source_percent : wanted_error_percent;
    while (error_percent > wanted_percent && cells < most_cells && drain.deliverable) {
        cells *= 2;
        drain = tabulate(load, duration_s, cells, error_percent);
    }
    return drain;
}

bool is_undeliverable(const PhaseDrain& drain, double from_s, double to_s) {
    if (drain.deliverable) return false;
    const auto cells = drain.nodes.size() - 1;
    // A stretch that ends on a node does not touch the cell behind it.
    const double inside = same_time_tolerance_s(drain.duration_s);
    const auto first = static_cast<std::size_t>(std::max(0.0, (from_s + inside) * drain.cells_per_s));
    const auto last = static_cast<std::size_t>(std::max(0.0, (to_s - inside) * drain.cells_per_s));
    return drain.undeliverable_cells[std::min(last, cells - 1) + 1] !=
           drain.undeliverable_cells[std::min(first, cells - 1)];
}

/// The paper's battery with the source that the mission's has at the beginning.
battery::Battery with_constant_source(const Mission& mission) {
    auto battery = mission.battery;
    battery.voltage_v = open_circuit_voltage_v(battery, mission.initial_soc_percent);
    battery.thevenin.reset();
    return battery;
}

DrainTable tabulate_all(const Mission& mission, std::vector<compute::Configuration> configurations,
                        const SourceVoltage* source) {
    DrainTable table;
    table.initial_soc_percent = mission.initial_soc_percent;
    table.depends_on_state = mission.battery.thevenin.has_value();
    table.configurations = std::move(configurations);
    table.drains.resize(table.configurations.size());
    const auto battery = with_constant_source(mission);
    double phase_begins_s = 0.0;
    for (const auto phase : flight::all_phases) {
        const double duration_s = mission.duration_s[phase];
        if (duration_s == 0.0) continue;
        std::optional<mechanical::FourierModel> mechanical;
        if (mission.mechanical) {
            mechanical = flown_model(mission.mechanical->phases[phase], duration_s, mission.phase_clock);
        }
        for (std::size_t c = 0; c < table.configurations.size(); ++c) {
            const PhaseLoad load{
                battery,        source,     mission.cutoff_voltage_v,
                phase_begins_s, mechanical, power_w(mission.compute, table.configurations[c])};
            double error_percent = 0.0;
            auto& drain = table.drains[c][phase];
            drain = tabulate(load, duration_s, error_percent);
            table.error_percent = std::max(table.error_percent, error_percent);
            table.charges =
                table.charges || std::any_of(drain.nodes.begin(), drain.nodes.end(),
                                             [](const auto& node) { return node.percent_per_s < 0.0; });
        }
        phase_begins_s += duration_s;
    }
    return table;
}

}  // namespace

DrainTable make_drain_table(const Mission& mission, std::vector<compute::Configuration> configurations) {
    return tabulate_all(mission, std::move(configurations), nullptr);
}

DrainTable make_drain_table(const Mission& mission, std::vector<compute::Configuration> configurations,
                            const SourceVoltage& source) {
    return tabulate_all(mission, std::move(configurations), &source);
}

std::vector<compute::Configuration> configurations_of(const std::vector<Stretch>& schedule) {
    std::vector<compute::Configuration> found;
    for (const auto& stretch : schedule) {
        if (std::find(found.begin(), found.end(), stretch.run) == found.end()) found.push_back(stretch.run);
    }
    return found;
}

std::vector<TabledStretch> tabled(const std::vector<Stretch>& schedule, const DrainTable& table) {
    std::vector<TabledStretch> result;
    result.reserve(schedule.size());
    for (const auto& stretch : schedule) {
        const auto& known = table.configurations;
        const auto found = std::find(known.begin(), known.end(), stretch.run);
        if (found == known.end())
            throw std::invalid_argument("tabled: a configuration that is not in the table");
        result.push_back(
            {static_cast<std::size_t>(found - known.begin()), stretch.phase, stretch.from_s, stretch.to_s});
    }
    return result;
}

double drain_percent(const DrainTable& table, const TabledStretch& stretch) {
    const auto& drain = table.drains[stretch.configuration][stretch.phase];
    if (is_undeliverable(drain, stretch.from_s, stretch.to_s)) return std::numeric_limits<double>::infinity();
    return drained_percent(drain, stretch.to_s) - drained_percent(drain, stretch.from_s);
}

std::optional<double> soc_after(const DrainTable& table, std::span<const TabledStretch> schedule) {
    if (table.charges || table.depends_on_state) return std::nullopt;
    double soc_percent = table.initial_soc_percent;
    for (const auto& stretch : schedule) soc_percent -= drain_percent(table, stretch);
    if (!std::isfinite(soc_percent)) return std::nullopt;
    return soc_percent;
}

SlotDrains make_slot_drains(const DrainTable& table, std::span<const TabledStretch> slots) {
    SlotDrains drains;
    drains.slots = slots.size();
    drains.choices = table.configurations.size();
    drains.initial_soc_percent = table.initial_soc_percent;
    drains.percent.reserve(drains.slots * drains.choices);
    for (auto slot : slots) {
        for (slot.configuration = 0; slot.configuration < drains.choices; ++slot.configuration) {
            drains.percent.push_back(drain_percent(table, slot));
        }
    }
    return drains;
}

double soc_after(const SlotDrains& drains, std::span<const std::uint16_t> choices) {
    if (choices.size() != drains.slots)
        throw std::invalid_argument("soc_after: as many choices as slots are due");
    double drained_percent = 0.0;
    const double* of_slot = drains.percent.data();
    for (const auto choice : choices) {
        drained_percent += of_slot[choice];
        of_slot += drains.choices;
    }
    return drains.initial_soc_percent - drained_percent;
}

}  // namespace flightwatt::mission
