#pragma once

#include "mission/planning/planner.h"
#include "mission/sampling/landing_distribution.h"
#include "mission/simulation.h"

#include <random>
#include <string>

namespace flightwatt::test {

/// A made-up mission that is yet to be planned, and the probability that its reserve is to be kept with.
struct GeneratedMission {
    mission::PlanningProblem problem;
    double probability = 0.95;
    std::string kind;  ///< for people
};

/// Missions of both battery kinds, of few and many flights, with and without fixed segments, stated durations and
/// spreads, cut-off voltages: whatever [uncertainty] and the models may state. Planned, they spend what they have.
class MissionGenerator {
  public:
    explicit MissionGenerator(unsigned seed) : random_(seed), thevenin_(seed % 2 == 0) {}

    /// Without a reserve the capacity follows from one simulation, which is much quicker.
    GeneratedMission make(bool with_reserve = true) {
        GeneratedMission made;
        auto& problem = made.problem;
        problem.setup.name = "generated";
        add_flight(problem);
        add_software(problem);
        add_battery(problem);
        problem.plan.slot_s = pick({5.0, 10.0, 20.0});
        if (maybe(0.5)) {
            problem.fixed = {{Phase::cruise, 60.0, 120.0, {{0, {fps_.back()}}}}};
        }
        made.probability = pick({0.8, 0.9, 0.95, 0.98});
        size_battery(problem);
        if (with_reserve) choose_reserve(made);
        made.kind = kind_ + (problem.setup.battery.thevenin               ? "thevenin"
                             : problem.setup.battery.resistance_ohm > 0.0 ? "resistance"
                                                                          : "ideal");
        return made;
    }

  private:
    using Phase = flight::Phase;

    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    bool maybe(double probability) { return between(0.0, 1.0) < probability; }
    double pick(const std::vector<double>& values) {
        return values[std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(random_)];
    }

    void add_flight(mission::PlanningProblem& problem) {
        const flight::PerPhase<double> mean_w{{between(30.0, 50.0), between(15.0, 30.0), between(6.0, 15.0)}};
        const flight::PerPhase<double> lasts_s{{between(20.0, 40.0), between(400.0, 1200.0), between(30.0, 80.0)}};
        const bool of_flights = maybe(0.5);
        const auto flights = static_cast<std::size_t>(between(2.0, 9.0));
        auto& model = problem.setup.mechanical.emplace();
        if (of_flights) model.flights.resize(flights);
        for (const auto phase : flight::all_phases) {
            auto& part = model.phases[phase];
            part.fourier = {
                between(2.0, 8.0) / lasts_s[phase], mean_w[phase], {between(-2.0, 2.0)}, {between(-2.0, 2.0)}};
            part.duration_s = lasts_s[phase];
            problem.setup.duration_s[phase] = lasts_s[phase];
            if (of_flights) {
                part.flights = flights;
                part.level_spread =
                    mechanical::VarianceComponents{flights, between(0.02, 0.12) * mean_w[phase], 0.1, 20.0};
                for (auto& flight : model.flights) {
                    const double flown_s = lasts_s[phase] * between(0.85, 1.15);
                    flight.phases[phase] =
                        mechanical::PhaseContribution{1.0 / static_cast<double>(flights), flown_s, 1.0, 100};
                }
            } else {
                problem.setup.uncertainty.level_sd_percent[phase] = between(1.0, 12.0);
            }
        }
        if (maybe(0.5)) {
            problem.setup.duration_s[Phase::cruise] *= between(0.7, 1.3);
            problem.setup.duration_is_stated[Phase::cruise] = true;
        }
        if (maybe(0.4)) problem.setup.uncertainty.duration_sd_s[Phase::cruise] = between(5.0, 60.0);
        if (maybe(0.3)) problem.setup.phase_clock = mechanical::PhaseTimeScaling::absolute;
        kind_ = of_flights ? "model's flights, " : "stated, ";
    }

    void add_software(mission::PlanningProblem& problem) {
        std::vector<compute::ProfileNode> nodes;
        const double idle_w = between(1.0, 4.0);
        const double per_fps_w = between(0.2, 0.6);
        const bool has_errors = maybe(0.5);
        for (const double value : fps_) {
            compute::ProfileNode node{{value}, idle_w + per_fps_w * value, {}};
            if (has_errors) node.standard_error_w = between(0.05, 0.5);
            nodes.push_back(node);
        }
        problem.setup.compute.components.push_back({"detection", compute::make_power_profile("p", {"fps"}, nodes)});
        problem.setup.utilities.push_back(mission::Utility{0, 1.0, mission::UtilityShape::square_root, {}, {}});
        problem.plan.choices.push_back({{fps_}, false});
        problem.setup.uncertainty.compute_sd_percent.resize(1);
        if (maybe(0.4)) problem.setup.uncertainty.compute_sd_percent[0] = between(1.0, 8.0);
    }

    void add_battery(mission::PlanningProblem& problem) {
        auto& battery = problem.setup.battery;
        battery.capacity_ah = 30.0;
        battery.resistance_ohm = maybe(0.7) ? between(0.02, 0.09) : 0.0;
        if (thevenin_) {
            battery::TheveninCircuit circuit;
            circuit.open_circuit = {{0.0, 10.0, 30.0, 60.0, 100.0}, {9.9, 11.0, 11.3, 11.6, 12.5}};
            circuit.rc_resistance_ohm = between(0.005, 0.04);
            circuit.rc_time_constant_s = between(5.0, 90.0);
            battery.thevenin = circuit;
            if (maybe(0.5)) battery.intervals.open_circuit_standard_error_v.assign(5, between(0.02, 0.1));
            if (maybe(0.5)) {
                battery.intervals.rc_resistance_ohm = Interval{0.0, 2.0 * circuit.rc_resistance_ohm};
                battery.intervals.rc_time_constant_s =
                    Interval{circuit.rc_time_constant_s / 3.0, circuit.rc_time_constant_s * 4.0};
            }
        } else {
            battery.voltage_v = 11.1;
            if (maybe(0.5)) battery.intervals.voltage_v = Interval{10.9, 11.4};
        }
        if (battery.resistance_ohm > 0.0 && maybe(0.5))
            battery.intervals.resistance_ohm = Interval{battery.resistance_ohm * 0.7, battery.resistance_ohm * 1.4};
        if (maybe(0.5)) problem.setup.uncertainty.capacity_sd_percent = between(1.0, 5.0);
        if (thevenin_ && maybe(0.3)) problem.setup.cutoff_voltage_v = between(9.5, 10.2);
        problem.setup.initial_soc_percent = maybe(0.3) ? between(90.0, 100.0) : 100.0;
    }

    /// So that the mission's mean flight with the least computing uses a part of the charge.
    void size_battery(mission::PlanningProblem& problem) {
        const auto used_percent = 100.0 - *simulate(with_minimum_energy_schedule(problem)).summary.final_soc_percent;
        problem.setup.battery.capacity_ah /= between(60.0, 85.0) / used_percent;
    }

    /// So that there is charge for a part of what the software may do.
    void choose_reserve(GeneratedMission& made) {
        auto& problem = made.problem;
        auto flown = with_minimum_energy_schedule(problem);
        const auto left_percent = [&] {
            return draw_landings(flown, collect_uncertainty(flown.setup)).quantile_percent(made.probability);
        };
        double least_percent = left_percent();
        while (least_percent < 10.0) {  // too many fail
            flown.setup.battery.capacity_ah = problem.setup.battery.capacity_ah *= 1.2;
            least_percent = left_percent();
        }
        for (auto& segment : flown.schedule) segment.run.front().qos = {fps_.back()};
        const double max_percent = std::max(left_percent(), 0.0);
        problem.setup.reserve_soc_percent = max_percent + between(0.3, 0.7) * (least_percent - max_percent);
    }

    const std::vector<double> fps_{5.0, 10.0, 16.0, 25.0, 32.0};
    std::mt19937 random_;
    bool thevenin_;
    std::string kind_;
};

inline GeneratedMission generated_mission(unsigned seed, bool with_reserve = true) {
    return MissionGenerator(seed).make(with_reserve);
}

}  // namespace flightwatt::test
