#include "mission/sampling/landing_distribution.h"

#include "base/parallel.h"
#include "base/statistics.h"
#include "base/units.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace flightwatt::mission {
namespace {

constexpr std::uint64_t seed_of_flights = 0x666c6967687473;
constexpr std::size_t first_flights = 1250;
constexpr double far_in_standard_errors = 4.0;

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

/// Draws flights of a mission, more of them from call to call.
class LandingSampler {
  public:
    LandingSampler(const Mission& mission, const FlightUncertainty& uncertainty)
        : mission_(mission), draw_(landing_draw(mission, uncertainty)), varies_(!uncertainty.sources.varied.empty()) {
        DrawnFlight as_stated{mission.setup, {}};
        draw_(stated_flight, as_stated);
        result_.nominal_percent = simulate_flight(as_stated).remaining_percent;
        result_.reserve_percent = mission.setup.reserve_soc_percent;
        if (!varies_) result_.left_percent = {result_.nominal_percent};
    }

    /// Up to `flights` in all; one where nothing varies.
    void draw_until(std::size_t flights) {
        if (!varies_) return;
        auto left_percent = std::move(result_.left_percent);
        for (const auto& landing : fly_drawn(mission_.setup, draw_, left_percent.size(), flights - left_percent.size()))
            left_percent.push_back(landing.remaining_percent);
        result_.set_left_percent(std::move(left_percent));
    }

    const LandingDistribution& landings() const { return result_; }

  private:
    const Mission& mission_;
    FlightDraw draw_;
    bool varies_;
    LandingDistribution result_;
};

}  // namespace

double LandingDistribution::below() const {
    const auto kept = std::ranges::lower_bound(left_percent, reserve_percent);
    return static_cast<double>(kept - left_percent.begin()) / static_cast<double>(left_percent.size());
}

double LandingDistribution::standard_error() const {
    if (sd_percent == 0.0) return 0.0;
    const auto all = static_cast<double>(left_percent.size());
    const double likely = (below() * all + 1.0) / (all + 2.0);  // none of a few is not never
    return std::sqrt(likely * (1.0 - likely) / all);
}

double LandingDistribution::quantile_percent(double probability) const {
    const auto last = left_percent.size() - 1;
    const auto missed = static_cast<std::size_t>((1.0 - probability) * static_cast<double>(left_percent.size()));
    return left_percent[std::min(missed, last)];
}

void LandingDistribution::set_left_percent(std::vector<double> percent) {
    left_percent = std::move(percent);
    std::ranges::sort(left_percent);
    sd_percent = sample_sd(left_percent);
}

FlightDraw landing_draw(const Mission& mission, const FlightUncertainty& uncertainty) {
    const auto count = count_normals(mission.setup);
    return [&mission, &uncertainty, count](std::size_t number, DrawnFlight& flight) {
        const auto normals =
            number == stated_flight ? std::vector<double>(count) : draw_normals(count, seed_of_flights, number);
        apply_draw(mission.setup, uncertainty, normals, flight.setup);
        flight.segments = load_segments(
            flight.setup,
            rescale_to_flown_durations(mission.schedule, mission.setup.duration_s, flight.setup.duration_s));
    };
}

LandingDistribution draw_landings(const Mission& mission, const FlightUncertainty& uncertainty) {
    LandingSampler sampler(mission, uncertainty);
    sampler.draw_until(landing_flights);
    return sampler.landings();
}

LandingDistribution draw_landings_until_known(const Mission& mission, const FlightUncertainty& uncertainty,
                                              double probability) {
    LandingSampler sampler(mission, uncertainty);
    draw_until_known([&](std::size_t flights) { sampler.draw_until(flights); }, sampler.landings(), probability);
    return sampler.landings();
}

void draw_until_known(const std::function<void(std::size_t flights)>& draw_until, const LandingDistribution& landings,
                      double probability) {
    if (!(probability >= 0.5 && probability < 1.0))
        throw std::invalid_argument("draw_landings_until_known: the probability is not from 0.5 to below 1");
    for (auto flights = first_flights;; flights = std::min(2 * flights, landing_flights)) {
        draw_until(flights);
        const double off = std::abs(landings.below() - (1.0 - probability));
        if (flights == landing_flights || off > far_in_standard_errors * landings.standard_error()) return;
    }
}

FlightOutcome simulate_flight(const DrawnFlight& flight) {
    const auto& [setup, segments, times_s] = flight;
    battery::Discharge charge{{setup.initial_soc_percent}};
    std::vector<double> noted_percent;
    for (const auto& segment : segments) {
        if (charge.failed_at_s()) break;
        const auto start = segment.soc_drop_percent > 0.0 ? apply_charge_drop(charge, segment) : charge;
        while (noted_percent.size() < times_s.size() &&
               times_s[noted_percent.size()] <= segment.start_s + end_tolerance_s)
            noted_percent.push_back(start.soc_percent);
        charge = advance_segment(setup.battery, setup.cutoff_voltage_v, segment, charge);
    }
    return land(flight, charge, std::move(noted_percent));
}

void for_each_drawn(const MissionSetup& mission, const FlightDraw& draw, std::size_t first, std::size_t count,
                    const std::function<void(std::size_t number, const DrawnFlight& flight)>& work) {
    constexpr std::size_t at_once = 64;
    for_each_in_parallel((count + at_once - 1) / at_once, [&](std::size_t block) {
        DrawnFlight flight{mission, {}};
        for (std::size_t i = first + block * at_once; i < first + std::min(count, (block + 1) * at_once); ++i) {
            draw(i, flight);
            work(i, flight);
        }
    });
}

std::vector<FlightOutcome> fly_drawn(const MissionSetup& mission, const FlightDraw& draw, std::size_t first,
                                     std::size_t count) {
    std::vector<FlightOutcome> outcomes(count);
    for_each_drawn(mission, draw, first, count, [&](std::size_t number, const DrawnFlight& flight) {
        outcomes[number - first] = simulate_flight(flight);
    });
    return outcomes;
}

}  // namespace flightwatt::mission
