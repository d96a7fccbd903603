#include "mission/sampling/flight_lanes.h"

#include "base/parallel.h"
#include "base/units.h"
#include "battery/discharge_lanes.h"
#include "battery/fast_discharge.h"

#include <algorithm>
#include <array>
#include <complex>
#include <limits>
#include <optional>
#include <utility>

namespace flightwatt::mission {
namespace {

using battery::lane_count;
using battery::Lanes;

/// Energy demanded after the battery failed, as a fraction of its full energy [points].
double unserved_demand_percent(const DrawnFlight& flight, double failed_at_s) {
    double missed_j = 0.0;
    for (const auto& segment : flight.segments) {
        const double from_s = std::max(segment.start_s, failed_at_s);
        if (from_s >= segment.end_s) continue;
        missed_j += mechanical_energy_j(segment, segment.end_s) + compute_energy_j(segment, segment.end_s) -
                    mechanical_energy_j(segment, from_s) - compute_energy_j(segment, from_s);
    }
    return units::percentage(units::wh_from_joule(missed_j), full_energy_wh(flight.setup.battery));
}

FlightOutcome land(const DrawnFlight& flight, const battery::Discharge& charge, std::vector<double> noted_percent) {
    FlightOutcome landing;
    landing.soc_percent = std::move(noted_percent);
    landing.soc_percent.resize(flight.times_s.size(), charge.soc_percent);
    landing.final_soc_percent = landing.remaining_percent = charge.soc_percent;
    const double lasted_s = flight.segments.back().end_s - end_tolerance_s;
    landing.depleted = charge.empty_at_s && *charge.empty_at_s < lasted_s;
    landing.battery_failure = charge.undeliverable || (charge.ended_at_s() && *charge.ended_at_s() < lasted_s);
    if (const auto& path = flight.setup.cruise_path; path && path->is_infeasible) {
        landing.battery_failure = true;
        landing.remaining_percent = std::min(-1e-9, landing.remaining_percent - units::percent_per_whole);
    } else if (landing.battery_failure) {
        const double failed_at_s = charge.undeliverable ? charge.undeliverable->time_s : *charge.ended_at_s();
        landing.remaining_percent = std::min(-1e-9, -unserved_demand_percent(flight, failed_at_s));
    }
    return landing;
}

/// The powers of segments side by side, every half of a step. Each harmonic advances by x'' = 2 cos(turn) x' - x.
class PowerLanes {
  public:
    void begin(int lane, const LoadSegment& segment, double step_s) {
        static const mechanical::FourierModel none;
        const auto& curve = segment.mechanical ? *segment.mechanical : none;
        const auto start = std::polar(1.0, curve.omega_rad_per_s * (segment.start_s - segment.phase_start_s));
        const auto turn = std::polar(1.0, 0.5 * curve.omega_rad_per_s * step_s);
        mean_w_(lane) = curve.a0_w + segment.compute_w;
        const auto most = std::max(now_w_.size(), curve.cos_w.size());
        for (auto* lanes : {&now_w_, &before_w_, &factor_}) lanes->resize(most, Lanes::Zero());
        std::complex<double> of_now = 1.0;
        std::complex<double> of_turn = 1.0;
        for (std::size_t n = 0; n < most; ++n) {
            const bool is_there = n < curve.cos_w.size();
            const std::complex<double> term_w(is_there ? curve.cos_w[n] : 0.0, is_there ? -curve.sin_w[n] : 0.0);
            of_now *= start;
            of_turn *= turn;
            now_w_[n](lane) = (term_w * of_now).real();
            before_w_[n](lane) = (term_w * of_now * std::conj(of_turn)).real();
            factor_[n](lane) = 2.0 * of_turn.real();
        }
    }

    /// Half a step later.
    void advance(Lanes& power_w) {
        power_w = mean_w_;
        for (std::size_t n = 0; n < now_w_.size(); ++n) {
            before_w_[n] = factor_[n] * now_w_[n] - before_w_[n];
            power_w += before_w_[n];
        }
        std::swap(now_w_, before_w_);
    }

  private:
    Lanes mean_w_ = Lanes::Zero();
    std::vector<Lanes> now_w_;  ///< of each harmonic
    std::vector<Lanes> before_w_;
    std::vector<Lanes> factor_;
};

/// A stream of flights: one that has landed makes room in its lane for the next.
class FlightLanes {
  public:
    FlightLanes(const MissionSetup& mission, const FlightDraw& draw, std::size_t first,
                std::span<FlightOutcome> outcomes)
        : mission_(mission), draw_(draw), first_(first), outcomes_(outcomes), batteries_(mission.battery) {}

    void fly() {
        for (int lane = 0; lane < lane_count; ++lane) begin_flight(lane);
        set_next_end();
        while (is_active_.any()) step();
    }

  private:
    /// A flight in its lane.
    struct Flying {
        std::optional<DrawnFlight> flight;
        std::size_t number = 0;
        std::size_t segment = 0;
        battery::Discharge charge;
        std::vector<double> noted_percent;
        std::size_t first_step = 0;  ///< of the segment, counted by `steps_`
        std::size_t end_step = 0;
        double step_s = 0.0;
    };

    Flying& flying(int lane) { return flying_.at(static_cast<std::size_t>(lane)); }

    /// The next flight that is not over at once takes the lane.
    void begin_flight(int lane) {
        auto& own = flying(lane);
        bool continues = false;
        while (!continues && next_ < outcomes_.size()) {
            own.number = next_++;
            if (!own.flight) own.flight = DrawnFlight{mission_, {}};
            draw_(first_ + own.number, *own.flight);
            own.segment = 0;
            own.charge = {{own.flight->setup.initial_soc_percent}};
            own.noted_percent.clear();
            if (mission_.battery.thevenin) batteries_.set_battery(lane, own.flight->setup.battery);
            continues = next_segment(lane);
        }
        is_active_[static_cast<std::size_t>(lane)] = continues;
    }

    /// Starts the flight's next segment; false if it has landed. Segments that need no SIMD steps are simulated at
    /// once.
    bool next_segment(int lane) {
        auto& own = flying(lane);
        auto& [setup, segments, times_s] = *own.flight;
        const auto has_ended = [&] { return own.charge.ended_at_s() || own.charge.undeliverable; };
        for (; own.segment < segments.size() && !has_ended(); ++own.segment) {
            auto& segment = segments[own.segment];
            if (segment.soc_drop_percent > 0.0) own.charge = apply_charge_drop(own.charge, segment);
            segment.soc_drop_percent = 0.0;
            auto& noted = own.noted_percent;
            while (noted.size() < times_s.size() && times_s[noted.size()] <= segment.start_s + end_tolerance_s)
                noted.push_back(own.charge.soc_percent);
            if (!has_ended() && setup.battery.thevenin && bounds_of(segment).low >= 0.0 && segment.duration_s() > 0.0) {
                begin_segment(lane, segment);
                return true;
            }
            own.charge = advance_segment(setup.battery, setup.cutoff_voltage_v, segment, own.charge);
        }
        outcomes_[own.number] = land(*own.flight, own.charge, std::move(own.noted_percent));
        return false;
    }

    void begin_segment(int lane, const LoadSegment& segment) {
        auto& own = flying(lane);
        const auto steps = fast_steps(*own.flight->setup.battery.thevenin, segment.duration_s(), quick_step_s(segment));
        own.first_step = steps_;
        own.end_step = steps_ + steps;
        own.step_s = segment.duration_s() / static_cast<double>(steps);
        batteries_.set_state(lane, own.charge);
        batteries_.set_step(lane, own.step_s);
        powers_.begin(lane, segment, own.step_s);
        start_w_(lane) = power_w(segment, segment.start_s);
    }

    void step() {
        powers_.advance(middle_w_);
        powers_.advance(end_w_);
        const auto may_end = batteries_.step(start_w_, middle_w_, end_w_, mission_.cutoff_voltage_v);
        start_w_ = end_w_;
        ++steps_;
        if (steps_ < next_end_ && (may_end & is_active_).none()) return;
        for (int lane = 0; lane < lane_count; ++lane) {
            const auto i = static_cast<std::size_t>(lane);
            if (is_active_[i] && !end_step(lane, may_end[i])) begin_flight(lane);
        }
        set_next_end();
    }

    void set_next_end() {
        next_end_ = std::numeric_limits<std::size_t>::max();
        for (std::size_t i = 0; i < lane_count; ++i)
            if (is_active_[i]) next_end_ = std::min(next_end_, flying_.at(i).end_step);
    }

    /// False if the flight has landed.
    bool end_step(int lane, bool may_end) {
        auto& own = flying(lane);
        if (may_end) {
            const auto& segment = own.flight->segments[own.segment];
            const double start_s = segment.start_s + static_cast<double>(steps_ - 1 - own.first_step) * own.step_s;
            const auto power = [&](double time_s) { return power_w(segment, time_s); };
            own.charge =
                battery::fast_discharge(own.flight->setup.battery, {power, start_s, start_s + own.step_s},
                                        batteries_.state_before(lane), {own.step_s, mission_.cutoff_voltage_v});
            if (own.charge.ended_at_s() || own.charge.undeliverable) return next_segment(lane);
            batteries_.set_state(lane, own.charge);
        }
        if (steps_ < own.end_step) return true;
        own.charge = {batteries_.state(lane)};
        ++own.segment;
        return next_segment(lane);
    }

    const MissionSetup& mission_;
    const FlightDraw& draw_;
    std::size_t first_;
    std::span<FlightOutcome> outcomes_;
    std::size_t next_ = 0;
    std::size_t steps_ = 0;     ///< that all have flown
    std::size_t next_end_ = 0;  ///< the first step after which a segment ends
    std::array<Flying, lane_count> flying_;
    battery::LaneMask is_active_;
    battery::DischargeLanes batteries_;
    PowerLanes powers_;
    Lanes start_w_ = Lanes::Zero();
    Lanes middle_w_ = Lanes::Zero();
    Lanes end_w_ = Lanes::Zero();
};

}  // namespace

void fly_side_by_side(const MissionSetup& mission, const FlightDraw& draw, std::size_t first,
                      std::span<FlightOutcome> outcomes) {
    FlightLanes(mission, draw, first, outcomes).fly();
}

std::vector<FlightOutcome> fly_drawn(const MissionSetup& mission, const FlightDraw& draw, std::size_t first,
                                     std::size_t count) {
    constexpr std::size_t most_at_once = 1024;
    const auto at_once = std::clamp<std::size_t>(count / (4 * threads_for(count)), lane_count, most_at_once);
    std::vector<FlightOutcome> outcomes(count);
    for_each_in_parallel((count + at_once - 1) / at_once, [&](std::size_t block) {
        const auto start = block * at_once;
        fly_side_by_side(mission, draw, first + start,
                         std::span(outcomes).subspan(start, std::min(at_once, count - start)));
    });
    return outcomes;
}

FlightOutcome simulate_flight(const DrawnFlight& flight) {
    FlightOutcome outcome;
    fly_side_by_side(flight.setup, [&](std::size_t, DrawnFlight& drawn) { drawn = flight; }, 0, {&outcome, 1});
    return outcome;
}

}  // namespace flightwatt::mission
