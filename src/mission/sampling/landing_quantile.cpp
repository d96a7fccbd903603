#include "mission/sampling/landing_quantile.h"

#include "base/statistics.h"
#include "mission/sampling/flight_lines.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

namespace flightwatt::mission {
namespace {

constexpr std::size_t max_lines = 512;
constexpr std::size_t min_lines_if_some_fail = 256;  ///< a few lines may miss where flights fail
constexpr std::size_t max_flights = 20000;
constexpr int max_turns = 3;
constexpr double standard_error_fraction = 0.1;  ///< of that of so many flights:
constexpr double compared_flights = 20000.0;
constexpr double far_in_standard_errors = 4.0;

/// The Student t below which lies `chance`.
double student_below(double chance, double degrees_of_freedom) {
    constexpr double min_chance = 1e-15;
    return student_from_normal(normal_quantile(std::clamp(chance, min_chance, 1.0 - min_chance)), degrees_of_freedom);
}

double exact_enough(double wanted) {
    return standard_error_fraction * std::sqrt(wanted * (1.0 - wanted) / compared_flights);
}

void require_probability(double probability) {
    if (!(probability >= 0.5 && probability < 1.0))
        throw std::invalid_argument("landing_quantile: the probability is not from 0.5 to below 1");
}

/// Moves to the state of charge that is missed with just `wanted`; at a jump, to where it is less.
void move_to_chance(double wanted, const LineSampler& lines, LineSamplingEstimate& below) {
    constexpr double tolerance = 1e-3;  // of the chance
    constexpr int max_rounds = 60;
    const double sd_percent = lines.sd_percent();
    const double freedom = lines.degrees_of_freedom();
    const double wanted_student = student_below(wanted, freedom);
    std::optional<double> seldom_percent;
    std::optional<double> often_percent;
    for (int round = 0; round < max_rounds && lines.flown() < max_flights; ++round) {
        const double chance = below.chance();
        if (std::abs(chance - wanted) <= tolerance * wanted) return;
        const double at_percent = below.left_percent();
        (chance < wanted ? seldom_percent : often_percent) = at_percent;
        if (seldom_percent && often_percent && *often_percent - *seldom_percent < 1e-6 * sd_percent) break;
        double next_percent = at_percent + sd_percent * (wanted_student - student_below(chance, freedom));
        if (seldom_percent && often_percent &&
            (!(next_percent > *seldom_percent && next_percent < *often_percent) || round % 4 == 3))
            next_percent = std::midpoint(*seldom_percent, *often_percent);
        below.move_to(next_percent);
    }
    if (seldom_percent) below.move_to(*seldom_percent);
}

/// The chance to be left with less than `left_percent` along lines that have turned to where that happens, for as long
/// as turning helps and `is_known` says that the chance is not known.
template <typename IsKnown>
LineSamplingEstimate turned(LineSampler& lines, double left_percent, const IsKnown& is_known) {
    LineSamplingEstimate below(lines, left_percent);
    for (int turn = 0; turn < max_turns && !is_known(below); ++turn) {
        const double before = below.standard_error();
        lines.redirect_to_failures(below.searches());
        below = LineSamplingEstimate(lines, left_percent);
        if (below.standard_error() > before / 2.0) break;
    }
    return below;
}

/// Whether lines will tell a chance no better than as many flights drawn at random: their direction may hold little of
/// why flights fail at once.
bool are_lines_poor(const LineSampler& lines, const LineSamplingEstimate& below, double wanted) {
    if (!lines.some_fail()) return false;
    const double times_flights = static_cast<double>(max_flights) / static_cast<double>(lines.flown());
    const double times_lines = static_cast<double>(max_lines) / static_cast<double>(below.lines());
    const double chance = std::clamp(below.chance(), wanted, 0.5);
    return below.standard_error() / std::sqrt(std::max(1.0, std::min(times_flights, times_lines))) >
           std::sqrt(chance * (1.0 - chance) / static_cast<double>(max_flights));
}

/// What so many flights are left with, from flight number `from` on.
void draw_until(std::size_t flights, const LineSampler& lines, std::vector<double>& left_percent) {
    const auto from = left_percent.size();
    left_percent.resize(flights);
    lines.simulate_random(from, std::span(left_percent).subspan(from));
}

/// By flights drawn at random, as many as tell on which side of `wanted` the chance is, or all.
void find_by_drawn_flights(const LineSampler& lines, double left_percent, double wanted, FailureProbability& result) {
    constexpr std::size_t first_flights = 1250;
    std::vector<double> drawn_percent;
    for (std::size_t flights = first_flights; flights <= max_flights; flights *= 2) {
        draw_until(flights, lines, drawn_percent);
        const auto falls_below = [&](double percent) { return percent < left_percent; };
        const double below = static_cast<double>(std::ranges::count_if(drawn_percent, falls_below));
        const double all = static_cast<double>(flights);
        result.below = below / all;
        result.resolution = 1.0 / all;
        const double likely = (below + 1.0) / (all + 2.0);  // none of a few is not never
        result.standard_error = std::sqrt(likely * (1.0 - likely) / all);
        if (std::abs(result.below - wanted) > far_in_standard_errors * result.standard_error) return;
    }
}

/// The quantile of all that are drawn.
double drawn_quantile(const LineSampler& lines, double wanted) {
    std::vector<double> drawn_percent;
    draw_until(max_flights, lines, drawn_percent);
    const auto seldom = drawn_percent.begin() + static_cast<std::ptrdiff_t>(wanted * static_cast<double>(max_flights));
    std::ranges::nth_element(drawn_percent, seldom);
    return *seldom;
}

}  // namespace

double FailureProbability::spare_percent(double probability) const {
    if (sd_percent == 0.0) return stated_spare_percent;
    return sd_percent *
           (student_below(1.0 - probability, degrees_of_freedom) - student_below(below, degrees_of_freedom));
}

namespace {

/// With at most so many lines; `is_known(below, wanted, lines)` says when the chance is known.
template <typename IsKnown>
FailureProbability chance_of(const Mission& mission, const FlightUncertainty& spreads, double probability,
                             std::size_t max_lines_flown, const IsKnown& is_known_of) {
    require_probability(probability);
    LineSampler lines(mission, spreads);
    FailureProbability result;
    result.sd_percent = lines.sd_percent();
    result.degrees_of_freedom = lines.degrees_of_freedom();
    result.stated_spare_percent = lines.nominal_percent() - mission.reserve_soc_percent;
    result.below = result.stated_spare_percent < 0.0 ? 1.0 : 0.0;
    if (result.sd_percent == 0.0) return result;
    const double wanted = 1.0 - probability;
    const auto is_known = [&](const LineSamplingEstimate& below) { return is_known_of(below, wanted, lines); };
    auto below = turned(lines, mission.reserve_soc_percent, is_known);
    if (!is_known(below) && are_lines_poor(lines, below, wanted)) {
        find_by_drawn_flights(lines, mission.reserve_soc_percent, wanted, result);
        return result;
    }
    while (!is_known(below) && below.lines() < max_lines_flown && lines.flown() < max_flights) below.double_lines();
    result.below = below.chance();
    result.standard_error = below.standard_error();
    return result;
}

}  // namespace

FailureProbability failure_probability(const Mission& mission, const FlightUncertainty& spreads, double probability) {
    const auto is_known = [](const LineSamplingEstimate& below, double wanted, const LineSampler& lines) {
        const double error = below.standard_error();
        const double above_wanted = below.chance() - wanted;
        if (above_wanted > far_in_standard_errors * error) return true;
        if (lines.some_fail() && below.lines() < min_lines_if_some_fail) return false;
        return error <= exact_enough(wanted) || (lines.some_fail() && -above_wanted > far_in_standard_errors * error);
    };
    return chance_of(mission, spreads, probability, max_lines, is_known);
}

FailureProbability approximate_failure_probability(const Mission& mission, const FlightUncertainty& spreads,
                                                   double probability) {
    constexpr std::size_t few_lines = 128;
    const auto is_known = [](const LineSamplingEstimate& below, double wanted, const LineSampler&) {
        return std::abs(below.chance() - wanted) > far_in_standard_errors * below.standard_error();
    };
    return chance_of(mission, spreads, probability, few_lines, is_known);
}

LandingQuantile landing_quantile(const Mission& mission, const FlightUncertainty& spreads, double probability) {
    require_probability(probability);
    LineSampler lines(mission, spreads);
    LandingQuantile quantile{lines.nominal_percent(), 0.0, lines.sd_percent()};
    if (quantile.sd_percent == 0.0) return quantile;
    const double wanted = 1.0 - probability;
    const auto is_exact = [&](const LineSamplingEstimate& below) {
        return below.standard_error() <= exact_enough(wanted);
    };
    const double first_percent =
        lines.nominal_percent() + student_below(wanted, lines.degrees_of_freedom()) * quantile.sd_percent;
    LineSamplingEstimate first(lines, first_percent);
    move_to_chance(wanted, lines, first);
    auto below = turned(lines, first.left_percent(), is_exact);
    if (!is_exact(below) && are_lines_poor(lines, below, wanted)) {
        quantile.left_percent = drawn_quantile(lines, wanted);
    } else {
        for (;;) {
            move_to_chance(wanted, lines, below);
            if (is_exact(below) || below.lines() >= max_lines || lines.flown() >= max_flights) break;
            below.double_lines();
        }
        quantile.left_percent = below.left_percent();
    }
    quantile.margin_percent = lines.nominal_percent() - quantile.left_percent;
    return quantile;
}

}  // namespace flightwatt::mission
