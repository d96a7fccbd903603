#include "mission/sampled_flights.h"

#include "base/csv.h"
#include "base/units.h"
#include "mission/plan.h"
#include "mission/sampling/flight_draws.h"
#include "mission/sampling/flight_spreads.h"
#include "mission/sampling/joint_spread.h"
#include "mission/sampling/landing_distribution.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

constexpr double max_samples = 1e7;

/// Gives a drawn flight its schedule, under disturbances and with times that are of the flight as planned.
void schedule_flight(const PreparedMission& prepared, const Disturbances& as_planned,
                     const std::vector<double>& times_s, DrawnFlight& flight) {
    const auto& planned_s = prepared.setup.duration_s;
    auto& setup = flight.setup;
    const auto disturbances = rescale_to_flown_durations(as_planned, planned_s, setup.duration_s);
    Schedule schedule;
    if (prepared.adaptive) {
        auto flown = simulate_adaptive(*prepared.adaptive, setup, disturbances);
        schedule = std::move(flown.schedule);
        if (flown.setup) setup = std::move(*flown.setup);
    } else {
        schedule = rescale_to_flown_durations(prepared.schedule, planned_s, setup.duration_s);
    }
    flight.times_s = times_s;
    for (auto& time_s : flight.times_s) time_s = rescale_to_flown_durations_s(time_s, planned_s, setup.duration_s);
    flight.segments = disturbed(load_segments(setup, schedule), disturbances, flight.times_s);
    setup.battery = apply_disturbances(std::move(setup.battery), disturbances);
}

/// Evenly over the mission.
std::vector<double> band_times_s(const MissionSetup& mission, std::size_t points) {
    const double duration_s = timeline_of(mission.duration_s).duration_s;
    std::vector<double> times_s;
    for (std::size_t i = 0; i < points; ++i)
        times_s.push_back(duration_s * static_cast<double>(i) / static_cast<double>(points - 1));
    return times_s;
}

/// Wilson's interval of a share `p` of n.
Interval wilson_interval(double p, double n) {
    const double z = normal_half_width();
    const double z2 = z * z;
    const double middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
    const double reach = z / (1.0 + z2 / n) * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n));
    // At 0 and 1 the ends are exact, except for rounding.
    return {p == 0.0 ? 0.0 : std::max(0.0, middle - reach), p == 1.0 ? 1.0 : std::min(1.0, middle + reach)};
}

void count_landings(const std::vector<FlightOutcome>& landings, MonteCarloResult& flights) {
    const auto n = static_cast<double>(landings.size());
    const auto share_of = [&](const auto& counts) {
        return static_cast<double>(std::ranges::count_if(landings, counts)) / n;
    };
    const double p =
        share_of([&](const FlightOutcome& landing) { return misses_reserve(landing, flights.reserve_soc_percent); });
    flights.probability_depleted = share_of([](const FlightOutcome& landing) { return landing.depleted; });
    flights.probability_battery_failure =
        share_of([](const FlightOutcome& landing) { return landing.battery_failure; });
    flights.probability_below_reserve = p;
    flights.probability_below_reserve_standard_error = std::sqrt(p * (1.0 - p) / n);
    flights.probability_below_reserve_95 = wilson_interval(p, n);
}

std::vector<SocBand> bands_of(const std::vector<FlightOutcome>& landings, const std::vector<double>& times_s) {
    std::vector<SocBand> bands;
    std::vector<double> soc_percent(landings.size());
    for (std::size_t i = 0; i < times_s.size(); ++i) {
        std::transform(landings.begin(), landings.end(), soc_percent.begin(),
                       [&](const FlightOutcome& landing) { return landing.soc_percent[i]; });
        std::ranges::sort(soc_percent);
        bands.push_back(
            {times_s[i], quantile(soc_percent, 0.05), quantile(soc_percent, 0.5), quantile(soc_percent, 0.95)});
    }
    return bands;
}

void require_samples(const SamplingOptions& options) {
    if (options.samples >= 2 && static_cast<double>(options.samples) <= max_samples) return;
    throw UsageError(
        fmt::format("{} samples make no distribution; expected 2 to {:.0f}", options.samples, max_samples));
}

}  // namespace

void require_known_probabilities(const MissionSetup& mission) {
    if (!has_known_probability(mission)) require_flight_variability(mission);
}

MonteCarloResult sample_flights(const PreparedMission& prepared, const Disturbances& disturbances,
                                const SamplingOptions& options) {
    require_samples(options);
    require_uncertainty(prepared.setup);
    const auto spreads = collect_uncertainty(prepared.setup);
    const auto times_s = band_times_s(prepared.setup, options.band_points);
    const auto normal_count = count_normals(prepared.setup);
    const FlightDraw draw = [&](std::size_t i, DrawnFlight& flight) {
        apply_draw(prepared.setup, spreads, draw_normals(normal_count, options.seed, i), flight.setup);
        schedule_flight(prepared, disturbances, times_s, flight);
    };
    const auto landings = fly_drawn(prepared.setup, draw, 0, options.samples);
    MonteCarloResult flights;
    flights.mission = prepared.setup.name;
    flights.reserve_soc_percent = prepared.setup.reserve_soc_percent;
    flights.samples = options.samples;
    flights.seed = options.seed;
    flights.sources = spreads.sources;
    flights.variability_is_known = has_known_probability(prepared.setup);
    std::vector<double> final_percent;
    final_percent.reserve(landings.size());
    // Charge left after a battery failure counts as 0.
    for (const auto& landing : landings)
        final_percent.push_back(landing.battery_failure ? 0.0 : landing.final_soc_percent);
    flights.final_soc_mean_percent = mean(final_percent);
    flights.final_soc_sd_percent = sample_sd(final_percent);
    std::ranges::sort(final_percent);
    for (std::size_t i = 0; i < shown_quantiles_percent.size(); ++i)
        flights.final_soc_quantiles_percent[i] =
            quantile(final_percent, units::amount_from_percent(1.0, shown_quantiles_percent[i]));
    count_landings(landings, flights);
    flights.probability_below_reserve_95 =
        interval_of_share(flights.probability_below_reserve_95, energy_degrees_of_freedom(prepared.setup, spreads));
    flights.bands = bands_of(landings, times_s);
    return flights;
}

DrawnFlights draw_flights(const MissionSetup& mission, const SamplingOptions& options) {
    require_samples(options);
    const auto spreads = collect_uncertainty(mission);
    DrawnFlights drawn{
        {}, spreads.sources, has_known_probability(mission), energy_degrees_of_freedom(mission, spreads)};
    const auto normal_count = count_normals(mission);
    auto flight = mission;
    for (std::size_t i = 0; i < options.samples; ++i) {
        apply_draw(mission, spreads, draw_normals(normal_count, options.seed, i), flight);
        auto& loads = drawn.flights.emplace_back();
        loads.battery = flight.battery;
        loads.duration_s = flight.duration_s;
        loads.is_infeasible = flight.cruise_path && flight.cruise_path->is_infeasible;
        for (const auto phase : all_phases)
            if (flight.duration_s[phase] > 0.0) loads.power_w[phase] = mean_level_w(flight, phase);
    }
    return drawn;
}

Interval share_of_new_flights_95(double share, const DrawnFlights& drawn) {
    return interval_of_share(wilson_interval(share, static_cast<double>(drawn.flights.size())),
                             drawn.degrees_of_freedom);
}

std::string describe_briefly(const MonteCarloResult& flights) {
    const auto& q = flights.final_soc_quantiles_percent;
    const auto kept = [](double missed) { return units::percentage(1.0 - missed, 1.0); };
    const auto& missed = flights.probability_below_reserve_95;
    const auto reserve = fmt::format("the reserve of {:.6g} %", flights.reserve_soc_percent);
    const auto share =
        flights.variability_is_known
            ? fmt::format("{:.4g} % keep {}, of new flights {:.4g} to {:.4g} %",
                          kept(flights.probability_below_reserve), reserve, kept(missed.high), kept(missed.low))
            : fmt::format("it is unknown how many keep {}, as nothing shows how their power differs", reserve);
    const auto band = flights.variability_is_known
                          ? fmt::format("; 90 of 100 land with {:.1f} to {:.1f} %", q.front(), q.back())
                          : std::string();
    return fmt::format("{}: of {} drawn flights {}{}; --notes: how flights differ", flights.mission, flights.samples,
                       share, band);
}

std::string describe(const MonteCarloResult& flights) {
    const auto& q = flights.final_soc_quantiles_percent;
    const double cut_off = flights.probability_battery_failure - flights.probability_depleted;
    const auto chance =
        flights.variability_is_known
            ? fmt::format("with probability {:.4f} (95 % interval {:.4f} to {:.4f}), depleted {:.4f}{}",
                          flights.probability_below_reserve, flights.probability_below_reserve_95.low,
                          flights.probability_below_reserve_95.high, flights.probability_depleted,
                          cut_off > 0.0 ? fmt::format(", cut off or too weak {:.4f} (counts as empty)", cut_off) : "")
            : std::string("with unknown probability: nothing shows how the power of flights differs");
    auto text = fmt::format("{}: {} flights drawn: below the reserve of {:.6g} % {}", flights.mission, flights.samples,
                            flights.reserve_soc_percent, chance);
    if (flights.variability_is_known) {
        text += fmt::format("; final state of charge {:.2f} % on average, sd {:.2f}, quantiles",
                            flights.final_soc_mean_percent, flights.final_soc_sd_percent);
        for (std::size_t i = 0; i < q.size(); ++i)
            text += fmt::format(" {} %: {:.2f}", shown_quantiles_percent[i], q[i]);
    }
    return text + "; " + describe(flights.sources);
}

std::string to_csv(const std::vector<SocBand>& bands) {
    constexpr int digits = 10;
    CsvWriter csv({"time_s", "soc_p05_percent", "soc_p50_percent", "soc_p95_percent"}, digits);
    for (const auto& band : bands) csv.add(band.time_s, band.p05_percent, band.p50_percent, band.p95_percent);
    return csv.text();
}

}  // namespace flightwatt::mission
