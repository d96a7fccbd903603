#pragma once

#include "battery/discharge.h"
#include "mission/planning/planner.h"
#include "mission/simulation.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace flightwatt::test {

/// A made-up mission of few slots that is yet to be planned.
struct SmallMission {
    mission::PlanningProblem problem;
    std::string kind;  ///< for people
};

/// Missions of four to nine slots with two or three components, on Thévenin batteries of all sorts: with and without
/// dwell times, cut-off voltages, fixed segments, reserves and a full pack.
class SmallMissionGenerator {
  public:
    explicit SmallMissionGenerator(unsigned seed) : random_(seed) {}

    /// One of 60 slots and a few, with a component of 16 levels.
    SmallMission make_long(bool dwells, bool may_be_cut_off) {
        SmallMission made;
        auto& problem = made.problem;
        problem.setup.name = "long";
        add_flight(problem);
        problem.setup.duration_s[Phase::cruise] = 600.0;
        add_component(problem, 16);
        problem.plan.slot_s = 10.0;
        if (dwells) problem.plan.dwell_s = 30.0;
        add_battery(problem);
        if (may_be_cut_off) problem.setup.cutoff_voltage_v = least_voltage_v(problem) - 0.05;
        made.kind =
            std::string("16 levels") + (dwells ? ", dwell of 3 slots" : "") + (may_be_cut_off ? ", cut-off" : "");
        return made;
    }

    SmallMission make() {
        SmallMission made;
        auto& problem = made.problem;
        problem.setup.name = "small";
        add_flight(problem);
        const auto components = whole(2, 3);
        for (std::size_t c = 0; c < components; ++c) add_component(problem, whole(2, 4));
        const double cruise_s = problem.setup.duration_s[Phase::cruise];
        problem.plan.slot_s = cruise_s / static_cast<double>(whole(2, 6)) * between(1.0, 1.2);
        if (maybe(0.4)) {
            const double start_s = cruise_s * between(0.1, 0.6);
            problem.fixed = {{Phase::cruise, start_s, start_s + cruise_s * between(0.1, 0.3), any_run(problem)}};
            made.kind += "fixed ";
        }
        if (maybe(0.5)) {
            problem.plan.dwell_s = problem.plan.slot_s * between(1.0, 3.0);
            made.kind += "dwell ";
        }
        add_battery(problem);
        if (maybe(0.5)) {
            problem.setup.cutoff_voltage_v =
                least_voltage_v(problem) - (maybe(0.5) ? between(0.0, 0.1) : between(0.0, 0.5));
            made.kind += "cut-off ";
        }
        made.kind += problem.setup.reserve_soc_percent > 0.0 ? "reserve" : "reserve 0";
        return made;
    }

  private:
    using Phase = flight::Phase;

    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    std::size_t whole(std::size_t low, std::size_t high) {
        return std::uniform_int_distribution<std::size_t>(low, high)(random_);
    }
    bool maybe(double probability) { return between(0.0, 1.0) < probability; }

    void add_flight(mission::PlanningProblem& problem) {
        const flight::PerPhase<double> mean_w{{between(35.0, 60.0), between(15.0, 30.0), between(6.0, 15.0)}};
        problem.setup.duration_s = {{between(15.0, 40.0), between(120.0, 900.0), between(20.0, 80.0)}};
        auto& model = problem.setup.mechanical.emplace();
        for (const auto phase : flight::all_phases) {
            auto& part = model.phases[phase];
            part.duration_s = problem.setup.duration_s[phase];
            part.fourier = {between(2.0, 8.0) / part.duration_s,
                            mean_w[phase],
                            {between(-2.0, 2.0), between(-1.0, 1.0)},
                            {between(-2.0, 2.0), between(-1.0, 1.0)}};
        }
    }

    void add_component(mission::PlanningProblem& problem, std::size_t count) {
        std::vector<double> levels;
        std::vector<compute::ProfileNode> nodes;
        double level = between(1.0, 5.0);
        double power_w = between(0.5, 3.0);
        for (std::size_t n = 0; n < count; ++n) {
            levels.push_back(level);
            nodes.push_back({{level}, power_w, {}});
            level += between(1.0, 10.0);
            power_w += between(0.3, 5.0) * 4.0 / static_cast<double>(std::max<std::size_t>(count, 4));
        }
        const auto name = std::string("component ") + std::to_string(problem.setup.compute.components.size());
        problem.setup.compute.components.push_back({name, compute::make_power_profile(name, {"q"}, nodes)});
        const auto shape = maybe(0.5) ? mission::UtilityShape::linear : mission::UtilityShape::square_root;
        problem.setup.utilities.push_back(mission::Utility{0, between(0.2, 1.0), shape, {}, {}});
        problem.plan.choices.push_back({{levels}, maybe(0.5)});
    }

    compute::Configuration any_run(const mission::PlanningProblem& problem) {
        compute::Configuration run;
        for (std::size_t c = 0; c < problem.plan.choices.size(); ++c) {
            const auto& levels = problem.plan.choices[c].levels.front();
            run.push_back({c, {levels[whole(0, levels.size() - 1)]}});
        }
        return run;
    }

    /// One that the least schedule takes a part of.
    void add_battery(mission::PlanningProblem& problem) {
        auto& battery = problem.setup.battery;
        battery.resistance_ohm = between(0.02, 0.12);
        battery::TheveninCircuit circuit;
        auto& [soc, voltage] = circuit.open_circuit;
        soc = {0.0, between(4.0, 12.0), between(20.0, 40.0), between(50.0, 80.0), 100.0};
        voltage = {between(9.0, 10.0)};
        for (const auto rise : {between(0.4, 1.2), between(0.05, 0.3), between(0.1, 0.4), between(0.3, 0.9)})
            voltage.push_back(voltage.back() + rise);
        circuit.rc_resistance_ohm = maybe(0.8) ? between(0.0, 0.1) : 0.0;
        circuit.rc_time_constant_s = between(5.0, 120.0);
        battery.thevenin = circuit;
        problem.setup.initial_soc_percent = maybe(0.5) ? 100.0 : between(60.0, 100.0);
        problem.setup.reserve_soc_percent = maybe(0.4) ? 0.0 : between(1.0, 30.0);
        battery.capacity_ah = 100.0;
        const double spent_percent =
            problem.setup.initial_soc_percent - *simulated_least(problem).summary.final_soc_percent;
        const double budget_percent = problem.setup.initial_soc_percent - problem.setup.reserve_soc_percent;
        battery.capacity_ah *= spent_percent / budget_percent / between(0.45, 0.95);
    }

    static mission::Simulation simulated_least(const mission::PlanningProblem& problem) {
        return simulate(with_minimum_energy_schedule(problem), {1.0, 1.0});
    }

    static double least_voltage_v(const mission::PlanningProblem& problem) {
        double min_v = std::numeric_limits<double>::infinity();
        for (const auto& row : simulated_least(problem).curve.rows) {
            if (row.current_a > 0.0) min_v = std::min(min_v, row.terminal_voltage_v);
        }
        return min_v;
    }

    std::mt19937 random_;
};

inline SmallMission small_mission(unsigned seed) { return SmallMissionGenerator(seed).make(); }

/// Every schedule of a mission of few slots, as the discharge of the battery has it. Left out is only what something
/// else that may continue in the same way has more charge, less RC voltage and more utility than.
class EverySchedule {
  public:
    EverySchedule(const mission::PlanningProblem& problem, const mission::PlanningTables& planner)
        : problem_(problem), slots_(mission::make_slots(problem)), load_(mission::make_mission_load(problem.setup)) {
        const auto& runs = planner.configurations;
        for (std::size_t c = 0; c < runs.size(); ++c) choices_.push_back({runs[c], planner.utility_per_s[c]});
        free_choices_ = planner.free_choices;
        fly_least();
    }

    /// The most utility a second of those that land with the reserve; none if none does. Only what has more than
    /// `known` is searched, if that is the utility of one that does.
    std::optional<double> max_utility(std::optional<double> known = std::nullopt) const {
        std::map<Run, std::vector<State>> now{{Run{}, {State{problem_.setup.initial_soc_percent, 0.0, 0.0}}}};
        double duration_s = 0.0;
        for (std::size_t i = 0; i < slots_.size(); ++i) {
            std::map<Run, std::vector<State>> next;
            for (const auto& [run, states] : now)
                for (std::size_t c = 0; c < choices_.size(); ++c)
                    if (const auto then = with(run, i, c)) carry(states, i, c, next[*then]);
            duration_s += slots_[i].duration_s();
            for (auto& [run, states] : next) {
                std::erase_if(states, [&](const State& state) {
                    if (state.soc_percent < needed_percent(i + 1)) return true;
                    return known && state.utility + most_from(i + 1) <= *known * whole_s() * (1.0 - 1e-9);
                });
                keep_undominated(states);
            }
            now = std::move(next);
        }
        std::optional<double> most = known;
        for (const auto& [run, states] : now) {
            if (!may_end(run, slots_.size())) continue;
            for (const auto& state : states)
                if (state.soc_percent >= problem_.setup.reserve_soc_percent)
                    most = std::max(most.value_or(-1.0), state.utility / duration_s);
        }
        return most;
    }

  private:
    struct Choice {
        compute::Configuration run;
        double utility_per_s = 0.0;
    };
    struct State {
        double soc_percent = 0.0;
        double rc_voltage_v = 0.0;
        double utility = 0.0;
    };
    /// What runs: since which slot, or for long enough.
    struct Run {
        std::size_t choice = std::numeric_limits<std::size_t>::max();
        std::size_t since = 0;
        bool is_done = true;
        auto operator<=>(const Run&) const = default;  // NOLINT(modernize-use-nullptr): there is no 0 to see
    };

    /// The charge over the slots if the least is drawn in each.
    void fly_least() {
        State state{problem_.setup.initial_soc_percent, 0.0, 0.0};
        for (std::size_t i = 0; i < slots_.size(); ++i) {
            least_percent_.push_back(state.soc_percent);
            std::size_t least = 0;  // the choices are in the order of their power
            for (std::size_t c = 0; c < choices_.size(); ++c)
                if (slots_[i].fixed && choices_[c].run == *slots_[i].fixed) least = c;
            std::vector<State> end;
            carry({state}, i, least, end);
            if (end.empty()) break;
            state = end.front();
        }
        least_percent_.resize(slots_.size(), 0.0);
        least_percent_.push_back(state.soc_percent);
    }

    /// What a battery of less charge has to have at least: it takes no less to the end than the one above.
    double needed_percent(std::size_t i) const {
        return problem_.setup.reserve_soc_percent + least_percent_[i] - least_percent_.back() - 1e-6;
    }

    double whole_s() const { return mission::timeline_of(problem_.setup.duration_s).duration_s; }

    /// The most utility that any choice has in the slots from `i` on.
    double most_from(std::size_t i) const {
        double sum = 0.0;
        for (; i < slots_.size(); ++i) {
            double most_per_s = 0.0;
            for (std::size_t c = 0; c < choices_.size(); ++c)
                if (slots_[i].fixed ? choices_[c].run == *slots_[i].fixed : c < free_choices_)
                    most_per_s = std::max(most_per_s, choices_[c].utility_per_s);
            sum += most_per_s * slots_[i].duration_s();
        }
        return sum;
    }

    /// Whether a run may be over as slot `i` begins: it has lasted, or it fills all between two fixed slots.
    bool may_end(const Run& run, std::size_t i) const {
        if (run.is_done) return true;
        const bool fills = (run.since == 0 || slots_[run.since - 1].fixed) && (i == slots_.size() || slots_[i].fixed);
        return fills;
    }

    std::optional<Run> with(const Run& run, std::size_t i, std::size_t choice) const {
        const auto& fixed = slots_[i].fixed;
        if (fixed ? choices_[choice].run != *fixed : choice >= free_choices_) return std::nullopt;
        Run then = run;
        if (choice != run.choice) {
            if (!may_end(run, i)) return std::nullopt;
            then = {choice, i, false};
        }
        double lasts_s = 0.0;
        for (auto k = then.since; k <= i; ++k) lasts_s += slots_[k].duration_s();
        if (fixed || lasts_s >= problem_.plan.dwell_s - 1e-6) then.is_done = true;
        if (then.is_done) then.since = 0;
        return then;
    }

    void carry(const std::vector<State>& states, std::size_t i, std::size_t choice, std::vector<State>& to) const {
        const auto segments = mission::load_segments(load_, {slots_[i], choices_[choice].run});  // several on a path
        for (const auto& state : states) {
            battery::Discharge end{{state.soc_percent, state.rc_voltage_v}};
            for (const auto& segment : segments) {
                const auto power_w = [&](double time_s) { return mission::power_w(segment, time_s); };
                end = battery::discharge(problem_.setup.battery, {power_w, segment.start_s, segment.end_s}, end,
                                         {2.0, problem_.setup.cutoff_voltage_v});
                if (end.ended_at_s() || end.undeliverable) break;
            }
            if (end.ended_at_s() || end.undeliverable) continue;
            to.push_back({end.soc_percent, end.rc_voltage_v,
                          state.utility + choices_[choice].utility_per_s * slots_[i].duration_s()});
        }
    }

    static void keep_undominated(std::vector<State>& states) {
        std::ranges::sort(states, [](const State& a, const State& b) {
            return std::tie(b.soc_percent, a.rc_voltage_v, b.utility) <
                   std::tie(a.soc_percent, b.rc_voltage_v, a.utility);
        });
        std::vector<State> kept;
        for (const auto& state : states) {
            const bool dominated = std::ranges::any_of(kept, [&](const State& other) {
                return other.rc_voltage_v <= state.rc_voltage_v && other.utility >= state.utility;
            });
            if (!dominated) kept.push_back(state);
        }
        states = std::move(kept);
    }

    const mission::PlanningProblem& problem_;
    std::vector<mission::MissionSlot> slots_;
    mission::MissionLoad load_;
    std::vector<Choice> choices_;
    std::size_t free_choices_ = 0;
    std::vector<double> least_percent_;
};

}  // namespace flightwatt::test
