#include "mission/sampled_flights.h"

#include "base/csv.h"
#include "base/units.h"
#include "mission/plan.h"
#include "mission/sampling/flight_draws.h"
#include "mission/sampling/landing_distribution.h"

#include <algorithm>
#include <cmath>
#include <functional>

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
    const auto schedule = prepared.adaptive
                              ? simulate_adaptive(*prepared.adaptive, setup, disturbances).schedule
                              : rescale_to_flown_durations(prepared.schedule, planned_s, setup.duration_s);
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

/// What two missions are compared by, of one drawn flight.
struct FlownQuantities {
    double duration_s = 0.0;
    double mechanical_energy_wh = 0.0;
    double compute_energy_wh = 0.0;
    double energy_wh = 0.0;
    double final_soc_percent = 0.0;
};

/// Of flights of one of them, each by the numbers that `normals_of` gives it.
std::vector<FlownQuantities> fly_compared(const PreparedMission& prepared, const FlightUncertainty& spreads,
                                          std::size_t count,
                                          const std::function<std::vector<double>(std::size_t)>& normals_of) {
    std::vector<FlownQuantities> flown(count);
    const FlightDraw draw = [&](std::size_t i, DrawnFlight& flight) {
        apply_draw(prepared.setup, spreads, normals_of(i), flight.setup);
        schedule_flight(prepared, {}, {}, flight);
        for (const auto& segment : flight.segments) {
            flown[i].mechanical_energy_wh += units::wh_from_joule(mechanical_energy_j(segment, segment.end_s));
            flown[i].compute_energy_wh += units::wh_from_joule(compute_energy_j(segment, segment.end_s));
        }
        flown[i].duration_s = timeline_of(flight.setup.duration_s).duration_s;
        flown[i].energy_wh = flown[i].mechanical_energy_wh + flown[i].compute_energy_wh;
    };
    const auto landings = fly_drawn(prepared.setup, draw, 0, count);
    for (std::size_t i = 0; i < count; ++i)
        flown[i].final_soc_percent = landings[i].battery_failure ? 0.0 : landings[i].final_soc_percent;
    return flown;
}

Interval middle_95(std::vector<double> values) {
    std::ranges::sort(values);
    return {quantile(values, 0.025), quantile(values, 0.975)};
}

DrawnIntervals intervals_of(const std::vector<FlownQuantities>& of_a, const std::vector<FlownQuantities>& of_b,
                            double FlownQuantities::*quantity) {
    std::vector<double> a;
    std::vector<double> b;
    std::vector<double> difference;
    for (std::size_t i = 0; i < of_a.size(); ++i) {
        a.push_back(of_a[i].*quantity);
        b.push_back(of_b[i].*quantity);
        difference.push_back(b.back() - a.back());
    }
    return {middle_95(a), middle_95(b), middle_95(difference)};
}

/// Names the sources that vary jointly in both missions and those that vary independently.
void name_sources(const MissionSetup& a, const MissionSetup& b, const CommonSources& common,
                  SampledDifference& difference) {
    const auto add = [&](bool is_shared, const std::string& name) {
        (is_shared ? difference.shared_sources : difference.independent_sources).push_back(name);
    };
    if (a.mechanical || b.mechanical) add(common.mechanical, "mechanical model");
    add(common.battery, "battery");
    for (std::size_t i = 0; i < common.components.size(); ++i)
        add(common.components[i].has_value(), b.compute.components[i].name);
    if (a.cruise_path && b.cruise_path) add(true, "wind");
    if (a.uncertainty.initial_soc_sd_percent > 0.0 && b.uncertainty.initial_soc_sd_percent > 0.0)
        add(true, "initial charge");
}

}  // namespace

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
    flights.bands = bands_of(landings, times_s);
    return flights;
}

std::optional<SampledDifference> sample_difference(const PreparedMission& a, const PreparedMission& b,
                                                   const SamplingOptions& options) {
    require_samples(options);
    const auto spreads_a = collect_uncertainty(a.setup);
    const auto spreads_b = collect_uncertainty(b.setup);
    if (spreads_a.sources.varied.empty() || spreads_b.sources.varied.empty()) return std::nullopt;
    const auto common = common_sources(a.setup, b.setup);
    const auto other_seed = ~options.seed;  // of sources that are not common
    const auto normals_of_a = [&](std::size_t i) { return draw_normals(count_normals(a.setup), options.seed, i); };
    const auto of_a = fly_compared(a, spreads_a, options.samples, normals_of_a);
    const auto of_b = fly_compared(b, spreads_b, options.samples, [&](std::size_t i) {
        return correlated_normals(a.setup, b.setup, common, normals_of_a(i),
                                  draw_normals(count_normals(b.setup), other_seed, i));
    });
    SampledDifference difference;
    difference.samples = options.samples;
    difference.duration_s = intervals_of(of_a, of_b, &FlownQuantities::duration_s);
    difference.mechanical_energy_wh = intervals_of(of_a, of_b, &FlownQuantities::mechanical_energy_wh);
    difference.compute_energy_wh = intervals_of(of_a, of_b, &FlownQuantities::compute_energy_wh);
    difference.energy_wh = intervals_of(of_a, of_b, &FlownQuantities::energy_wh);
    difference.final_soc_percent = intervals_of(of_a, of_b, &FlownQuantities::final_soc_percent);
    difference.sources_a = spreads_a.sources;
    difference.sources_b = spreads_b.sources;
    name_sources(a.setup, b.setup, common, difference);
    return difference;
}

std::string describe(const SampledDifference& difference) {
    const auto list = [](const char* what, const std::vector<std::string>& names) {
        return names.empty() ? "" : fmt::format("; {}: {}", what, fmt::join(names, ", "));
    };
    const auto a = describe(difference.sources_a);
    const auto b = describe(difference.sources_b);
    return fmt::format("intervals hold 95 in 100 of {} flights drawn for both{}{}; {}", difference.samples,
                       list("varying jointly in both", difference.shared_sources),
                       list("varying independently in each", difference.independent_sources),
                       a == b ? a : fmt::format("a: {}; b: {}", a, b));
}

std::string describe(const MonteCarloResult& flights) {
    const auto& q = flights.final_soc_quantiles_percent;
    const double cut_off = flights.probability_battery_failure - flights.probability_depleted;
    auto text = fmt::format(
        "{}: {} flights drawn: below the reserve of {:.6g} % with probability {:.4f} (95 % interval {:.4f} "
        "to {:.4f}), depleted {:.4f}{}; final state of charge {:.2f} % on average, sd {:.2f}, quantiles",
        flights.mission, flights.samples, flights.reserve_soc_percent, flights.probability_below_reserve,
        flights.probability_below_reserve_95.low, flights.probability_below_reserve_95.high,
        flights.probability_depleted,
        cut_off > 0.0 ? fmt::format(", cut off or too weak {:.4f} (counts as empty)", cut_off) : "",
        flights.final_soc_mean_percent, flights.final_soc_sd_percent);
    for (std::size_t i = 0; i < q.size(); ++i) text += fmt::format(" {} %: {:.2f}", shown_quantiles_percent[i], q[i]);
    return text + "; " + describe(flights.sources);
}

std::string to_csv(const std::vector<SocBand>& bands) {
    constexpr int digits = 10;
    CsvWriter csv({"time_s", "soc_p05_percent", "soc_p50_percent", "soc_p95_percent"}, digits);
    for (const auto& band : bands) csv.add(band.time_s, band.p05_percent, band.p50_percent, band.p95_percent);
    return csv.text();
}

}  // namespace flightwatt::mission
