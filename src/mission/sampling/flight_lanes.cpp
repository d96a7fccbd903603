#include "mission/sampling/flight_lanes.h"

#include "base/units.h"
#include "battery/discharge_lanes.h"
#include "battery/fast_discharge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

namespace flightwatt::mission {
namespace {

/// Energy demanded after the battery failed, as a part of what a full one holds [points].
double unserved_demand_percent(const SampledFlight& flight, double failed_at_s) {
    double missed_j = 0.0;
    for (const auto& segment : flight.segments) {
        const double from_s = std::max(segment.start_s, failed_at_s);
        if (from_s >= segment.end_s) continue;
        missed_j += mechanical_energy_j(segment, segment.end_s) + compute_energy_j(segment, segment.end_s) -
                    mechanical_energy_j(segment, from_s) - compute_energy_j(segment, from_s);
    }
    return units::percentage(units::wh_from_joule(missed_j), full_energy_wh(flight.battery));
}

using battery::lane_count;
using battery::Lanes;

/// A phase of flights side by side.
struct PhaseLanes {
    Lanes duration_s = Lanes::Ones();
    Lanes start_s = Lanes::Zero();
    Lanes a0_w = Lanes::Zero();
    std::vector<Lanes> cos_w;
    std::vector<Lanes> sin_w;
};

/// How the battery of a flight failed.
struct Failure {
    double time_s = 0.0;
    double soc_percent = 0.0;  ///< then, and from then on
    bool is_empty = false;
};

bool have_lanes(const MissionSetup& setup) {
    return !setup.cruise_path &&
           std::ranges::none_of(setup.measured_power.values, [](const auto& m) { return m != nullptr; });
}

/// Flies up to lane_count flights at once.
class Block {
  public:
    Block(const MissionSetup& setup, const FlightUncertainty& spreads, const LaneSchedule& schedule)
        : setup_(setup),
          spreads_(spreads),
          schedule_(schedule),
          flight_(setup),
          compute_w_(schedule.configurations.size()) {
        for (const auto phase : all_phases) {
            if (!setup.mechanical) continue;
            phases_[phase].cos_w.resize(setup.mechanical->phases[phase].fourier.cos_w.size());
            phases_[phase].sin_w.resize(phases_[phase].cos_w.size());
        }
        if (setup.battery.thevenin) batteries_ = battery::make_lanes(setup.battery);
    }

    /// Which of the flights landed here; the others have to fly alone.
    battery::LaneMask fly(std::span<const std::vector<double>> normals, std::size_t times,
                          std::span<FlightOutcome> landings) {
        normals_ = normals;
        failures_ = {};
        for (auto& flight : alone_) flight.reset();
        battery::LaneMask flown;
        for (std::size_t i = 0; i < lane_count; ++i) {
            // Empty lanes fly as the first does; nobody looks at them.
            apply_draw_to(setup_, spreads_, normals[i < normals.size() ? i : 0], flight_);
            set_lane(static_cast<int>(i));
            flown[i] = i < normals.size() && is_ordinary();
        }
        battery::StateLanes state;
        state.is_active = flown;
        state.soc_percent = initial_soc_percent_;
        for (const auto& stretch : schedule_.stretches) {
            for (std::size_t note = 0; note < stretch.outputs_at_start; ++note) note_charges(state, flown, landings);
            setup_.battery.thevenin ? fly_thevenin(stretch, state) : fly_constant(stretch, state);
        }
        if (!setup_.battery.thevenin) flown &= above_zero(state);
        for (std::size_t i = 0; i < normals.size(); ++i)
            if (flown[i]) land_lane(i, state, times, landings[i]);
        return flown;
    }

  private:
    void set_lane(int lane) {
        double start_s = 0.0;
        for (const auto phase : all_phases) {
            auto& lanes = phases_[phase];
            lanes.duration_s(lane) = flight_.duration_s[phase];
            lanes.start_s(lane) = start_s;
            start_s += flight_.duration_s[phase];
            if (!flight_.mechanical) continue;
            const auto& curve = flight_.mechanical->phases[phase].fourier;
            lanes.a0_w(lane) = curve.a0_w;
            for (std::size_t n = 0; n < curve.cos_w.size(); ++n) {
                lanes.cos_w[n](lane) = curve.cos_w[n];
                lanes.sin_w[n](lane) = curve.sin_w[n];
            }
        }
        for (std::size_t k = 0; k < compute_w_.size(); ++k) {
            double sum_w = 0.0;
            for (const auto& [component, node, weight] : schedule_.configurations[k])
                sum_w += weight * flight_.compute.components[component].profile.power_w[node];
            compute_w_[k](lane) = sum_w;
        }
        if (batteries_) battery::set_lane(*batteries_, lane, flight_.battery);
        initial_soc_percent_(lane) = flight_.initial_soc_percent;
        voltage_v_(lane) = flight_.battery.voltage_v;
        resistance_ohm_(lane) = flight_.battery.resistance_ohm;
        capacity_as_(lane) = units::coulomb_from_ah(flight_.battery.capacity_ah);
        last_lane_ = lane;
    }

    /// Whether the flight that was drawn last needs nothing that lanes cannot: it never charges, it is not so long that
    /// steps would be too long, and a constant source delivers all that it demands.
    bool is_ordinary() const {
        PerPhase<double> amplitude_w;
        if (flight_.mechanical) {
            for (const auto phase : all_phases) {
                const auto& curve = flight_.mechanical->phases[phase].fourier;
                for (std::size_t n = 0; n < curve.cos_w.size(); ++n)
                    amplitude_w[phase] += std::hypot(curve.cos_w[n], curve.sin_w[n]);
            }
        }
        double max_w = 0.0;
        for (const auto& stretch : schedule_.stretches) {
            const auto phase = stretch.phase;
            const double level_w = phases_[phase].a0_w(last_lane_) + compute_w_[stretch.configuration](last_lane_);
            if (flight_.duration_s[phase] > stretch.max_s || level_w < amplitude_w[phase]) return false;
            max_w = std::max(max_w, level_w + amplitude_w[phase]);
        }
        const auto& battery = flight_.battery;
        return battery.thevenin ||
               (max_w < power_limit_w(battery) &&
                terminal_voltage_v(battery, {}, internal_current_a(battery, max_w)) >= setup_.cutoff_voltage_v);
    }

    Lanes start_of(const LaneSegment& stretch) const {
        const auto& phase = phases_[stretch.phase];
        return phase.start_s + stretch.from_part * phase.duration_s;
    }
    Lanes length_of(const LaneSegment& stretch) const {
        return (stretch.to_part - stretch.from_part) * phases_[stretch.phase].duration_s;
    }

    void power_at(const LaneSegment& stretch, std::size_t node, Lanes& power_w) const {
        const auto& phase = phases_[stretch.phase];
        power_w = phase.a0_w + compute_w_[stretch.configuration];
        if (!stretch.harmonics.empty()) {
            const auto& turned = stretch.harmonics[node];
            for (std::size_t n = 0; n < phase.cos_w.size(); ++n)
                power_w += turned[2 * n] * phase.cos_w[n] + turned[2 * n + 1] * phase.sin_w[n];
        } else if (setup_.mechanical) {
            const double omega = setup_.mechanical->phases[stretch.phase].fourier.omega_rad_per_s;
            const Lanes angle_rad =
                omega * std::lerp(stretch.from_part, stretch.to_part, stretch.nodes[node]) * phase.duration_s;
            for (std::size_t n = 0; n < phase.cos_w.size(); ++n) {
                const Lanes turned_rad = static_cast<double>(n + 1) * angle_rad;
                power_w += turned_rad.cos() * phase.cos_w[n] + turned_rad.sin() * phase.sin_w[n];
            }
        }
    }

    /// The charge that a source of constant voltage gives away.
    void fly_constant(const LaneSegment& stretch, battery::StateLanes& state) const {
        Lanes mean_a = Lanes::Zero();
        Lanes power_w;
        for (std::size_t node = 0; node < stretch.nodes.size(); ++node) {
            power_at(stretch, node, power_w);
            const Lanes spare_v2 = voltage_v_ * voltage_v_ - 4.0 * resistance_ohm_ * power_w;
            mean_a += stretch.weights[node] * 2.0 * power_w / (voltage_v_ + spare_v2.max(0.0).sqrt());
        }
        state.soc_percent -= units::percent_per_whole * mean_a * length_of(stretch) / capacity_as_;
    }

    void fly_thevenin(const LaneSegment& stretch, battery::StateLanes& state) {
        const battery::LoadLanes load{length_of(stretch), stretch.steps, [&](std::size_t half_step, Lanes& power_w) {
                                          power_at(stretch, half_step, power_w);
                                      }};
        const auto look_closer = [&](int lane, std::size_t step, battery::BatteryState& now) {
            return goes_on(stretch, step, static_cast<std::size_t>(lane), now);
        };
        discharge_lanes(*batteries_, load, setup_.cutoff_voltage_v, look_closer, state);
    }

    /// One step of one flight by itself.
    bool goes_on(const LaneSegment& stretch, std::size_t step, std::size_t i, battery::BatteryState& now) {
        const int lane = static_cast<int>(i);
        const auto& flight = alone(i);
        const double step_s = length_of(stretch)(lane) / static_cast<double>(stretch.steps);
        const double start_s = start_of(stretch)(lane) + static_cast<double>(step) * step_s;
        std::optional<mechanical::FourierModel> curve;
        if (flight.mechanical)
            curve = time_scaled_model(flight.mechanical->phases[stretch.phase], flight.duration_s[stretch.phase],
                                      setup_.phase_clock);
        const double compute_w = compute_w_[stretch.configuration](lane);
        const double phase_start_s = phases_[stretch.phase].start_s(lane);
        const auto power_w = [&](double time_s) {
            return compute_w + (curve ? mechanical::power_w(*curve, time_s - phase_start_s) : 0.0);
        };
        const auto after = battery::fast_discharge(flight.battery, {power_w, start_s, start_s + step_s}, now,
                                                   {step_s, setup_.cutoff_voltage_v});
        now = after;
        if (after.undeliverable) failures_.at(i) = {after.undeliverable->time_s, now.soc_percent, false};
        if (const auto ended_at_s = after.ended_at_s())
            failures_.at(i) = {*ended_at_s, now.soc_percent, after.empty_at_s.has_value()};
        return !failures_.at(i);
    }

    const MissionSetup& alone(std::size_t i) {
        auto& flight = alone_.at(i);
        if (!flight) flight = std::make_unique<MissionSetup>(apply_draw(setup_, spreads_, normals_[i]));
        return *flight;
    }

    double soc_percent(std::size_t i, const battery::StateLanes& state) const {
        return failures_.at(i) ? failures_.at(i)->soc_percent : state.soc_percent(static_cast<int>(i));
    }

    void note_charges(const battery::StateLanes& state, const battery::LaneMask& flown,
                      std::span<FlightOutcome> landings) const {
        for (std::size_t i = 0; i < landings.size(); ++i)
            if (flown[i]) landings[i].soc_percent.push_back(soc_percent(i, state));
    }

    static battery::LaneMask above_zero(const battery::StateLanes& state) {
        battery::LaneMask mask;
        for (std::size_t i = 0; i < lane_count; ++i) mask[i] = state.soc_percent(static_cast<int>(i)) > 0.0;
        return mask;
    }

    /// As land() does.
    void land_lane(std::size_t i, const battery::StateLanes& state, std::size_t times, FlightOutcome& landing) {
        const int lane = static_cast<int>(i);
        landing.final_soc_percent = landing.remaining_percent = soc_percent(i, state);
        landing.soc_percent.resize(times, landing.final_soc_percent);
        if (!failures_.at(i)) return;
        const auto& failure = *failures_.at(i);
        const auto& last = phases_[all_phases.back()];
        const double lasted_s = last.start_s(lane) + last.duration_s(lane) - end_tolerance_s;
        const bool is_early = failure.time_s < lasted_s;
        landing.depleted = failure.is_empty && is_early;
        landing.battery_failure = is_early;
        if (is_early) landing.remaining_percent = std::min(-1e-9, -missed_percent(i, failure.time_s));
    }

    /// Energy demanded after the battery failed, as a part of what a full one holds [points].
    double missed_percent(std::size_t i, double failed_at_s) {
        const int lane = static_cast<int>(i);
        const auto& flight = alone(i);
        double missed_j = 0.0;
        for (const auto phase : all_phases) {
            const double flown_s = flight.duration_s[phase];
            const double from_s = std::max(0.0, failed_at_s - phases_[phase].start_s(lane));
            if (!flight.mechanical || from_s >= flown_s) continue;
            const auto curve = time_scaled_model(flight.mechanical->phases[phase], flown_s, setup_.phase_clock);
            missed_j += energy_j(curve, flown_s) - energy_j(curve, from_s);
        }
        for (const auto& stretch : schedule_.stretches) {
            const double flown_s = flight.duration_s[stretch.phase];
            const double failed_in_phase_s = failed_at_s - phases_[stretch.phase].start_s(lane);
            const double from_s = std::max(stretch.from_part * flown_s, failed_in_phase_s);
            missed_j += compute_w_[stretch.configuration](lane) * std::max(0.0, stretch.to_part * flown_s - from_s);
        }
        return units::percentage(units::wh_from_joule(missed_j), full_energy_wh(flight.battery));
    }

    const MissionSetup& setup_;
    const FlightUncertainty& spreads_;
    const LaneSchedule& schedule_;
    MissionSetup flight_;  ///< that was drawn last
    int last_lane_ = 0;
    std::span<const std::vector<double>> normals_;
    PerPhase<PhaseLanes> phases_;
    std::vector<Lanes> compute_w_;  ///< of each configuration
    std::optional<battery::BatteryLanes> batteries_;
    Lanes initial_soc_percent_;
    Lanes voltage_v_;
    Lanes resistance_ohm_;
    Lanes capacity_as_;
    std::array<std::optional<Failure>, lane_count> failures_;
    std::array<std::unique_ptr<MissionSetup>, lane_count> alone_;  ///< of lanes that were looked at closer
};

}  // namespace

FlightOutcome simulate_flight(const SampledFlight& flight, const std::vector<double>& times_s) {
    FlightOutcome landing;
    battery::Discharge charge{{flight.setup.initial_soc_percent}};
    auto& noted_percent = landing.soc_percent;
    for (auto part : flight.segments) {
        const double segment_end_s = part.end_s;
        const auto follow_until = [&](double time_s) {
            part.end_s = time_s;
            charge = advance_segment(flight.battery, flight.setup.cutoff_voltage_v, part, charge);
            part.start_s = time_s;
            part.soc_drop_percent = 0.0;
        };
        while (noted_percent.size() < times_s.size() && times_s[noted_percent.size()] < segment_end_s) {
            follow_until(std::max(part.start_s, times_s[noted_percent.size()]));
            noted_percent.push_back(charge.soc_percent);
        }
        follow_until(segment_end_s);
    }
    noted_percent.resize(times_s.size(), charge.soc_percent);
    landing.final_soc_percent = charge.soc_percent;
    const double lasted_s = flight.segments.back().end_s - end_tolerance_s;
    landing.depleted = charge.empty_at_s && *charge.empty_at_s < lasted_s;
    landing.battery_failure = charge.undeliverable || (charge.ended_at_s() && *charge.ended_at_s() < lasted_s);
    landing.remaining_percent = charge.soc_percent;
    if (const auto& path = flight.setup.cruise_path; path && path->is_infeasible) {
        landing.battery_failure = true;  // it never gets there
        landing.remaining_percent = std::min(-1e-9, landing.remaining_percent - units::percent_per_whole);
    } else if (landing.battery_failure) {
        const double failed_at_s = charge.undeliverable ? charge.undeliverable->time_s : *charge.ended_at_s();
        landing.remaining_percent = std::min(-1e-9, -unserved_demand_percent(flight, failed_at_s));
    }
    return landing;
}

SimdFlightSimulator::SimdFlightSimulator(const MissionSetup& setup, const FlightUncertainty& spreads,
                                         const Schedule& schedule, std::vector<double> times_s)
    : setup_(setup),
      spreads_(spreads),
      schedule_(schedule),
      times_s_(std::move(times_s)),
      have_lanes_(have_lanes(setup)) {
    if (have_lanes_) lanes_ = lane_schedule(setup, spreads, schedule, times_s_);
}

void SimdFlightSimulator::simulate(std::span<const std::vector<double>> normals,
                                   std::span<FlightOutcome> landings) const {
    std::optional<Block> block;
    for (std::size_t from = 0; from < normals.size(); from += lane_count) {
        const auto count = std::min<std::size_t>(lane_count, normals.size() - from);
        const auto own = normals.subspan(from, count);
        battery::LaneMask flown;
        if (have_lanes_) {
            if (!block) block.emplace(setup_, spreads_, lanes_);
            flown = block->fly(own, times_s_.size(), landings.subspan(from, count));
        }
        for (std::size_t i = 0; i < count; ++i)
            if (!flown[i]) landings[from + i] = simulate_scalar(own[i]);
    }
}

FlightOutcome SimdFlightSimulator::simulate_scalar(std::span<const double> normals) const {
    const auto& planned_s = setup_.duration_s;
    const auto flight = apply_draw(setup_, spreads_, normals);
    const auto schedule = rescale_to_flown_durations(schedule_, planned_s, flight.duration_s);
    auto times_s = times_s_;
    for (auto& time_s : times_s) time_s = rescale_to_flown_durations_s(time_s, planned_s, flight.duration_s);
    return simulate_flight({flight, flight.battery, load_segments(flight, schedule)}, times_s);
}

}  // namespace flightwatt::mission
