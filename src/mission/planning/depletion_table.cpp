#include "mission/planning/depletion_table.h"

#include "base/units.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <boost/math/quadrature/gauss.hpp>

namespace flightwatt::mission {
namespace {

constexpr double wanted_error_percent = 1e-8;
constexpr std::size_t min_cells = 16;
constexpr std::size_t first_cells_at_most = 4096;
constexpr std::size_t max_cells = 65536;

/// The load of one configuration in one phase.
struct PhaseLoad {
    const battery::Battery& battery;
    double cutoff_voltage_v;
    std::optional<mechanical::FourierModel> mechanical;
    double compute_w;

    bool is_deliverable(double time_s) const {
        const double demand_w = power_w(time_s);
        if (demand_w > power_limit_w(battery)) return false;
        return cutoff_voltage_v == 0.0 ||
               terminal_voltage_v(battery, {}, internal_current_a(battery, demand_w)) >= cutoff_voltage_v;
    }

    double power_w(double time_s) const {
        return (mechanical ? mechanical::power_w(*mechanical, time_s) : 0.0) + compute_w;
    }
    double energy_j(double time_s) const {
        return (mechanical ? mechanical::energy_j(*mechanical, time_s) : 0.0) + compute_w * time_s;
    }
    double percent_per_s(double time_s) const {
        const double current_a = internal_current_a(battery, std::min(power_w(time_s), power_limit_w(battery)));
        return units::percentage(current_a, units::coulomb_from_ah(battery.capacity_ah));
    }
    /// The depletion from one time to another.
    double percent(double start_s, double end_s) const {
        if (battery.resistance_ohm == 0.0) {
            const double charge_as = (energy_j(end_s) - energy_j(start_s)) / battery.voltage_v;
            return units::percentage(charge_as, units::coulomb_from_ah(battery.capacity_ah));
        }
        const auto rate = [&](double time_s) { return percent_per_s(time_s); };
        return boost::math::quadrature::gauss<double, 7>::integrate(rate, start_s, end_s);
    }
};

double at_cell(const PhaseDepletion& depletion, std::size_t cell, double part) {
    const auto& a = depletion.nodes[cell];
    const auto& b = depletion.nodes[cell + 1];
    // The cubic of Hermite, from the cell's start: only differences of the cumulative values matter.
    const double rise = b.depleted_percent - a.depleted_percent;
    const double slope_a = a.percent_per_s / depletion.cells_per_s;
    const double slope_b = b.percent_per_s / depletion.cells_per_s;
    return a.depleted_percent +
           part * (slope_a + part * (3.0 * rise - 2.0 * slope_a - slope_b + part * (slope_a + slope_b - 2.0 * rise)));
}

/// The last piece that starts at a time or before.
const PhaseDepletion::Piece& piece_at(const PhaseDepletion& depletion, double time_s) {
    const auto after = std::ranges::upper_bound(depletion.pieces, time_s, {}, &PhaseDepletion::Piece::start_s);
    return after == depletion.pieces.begin() ? *after : *(after - 1);
}

/// How many points the battery has lost since the phase began.
double depleted_percent(const PhaseDepletion& depletion, double time_s) {
    if (!depletion.pieces.empty()) {
        const auto& piece = piece_at(depletion, time_s);
        return piece.depleted_before_percent + depleted_percent(piece.depletion, time_s - piece.start_s);
    }
    const double position = std::clamp(time_s, 0.0, depletion.duration_s) * depletion.cells_per_s;
    const auto cell = std::min(static_cast<std::size_t>(position), depletion.nodes.size() - 2);
    const double part = position - static_cast<double>(cell);
    return part == 0.0 ? depletion.nodes[cell].depleted_percent : at_cell(depletion, cell, part);
}

/// The table of one load with so many cells.
PhaseDepletion tabulate(const PhaseLoad& load, double duration_s, std::size_t cells) {
    PhaseDepletion depletion;
    depletion.duration_s = duration_s;
    depletion.cells_per_s = static_cast<double>(cells) / duration_s;
    depletion.nodes.resize(cells + 1);
    depletion.undeliverable_cells.assign(cells + 1, 0);
    const auto time_s = [&](double k) { return k / depletion.cells_per_s; };
    depletion.nodes[0].percent_per_s = load.percent_per_s(0.0);
    double quadrature_error_percent = 0.0;
    for (std::size_t k = 0; k < cells; ++k) {
        const double start_s = time_s(static_cast<double>(k));
        const double middle_s = time_s(static_cast<double>(k) + 0.5);
        const double end_s = time_s(static_cast<double>(k) + 1.0);
        const double first = load.percent(start_s, middle_s);
        const double both = first + load.percent(middle_s, end_s);
        depletion.nodes[k + 1] = {depletion.nodes[k].depleted_percent + both, load.percent_per_s(end_s)};
        quadrature_error_percent += std::abs(both - load.percent(start_s, end_s));
        const double interpolated = at_cell(depletion, k, 0.5) - depletion.nodes[k].depleted_percent;
        depletion.error_percent = std::max(depletion.error_percent, std::abs(interpolated - first));
        const bool beyond =
            !load.is_deliverable(start_s) || !load.is_deliverable(middle_s) || !load.is_deliverable(end_s);
        depletion.undeliverable_cells[k + 1] = depletion.undeliverable_cells[k] + (beyond ? 1 : 0);
    }
    depletion.error_percent += quadrature_error_percent;
    depletion.deliverable = depletion.undeliverable_cells.back() == 0;
    return depletion;
}

/// The table with as many cells as the wanted error takes.
PhaseDepletion tabulate(const PhaseLoad& load, double duration_s) {
    auto cells = std::clamp(static_cast<std::size_t>(std::ceil(duration_s)), min_cells, first_cells_at_most);
    auto depletion = tabulate(load, duration_s, cells);
    while (depletion.error_percent > wanted_error_percent && cells < max_cells && depletion.deliverable) {
        cells *= 2;
        depletion = tabulate(load, duration_s, cells);
    }
    return depletion;
}

/// A table for each piece of a path.
PhaseDepletion tabulate(PhaseLoad load, const path::PiecewisePower& pieces) {
    PhaseDepletion depletion;
    depletion.duration_s = pieces.back().end_s;
    double depleted = 0.0;
    for (const auto& piece : pieces) {
        load.mechanical = mechanical::FourierModel{0.0, piece.power_w, {}, {}};
        auto of_piece = tabulate(load, piece.duration_s(), 1);  // of constant power: exact
        depletion.deliverable = depletion.deliverable && of_piece.deliverable;
        depletion.error_percent += of_piece.error_percent;
        const double before = depleted;
        depleted += of_piece.nodes.back().depleted_percent;
        depletion.pieces.push_back({piece.start_s, before, std::move(of_piece)});
    }
    return depletion;
}

bool charges(const PhaseDepletion& depletion) {
    return std::ranges::any_of(depletion.nodes, [](const auto& node) { return node.percent_per_s < 0.0; }) ||
           std::ranges::any_of(depletion.pieces, [](const auto& piece) { return charges(piece.depletion); });
}

bool is_undeliverable(const PhaseDepletion& depletion, double start_s, double end_s) {
    if (depletion.deliverable) return false;
    if (!depletion.pieces.empty()) {
        const double tolerance_s = same_time_tolerance_s(depletion.duration_s);
        return std::ranges::any_of(depletion.pieces, [&](const auto& piece) {
            const double piece_end_s = piece.start_s + piece.depletion.duration_s;
            return piece.start_s < end_s - tolerance_s && piece_end_s > start_s + tolerance_s &&
                   is_undeliverable(piece.depletion, start_s - piece.start_s,
                                    std::min(end_s - piece.start_s, piece.depletion.duration_s));
        });
    }
    const auto cells = depletion.nodes.size() - 1;
    // A segment that ends on a node does not touch the cell behind it.
    const double inside = same_time_tolerance_s(depletion.duration_s);
    const auto first = static_cast<std::size_t>(std::max(0.0, (start_s + inside) * depletion.cells_per_s));
    const auto last = static_cast<std::size_t>(std::max(0.0, (end_s - inside) * depletion.cells_per_s));
    return depletion.undeliverable_cells[std::min(last, cells - 1) + 1] !=
           depletion.undeliverable_cells[std::min(first, cells - 1)];
}

}  // namespace

DepletionTable make_depletion_table(const MissionSetup& mission, std::vector<compute::Configuration> configurations) {
    if (mission.battery.thevenin)
        throw std::invalid_argument("make_depletion_table: the source follows the charge, sums do not tell the end");
    DepletionTable table;
    table.initial_soc_percent = mission.initial_soc_percent;
    table.configurations = std::move(configurations);
    table.depletions.resize(table.configurations.size());
    const auto flown = make_mission_load(mission);
    for (const auto phase : all_phases) {
        if (mission.duration_s[phase] == 0.0) continue;
        for (std::size_t c = 0; c < table.configurations.size(); ++c) {
            const PhaseLoad load{mission.battery, mission.cutoff_voltage_v, flown.mechanical[phase],
                                 power_w(mission.compute, table.configurations[c])};
            auto& depletion = table.depletions[c][phase];
            depletion =
                flown.pieces[phase] ? tabulate(load, *flown.pieces[phase]) : tabulate(load, mission.duration_s[phase]);
            table.error_percent = std::max(table.error_percent, depletion.error_percent);
            table.charges = table.charges || charges(depletion);
        }
    }
    return table;
}

std::optional<std::size_t> index_of(const DepletionTable& table, const compute::Configuration& run) {
    const auto& known = table.configurations;
    const auto found = std::ranges::find(known, run);
    if (found == known.end()) return std::nullopt;
    return static_cast<std::size_t>(found - known.begin());
}

std::vector<IndexedSegment> to_indexed(const Schedule& schedule, const DepletionTable& table) {
    std::vector<IndexedSegment> result;
    result.reserve(schedule.size());
    for (const auto& segment : schedule) {
        const auto configuration = index_of(table, segment.run);
        if (!configuration) throw std::invalid_argument("tabled: a configuration that is not in the table");
        result.push_back({segment, *configuration});
    }
    return result;
}

double soc_depletion_percent(const DepletionTable& table, const IndexedSegment& segment) {
    const auto& depletion = table.depletions[segment.configuration][segment.phase];
    if (is_undeliverable(depletion, segment.start_s, segment.end_s)) return std::numeric_limits<double>::infinity();
    return depleted_percent(depletion, segment.end_s) - depleted_percent(depletion, segment.start_s);
}

std::optional<double> soc_after_schedule(const DepletionTable& table, std::span<const IndexedSegment> schedule) {
    if (table.charges) return std::nullopt;
    double soc_percent = table.initial_soc_percent;
    for (const auto& segment : schedule) soc_percent -= soc_depletion_percent(table, segment);
    if (!std::isfinite(soc_percent)) return std::nullopt;
    return soc_percent;
}

}  // namespace flightwatt::mission
