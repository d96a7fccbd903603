#include "mission/sampling/lane_schedule.h"

#include "base/units.h"
#include "battery/fast_discharge.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/math/quadrature/gauss.hpp>

namespace flightwatt::mission {
namespace {

constexpr double edge_fraction = 1e-12;
constexpr double fine_enough = 1.5;  ///< how much longer than planned a step may be in some flight

/// The power of each configuration as a sum over nodes: it is linear in them.
std::vector<NodeWeight> node_weights(compute::ComputeModel model, const compute::Configuration& configuration) {
    for (auto& component : model.components) std::ranges::fill(component.profile.power_w, 0.0);
    std::vector<NodeWeight> weights;
    for (const auto& running : configuration) {
        auto& power_w = model.components.at(running.component).profile.power_w;
        for (std::size_t node = 0; node < power_w.size(); ++node) {
            power_w[node] = 1.0;
            const double weight = compute::power_w(model.components[running.component].profile, running.qos);
            power_w[node] = 0.0;
            if (weight != 0.0) weights.push_back({running.component, node, weight});
        }
    }
    return weights;
}

/// Where a time of the mission as planned lies: in a stretch that starts there, or is cut so that one does.
void note_at(double time_s, const PerPhase<double>& planned_s, std::vector<LaneSegment>& stretches) {
    double in_phase_s = time_s;
    for (auto it = stretches.begin(); it != stretches.end(); ++it) {
        const double phase_s = planned_s[it->phase];
        const double part = in_phase_s / phase_s;
        if (part < it->to_part - edge_fraction) {
            if (part > it->from_part + edge_fraction) {
                auto before = *it;
                before.to_part = it->from_part = part;
                it->outputs_at_start = 0;
                it = std::next(stretches.insert(it, before));
            }
            ++it->outputs_at_start;
            return;
        }
        if (std::next(it) != stretches.end() && std::next(it)->phase != it->phase) in_phase_s -= phase_s;
    }
}

/// How often the fastest harmonic of a stretch turns.
double turns_of(const LoadSegment& segment) {
    if (!segment.mechanical) return 0.0;
    return static_cast<double>(segment.mechanical->cos_w.size()) * segment.mechanical->omega_rad_per_s *
           (segment.end_s - segment.start_s) / units::rad_per_turn;
}

/// The nodes of a constant source, whose current is integrated over time by Gauss quadrature.
void set_quadrature(double turns, LaneSegment& stretch) {
    using Gauss = boost::math::quadrature::gauss<double, 7>;
    constexpr double pieces_a_turn = 4.0;  // exact to rounding
    constexpr double max_pieces = 1e4;
    const auto pieces = static_cast<int>(std::min(1.0 + std::floor(turns * pieces_a_turn), max_pieces));
    const double half = 0.5 / pieces;
    for (int piece = 0; piece < pieces; ++piece) {
        const double middle = (2 * piece + 1) * half;
        for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
            const double beside = Gauss::abscissa()[i];
            for (const double side : {-1.0, 1.0}) {
                if (beside == 0.0 && side > 0.0) continue;
                stretch.nodes.push_back(middle + side * half * beside);
                stretch.weights.push_back(half * Gauss::weights()[i]);
            }
        }
    }
}

void set_steps(double max_s, double length_s, LaneSegment& stretch) {
    stretch.steps = static_cast<std::size_t>(std::max(1.0, std::ceil(length_s / max_s * (1.0 - 1e-12))));
    for (std::size_t k = 0; k <= 2 * stretch.steps; ++k)
        stretch.nodes.push_back(static_cast<double>(k) / static_cast<double>(2 * stretch.steps));
}

/// The RC pair where it is felt, with the shortest time constant that is probable; else none.
battery::TheveninCircuit max_circuit(const battery::Battery& battery, const battery::BatteryIntervals& intervals,
                                     double high_w) {
    constexpr double felt_v = 1e-3;
    auto circuit = *battery.thevenin;
    const double ohm = intervals.rc_resistance_ohm ? intervals.rc_resistance_ohm->high : circuit.rc_resistance_ohm;
    if (ohm * high_w / circuit.open_circuit.voltage_v.front() < felt_v) circuit.rc_resistance_ohm = 0.0;
    if (intervals.rc_time_constant_s) circuit.rc_time_constant_s = intervals.rc_time_constant_s->low;
    return circuit;
}

void set_turned(const MissionSetup& setup, LaneSegment& stretch) {
    if (!setup.mechanical || setup.phase_clock != mechanical::PhaseTimeScaling::stretched) return;
    const auto& model = setup.mechanical->phases[stretch.phase];
    const double turn_rad = model.fourier.omega_rad_per_s * model.duration_s;
    for (const double node : stretch.nodes) {
        const double angle_rad = turn_rad * std::lerp(stretch.from_part, stretch.to_part, node);
        auto& turned = stretch.harmonics.emplace_back();
        for (std::size_t n = 1; n <= model.fourier.cos_w.size(); ++n) {
            turned.push_back(std::cos(static_cast<double>(n) * angle_rad));
            turned.push_back(std::sin(static_cast<double>(n) * angle_rad));
        }
    }
}

}  // namespace

LaneSchedule lane_schedule(const MissionSetup& setup, const FlightUncertainty& spreads, const Schedule& schedule,
                           const std::vector<double>& times_s) {
    LaneSchedule lanes;
    const auto runs = configurations_of(schedule);
    for (const auto& run : runs) lanes.configurations.push_back(node_weights(setup.compute, run));
    for (const auto& segment : schedule) {
        const double planned_s = setup.duration_s[segment.phase];
        if (!(segment.duration_s() > 0.0)) continue;
        LaneSegment stretch;
        stretch.phase = segment.phase;
        stretch.from_part = segment.start_s / planned_s;
        stretch.to_part = segment.end_s == planned_s ? 1.0 : segment.end_s / planned_s;
        stretch.configuration = static_cast<std::size_t>(std::ranges::find(runs, segment.run) - runs.begin());
        lanes.stretches.push_back(stretch);
    }
    for (const double time_s : times_s) note_at(time_s, setup.duration_s, lanes.stretches);
    const auto load = make_mission_load(setup);
    for (auto& stretch : lanes.stretches) {
        const double planned_s = setup.duration_s[stretch.phase];
        const auto segment =
            load_segments(load, {{stretch.phase, stretch.from_part * planned_s, stretch.to_part * planned_s},
                                 runs[stretch.configuration]})
                .front();
        const double length_s = segment.end_s - segment.start_s;
        const bool is_stretched = setup.phase_clock == mechanical::PhaseTimeScaling::stretched;
        stretch.max_s = std::numeric_limits<double>::infinity();
        if (!setup.battery.thevenin) {
            set_quadrature(turns_of(segment), stretch);
            if (!is_stretched) stretch.max_s = fine_enough * planned_s;
        } else {
            const auto circuit = max_circuit(setup.battery, spreads.battery, bounds_of(segment).high);
            const double max_s = battery::max_fast_step_s(circuit, quick_step_s(segment));
            set_steps(max_s, length_s, stretch);
            stretch.max_s = fine_enough * planned_s * static_cast<double>(stretch.steps) * max_s / length_s;
        }
        set_turned(setup, stretch);
    }
    return lanes;
}

}  // namespace flightwatt::mission
