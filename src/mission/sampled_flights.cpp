#include "mission/sampled_flights.h"

#include "base/statistics.h"
#include "base/units.h"
#include "mission/flight_draws.h"
#include "mission/flown_charge.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <iterator>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

constexpr double same_time_s = 1e-6;  ///< as in simulation.cpp: empty at the very end has lasted
constexpr double most_samples = 1e7;
constexpr double z_95 = 1.959963984540054;

/// How one flight ended.
struct Landing {
    double final_soc_percent = 0.0;
    bool depleted = false;
    bool gave_out = false;
    std::vector<double> soc_percent;  ///< at the band's times
};

/// Follows the charge through a demand and notes it at `times_s`, of which `noted` have been already.
battery::Discharge follow(const Mission& mission, const Demand& demand, battery::Discharge charge,
                          const std::vector<double>& times_s, std::vector<double>& noted_percent) {
    auto part = demand;
    while (noted_percent.size() < times_s.size() && times_s[noted_percent.size()] < demand.to_s) {
        part.to_s = std::max(part.from_s, times_s[noted_percent.size()]);
        charge = after_demand(mission, part, charge);
        noted_percent.push_back(charge.soc_percent);
        part.from_s = part.to_s;
        part.soc_drop_percent = 0.0;
    }
    part.to_s = demand.to_s;
    return after_demand(mission, part, charge);
}

Landing land(const Mission& flown, const std::vector<Disturbance>& disturbances,
             const std::vector<double>& times_s) {
    auto mission = flown;
    mission.battery = disturbed(flown.battery, disturbances);
    Landing landing;
    battery::Discharge charge;
    charge.soc_percent = mission.initial_soc_percent;
    const auto demands = disturbed(demands_of(mission), disturbances);
    for (const auto& demand : demands) charge = follow(mission, demand, charge, times_s, landing.soc_percent);
    landing.soc_percent.resize(times_s.size(), charge.soc_percent);
    landing.final_soc_percent = charge.soc_percent;
    const double lasted_s = demands.back().to_s - same_time_s;
    landing.depleted = charge.empty_at_s && *charge.empty_at_s < lasted_s;
    landing.gave_out =
        landing.depleted || charge.undeliverable || (charge.cut_off_at_s && *charge.cut_off_at_s < lasted_s);
    return landing;
}

/// Draws and flies flights, and hands each to the place of its number.
class Sampler {
  public:
    Sampler(const Flyable& flyable, const std::vector<Disturbance>& disturbances,
            const FlightSpreads& spreads, const SamplingOptions& options)
        : flyable_(flyable), disturbances_(disturbances), spreads_(spreads), options_(options) {
        double duration_s = 0.0;
        for (const double phase_s : flyable.mission.duration_s.values) duration_s += phase_s;
        for (std::size_t i = 0; i < options.band_times; ++i) {
            times_s_.push_back(duration_s * static_cast<double>(i) /
                               static_cast<double>(options.band_times - 1));
        }
    }

    const std::vector<double>& times_s() const { return times_s_; }

    std::vector<Landing> fly_all() const {
        std::vector<Landing> landings(options_.samples);
        std::atomic<std::size_t> next = 0;
        const auto work = [&] {
            for (std::size_t i = next++; i < landings.size(); i = next++) landings[i] = fly_one(i);
        };
        std::vector<std::future<void>> workers;
        for (unsigned k = 0; k < std::max(1U, std::thread::hardware_concurrency()); ++k)
            workers.push_back(std::async(std::launch::async, work));
        for (auto& worker : workers) worker.get();
        return landings;
    }

  private:
    Landing fly_one(std::size_t index) const {
        const auto& planned_s = flyable_.mission.duration_s;
        auto flight = draw_flight(flyable_.mission, spreads_, options_.seed, index);
        const auto disturbances = at_same_part(disturbances_, planned_s, flight.duration_s);
        auto times_s = times_s_;
        for (auto& time_s : times_s) time_s = at_same_part_s(time_s, planned_s, flight.duration_s);
        if (flyable_.adaptive) flight = fly_adaptively(*flyable_.adaptive, flight, disturbances).flown;
        return land(flight, disturbances, times_s);
    }

    const Flyable& flyable_;
    const std::vector<Disturbance>& disturbances_;
    const FlightSpreads& spreads_;
    const SamplingOptions& options_;
    std::vector<double> times_s_;
};

/// Of sorted values, straight lines between them (Hyndman and Fan's type 7).
double quantile(const std::vector<double>& sorted, double percent) {
    const double place = units::part_of(static_cast<double>(sorted.size() - 1), percent);
    const auto below = std::min(static_cast<std::size_t>(place), sorted.size() - 2);
    return std::lerp(sorted[below], sorted[below + 1], place - static_cast<double>(below));
}

/// Wilson's interval of a share `p` of n.
battery::Interval wilson_interval(double p, double n) {
    const double z2 = z_95 * z_95;
    const double middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
    const double reach = z_95 / (1.0 + z2 / n) * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n));
    // At 0 and 1 the ends are exact; rounding may leave them beside.
    return {p == 0.0 ? 0.0 : std::max(0.0, middle - reach), p == 1.0 ? 1.0 : std::min(1.0, middle + reach)};
}

void count_landings(const std::vector<Landing>& landings, double reserve_percent, SampledFlights& flights) {
    std::size_t depleted = 0;
    std::size_t gave_out = 0;
    std::size_t below = 0;
    for (const auto& landing : landings) {
        depleted += landing.depleted ? 1 : 0;
        gave_out += landing.gave_out ? 1 : 0;
        below += landing.gave_out || landing.final_soc_percent < reserve_percent ? 1 : 0;
    }
    const auto n = static_cast<double>(landings.size());
    const double p = static_cast<double>(below) / n;
    flights.probability_depleted = static_cast<double>(depleted) / n;
    flights.probability_gave_out = static_cast<double>(gave_out) / n;
    flights.probability_below_reserve = p;
    flights.probability_below_reserve_standard_error = std::sqrt(p * (1.0 - p) / n);
    flights.probability_below_reserve_95 = wilson_interval(p, n);
}

std::vector<SocBand> bands_of(const std::vector<Landing>& landings, const std::vector<double>& times_s) {
    std::vector<SocBand> bands;
    std::vector<double> soc_percent(landings.size());
    for (std::size_t i = 0; i < times_s.size(); ++i) {
        std::transform(landings.begin(), landings.end(), soc_percent.begin(),
                       [&](const Landing& landing) { return landing.soc_percent[i]; });
        std::sort(soc_percent.begin(), soc_percent.end());
        bands.push_back({times_s[i], quantile(soc_percent, 5.0), quantile(soc_percent, 50.0),
                         quantile(soc_percent, 95.0)});
    }
    return bands;
}

}  // namespace

SampledFlights sample_flights(const Flyable& flyable, const std::vector<Disturbance>& disturbances,
                              const SamplingOptions& options) {
    if (options.samples < 2 || static_cast<double>(options.samples) > most_samples) {
        throw UsageError(fmt::format("{} samples make no distribution; expected 2 to {:.0f}", options.samples,
                                     most_samples));
    }
    const auto spreads = spreads_of(flyable.mission);
    const Sampler sampler(flyable, disturbances, spreads, options);
    const auto landings = sampler.fly_all();
    SampledFlights flights;
    flights.mission = flyable.mission.name;
    flights.reserve_soc_percent = flyable.mission.reserve_soc_percent;
    flights.samples = options.samples;
    flights.seed = options.seed;
    flights.drawn = spreads.drawn;
    flights.not_drawn = spreads.not_drawn;
    std::vector<double> final_percent;
    final_percent.reserve(landings.size());
    for (const auto& landing : landings) final_percent.push_back(landing.final_soc_percent);
    flights.final_soc_mean_percent = mean(final_percent);
    flights.final_soc_sd_percent = sample_sd(final_percent);
    std::sort(final_percent.begin(), final_percent.end());
    for (std::size_t i = 0; i < shown_quantiles_percent.size(); ++i)
        flights.final_soc_quantiles_percent[i] = quantile(final_percent, shown_quantiles_percent[i]);
    count_landings(landings, flyable.mission.reserve_soc_percent, flights);
    flights.bands = bands_of(landings, sampler.times_s());
    return flights;
}

std::string describe(const SampledFlights& flights) {
    const auto& q = flights.final_soc_quantiles_percent;
    auto text = fmt::format(
        "{}: {} flights drawn: below the reserve of {:.6g} % with probability {:.4f} (95 % interval {:.4f} "
        "to "
        "{:.4f}), depleted {:.4f}; final state of charge {:.2f} % on average, sd {:.2f}, quantiles",
        flights.mission, flights.samples, flights.reserve_soc_percent, flights.probability_below_reserve,
        flights.probability_below_reserve_95.low, flights.probability_below_reserve_95.high,
        flights.probability_depleted, flights.final_soc_mean_percent, flights.final_soc_sd_percent);
    for (std::size_t i = 0; i < q.size(); ++i)
        text += fmt::format(" {} %: {:.2f}", shown_quantiles_percent[i], q[i]);
    text += fmt::format("; drawn: {}", fmt::join(flights.drawn, ", "));
    if (!flights.not_drawn.empty())
        text += fmt::format("; not drawn: {}", fmt::join(flights.not_drawn, ", "));
    return text;
}

std::string to_csv(const std::vector<SocBand>& bands) {
    std::string text = "time_s,soc_p05_percent,soc_p50_percent,soc_p95_percent\n";
    for (const auto& band : bands) {
        fmt::format_to(std::back_inserter(text), "{:.10g},{:.10g},{:.10g},{:.10g}\n", band.time_s,
                       band.p05_percent, band.p50_percent, band.p95_percent);
    }
    return text;
}

}  // namespace flightwatt::mission
