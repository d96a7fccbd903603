#pragma once

#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/fit/flight_weights.h"
#include "mechanical/model_fit.h"
#include "mechanical/prediction.h"
#include "mission/plan.h"
#include "mission/sampling/landing_distribution.h"
#include "mission/simulation.h"

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace flightwatt::test {

/// How predictions from few flights are tried.
struct PromiseTrial {
    std::size_t flights = 3;    ///< that the model is made of
    bool by_fit = false;        ///< the model is fitted to samples of power; else made of the flights' own curves
    bool by_plan = false;       ///< plan_mission keeps a reserve; else draw_landings finds one for a schedule
    bool as_if_known = false;   ///< the spread of few flights as if it were that of all, phases independent
    double probability = 0.95;  ///< that is planned
    std::size_t new_flights = 200;
};

/// Quantities whose 95 % intervals a fitted model gives, in the order of IntervalShares.
inline constexpr std::array<const char*, 8> interval_quantities{
    "mean take-off", "mean cruise", "mean landing", "Wh take-off", "Wh cruise", "Wh landing", "Wh total", "SoC"};

/// Of each quantity, the share of the flights to come (of means: 0 or 1) whose truth is in the interval.
using IntervalShares = std::array<double, interval_quantities.size()>;

/// An aircraft that no one knows: three phases whose levels, and in half of the seeds durations, differ between flights
/// by normal deviations, the phases' more or less together; its flights, models of them, and what flights to come make
/// of the models' predictions. Batteries are ideal, with a resistance, and Thevenin circuits.
class UnknownAircraft {
  public:
    explicit UnknownAircraft(unsigned seed, bool is_even = false) : random_(seed), kind_(seed % 3) {
        const double widest = is_even ? 0.03 : 0.08;  // even: so that a plan has room for what two flights ask
        together_ = between(0.0, 0.9);
        const bool durations_differ = seed / 3 % 2 == 1;
        for (const auto phase : flight::all_phases) {
            level_sd_w_[phase] = between(widest / 4.0, widest) * mean_w_[phase];
            if (durations_differ) duration_sd_s_[phase] = between(0.0, widest / 2.0) * lasts_s_[phase];
        }
        durations_are_stated_ = !durations_differ;
    }

    /// The share of flights to come that keep what was planned from flights so far; none without a plan.
    std::optional<double> kept_share(const PromiseTrial& trial) {
        auto problem = problem_of(trial.by_fit ? fitted_model(trial.flights) : model(trial.flights));
        mission::Mission planned;
        double least_percent = 0.0;
        if (trial.by_plan) {
            problem.setup.reserve_soc_percent = least_percent = reserve_percent();
            auto plan = plan_mission(problem, trial.probability);
            if (!plan.plan.feasible) return std::nullopt;
            planned = plan.mission;
        } else {
            planned = with_highest_quality(problem);
            auto spreads = collect_uncertainty(planned.setup);
            if (trial.as_if_known) spreads.joint.clear();
            least_percent = draw_landings(planned, spreads).quantile_percent(trial.probability);
        }
        std::size_t kept = 0;
        for (std::size_t i = 0; i < trial.new_flights; ++i)
            if (land(planned, fly()).remaining_percent >= least_percent) ++kept;
        return static_cast<double>(kept) / static_cast<double>(trial.new_flights);
    }

    /// How often the intervals of a model, fitted to so many flights with that noise, hold flights to come.
    IntervalShares interval_shares(std::size_t flights, double noise_w, std::size_t new_flights) {
        const auto fitted = fitted_model(flights, noise_w);
        const auto planned = with_highest_quality(problem_of(fitted));
        const auto landings = draw_landings(planned, collect_uncertainty(planned.setup));
        const Interval left_percent{landings.quantile_percent(0.975), landings.quantile_percent(0.025)};
        IntervalShares shares{};
        const double part = 1.0 / static_cast<double>(new_flights);
        for (const auto phase : flight::all_phases) {
            const auto mean = mechanical::mean_power(fitted, phase)->interval.value();
            shares[index_of(phase)] = contains(mean, mean_w_[phase]) ? 1.0 : 0.0;
        }
        for (std::size_t i = 0; i < new_flights; ++i) {
            const auto flown = fly();
            mechanical::EnergyEstimate total;
            double flown_wh = 0.0;
            for (const auto phase : flight::all_phases) {
                const double energy_wh = units::wh_from_joule(flown.level_w[phase] * flown.duration_s[phase]);
                const auto estimate = predict_before_flight(forecast_of(fitted, phase), flown.duration_s[phase]);
                if (interval_95(estimate)->contains(energy_wh)) shares[3 + index_of(phase)] += part;
                total = sum_of(total, estimate);
                flown_wh += energy_wh;
            }
            if (interval_95(total)->contains(flown_wh)) shares[6] += part;
            if (contains(left_percent, land(planned, flown).remaining_percent)) shares[7] += part;
        }
        return shares;
    }

  private:
    using Phase = flight::Phase;

    static std::size_t index_of(Phase phase) { return static_cast<std::size_t>(phase); }
    static bool contains(const Interval& interval, double value) {
        return interval.low <= value && value <= interval.high;
    }

    struct Flown {
        flight::PerPhase<double> level_w;
        flight::PerPhase<double> duration_s;
    };

    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    double normal() { return std::normal_distribution<double>()(random_); }

    Flown fly() {
        Flown flown;
        const double common = normal();
        for (const auto phase : flight::all_phases) {
            const double deviation = std::sqrt(together_) * common + std::sqrt(1.0 - together_) * normal();
            flown.level_w[phase] = mean_w_[phase] + level_sd_w_[phase] * deviation;
            flown.duration_s[phase] = lasts_s_[phase] + duration_sd_s_[phase] * normal();
        }
        return flown;
    }

    /// Its curve in a phase, with that mean.
    mechanical::FourierModel curve_of(Phase phase, const Flown& flown) const {
        const double duration_s = flown.duration_s[phase];
        const double swing_w = 0.05 * mean_w_[phase];
        mechanical::FourierModel curve{4.0 / duration_s, 0.0, {swing_w}, {-swing_w}};
        curve.a0_w = flown.level_w[phase] - energy_j(curve, duration_s) / duration_s;
        return curve;
    }

    mechanical::MechanicalModel model(std::size_t flights) {
        mechanical::MechanicalModel model;
        model.flights.resize(flights);
        std::vector<Flown> flown(flights);
        for (auto& flight : flown) flight = fly();
        for (const auto phase : flight::all_phases) {
            mechanical::PhaseFit fit;
            fit.theta_rad = 4.0;
            std::vector<double> levels_w;
            for (const auto& flight : flown) {
                fit.flights.push_back({"", flight.duration_s[phase], curve_of(phase, flight), 0.1, 100});
                levels_w.push_back(flight.level_w[phase]);
            }
            const auto weights = flight_weights(fit, mechanical::Weighting::agreement);
            model.phases[phase] = average_phase(fit, weights);
            model.phases[phase].level_spread = mechanical::VarianceComponents{flights, sample_sd(levels_w), 0.1, 20.0};
            for (std::size_t i = 0; i < flights; ++i)
                model.flights[i].phases[phase] = {weights[i], flown[i].duration_s[phase], 0.1, 100, levels_w[i]};
        }
        return model;
    }

    mechanical::MechanicalModel fitted_model(std::size_t flights, double noise_w = 0.24) {
        constexpr double gap_s = 2.0;
        std::vector<mechanical::FlightSamples> samples(flights);
        for (std::size_t i = 0; i < flights; ++i) {
            samples[i].flight = std::to_string(i);
            const auto flown = fly();
            for (const auto phase : flight::all_phases) {
                const auto curve = curve_of(phase, flown);
                auto& part = samples[i].phases[phase].emplace();
                part.duration_s = flown.duration_s[phase];
                for (double time_s = between(0.0, gap_s); time_s < part.duration_s;
                     time_s += gap_s * between(0.8, 1.2)) {
                    part.tau.push_back(time_s / part.duration_s);
                    part.power_w.push_back(power_w(curve, time_s) + noise_w * normal());
                }
            }
        }
        return fit_model(samples).model;
    }

    mission::PlanningProblem problem_of(mechanical::MechanicalModel model) const {
        mission::PlanningProblem problem;
        problem.setup.name = "unknown aircraft";
        for (const auto phase : flight::all_phases) {
            problem.setup.duration_s[phase] = durations_are_stated_ ? lasts_s_[phase] : model.phases[phase].duration_s;
            problem.setup.duration_is_stated[phase] = durations_are_stated_;
        }
        problem.setup.mechanical = std::move(model);
        std::vector<compute::ProfileNode> nodes;
        for (const double value : fps_) nodes.push_back({{value}, 1.0 + 0.65 * value, {}});
        problem.setup.compute.components.push_back({"detection", compute::make_power_profile("p", {"fps"}, nodes)});
        problem.setup.utilities.push_back(mission::Utility{0, 1.0, mission::UtilityShape::square_root, {}, {}});
        problem.setup.uncertainty.compute_sd_percent.resize(1);
        problem.plan.choices.push_back({{fps_}, false});
        problem.plan.slot_s = 20.0;
        problem.setup.battery.capacity_ah = 1.6;
        problem.setup.battery.voltage_v = 11.1;
        if (kind_ > 0) problem.setup.battery.resistance_ohm = 0.05;
        if (kind_ == 2) {
            battery::TheveninCircuit circuit;
            circuit.open_circuit = {{0.0, 10.0, 30.0, 60.0, 100.0}, {9.9, 11.0, 11.3, 11.6, 12.5}};
            circuit.rc_resistance_ohm = 0.02;
            circuit.rc_time_constant_s = 30.0;
            problem.setup.battery.thevenin = circuit;
        }
        return problem;
    }

    mission::Mission with_highest_quality(const mission::PlanningProblem& problem) const {
        mission::Mission mission{problem.setup, {}};
        for (const auto phase : flight::all_phases)
            mission.schedule.push_back({phase, 0.0, problem.setup.duration_s[phase], {{0, {fps_.back()}}}});
        return mission;
    }

    /// Three deviations above what the highest quality leaves of the average flight: spent to the last slot.
    double reserve_percent() {
        const Flown average{mean_w_, lasts_s_};
        mechanical::MechanicalModel model;
        double variance_j2 = 0.0;
        for (const auto phase : flight::all_phases) {
            model.phases[phase].fourier = curve_of(phase, average);
            model.phases[phase].duration_s = lasts_s_[phase];
            variance_j2 += std::pow(level_sd_w_[phase] * lasts_s_[phase], 2) +
                           std::pow(duration_sd_s_[phase] * (mean_w_[phase] + 20.0), 2);
        }
        const auto mission = with_highest_quality(problem_of(std::move(model)));
        return *simulate(mission).summary.final_soc_percent +
               3.0 * units::percentage(units::wh_from_joule(std::sqrt(variance_j2)),
                                       full_energy_wh(mission.setup.battery));
    }

    mission::FlightOutcome land(const mission::Mission& planned, const Flown& flown) const {
        auto flight = planned.setup;
        flight.duration_s = flown.duration_s;
        for (const auto phase : flight::all_phases) {
            flight.mechanical->phases[phase].fourier = curve_of(phase, flown);
            flight.mechanical->phases[phase].duration_s = flown.duration_s[phase];
        }
        const auto schedule = rescale_to_flown_durations(planned.schedule, planned.setup.duration_s, flown.duration_s);
        return mission::simulate_flight({flight, load_segments(flight, schedule)});
    }

    std::mt19937 random_;
    unsigned kind_;
    double together_ = 0.0;  ///< share of the levels' variance that the phases have in common
    bool durations_are_stated_ = true;
    const flight::PerPhase<double> mean_w_{{50.0, 25.0, 12.0}};
    const flight::PerPhase<double> lasts_s_{{30.0, 600.0, 60.0}};
    flight::PerPhase<double> level_sd_w_;
    flight::PerPhase<double> duration_sd_s_;
    const std::vector<double> fps_{1.0, 5.0, 10.0, 16.0, 25.0, 32.0};
};

/// What became of predictions.
struct KeptPromises {
    double share = 0.0;  ///< of new flights, averaged over the models that had a plan
    double standard_error = 0.0;
    std::size_t without_plan = 0;
};

/// Of as many models, one an aircraft and seed; every third seed (from one that 3 divides) has an ideal battery.
inline KeptPromises keep_promises(const PromiseTrial& trial, std::size_t models, unsigned first_seed,
                                  unsigned step = 1) {
    KeptPromises kept;
    std::vector<double> shares;
    for (std::size_t i = 0; i < models; ++i) {
        const auto seed = first_seed + static_cast<unsigned>(i) * step;
        if (const auto share = UnknownAircraft(seed, trial.by_plan).kept_share(trial))
            shares.push_back(*share);
        else
            ++kept.without_plan;
    }
    if (shares.size() < 2) return kept;
    kept.share = mean(shares);
    kept.standard_error = sample_sd(shares) / std::sqrt(static_cast<double>(shares.size()));
    return kept;
}

}  // namespace flightwatt::test
