#include "mission/sampling/landing_quantile.h"

#include "base/statistics.h"
#include "mission/sampling/flown_landing.h"
#include "mission/sampling/workers.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <boost/math/constants/constants.hpp>

namespace flightwatt::mission {
namespace {

constexpr std::uint64_t seed_of_lines = 0x6c696e6573;
constexpr std::size_t first_lines = 32;
constexpr std::size_t most_lines = 1024;
constexpr double standard_error_part = 0.1;  ///< of that of so many flights:
constexpr double compared_flights = 20000.0;
constexpr double furthest = 9.0;  ///< deviations: beyond, nothing is as probable as 1e-18
constexpr int most_rounds = 60;

double chance_beyond(double deviations) {
    return 0.5 * std::erfc(deviations / boost::math::constants::root_two<double>());
}

/// The flights of a mission as functions of their normal numbers.
class Flights {
  public:
    Flights(const Mission& mission, const FlightSpreads& spreads)
        : spreads_(spreads),
          setup_(without_evidence(mission)),
          schedule_(mission.schedule),
          numbers_(count_normals(mission)) {}

    std::size_t numbers() const { return numbers_; }

    double left_percent(std::span<const double> normals) const {
        const auto flight = flight_of(setup_, spreads_, normals);
        const auto schedule = rescale_to_flown_durations(schedule_, setup_.duration_s, flight.duration_s);
        return land({flight, flight.battery, load_segments(flight, schedule)}).left_percent;
    }

  private:
    const FlightSpreads& spreads_;
    MissionSetup setup_;
    const Schedule& schedule_;
    std::size_t numbers_;
};

/// Lines of flights, each from the best to the worst: parallel to where flights lose most, and so far beside each other
/// as normal numbers are.
class FlightLines {
  public:
    explicit FlightLines(const Flights& flights)
        : flights_(flights), worse_(flights.numbers()), stated_percent_(flights.left_percent(worse_)) {
        for_each_index(worse_.size(), [&](std::size_t k) {
            std::vector<double> normals(worse_.size());
            normals[k] = 1.0;
            worse_[k] = -flights_.left_percent(normals);
            normals[k] = -1.0;
            worse_[k] = (worse_[k] + flights_.left_percent(normals)) / 2.0;
        });
        sd_percent_ = std::sqrt(std::inner_product(worse_.begin(), worse_.end(), worse_.begin(), 0.0));
        if (sd_percent_ > 0.0)
            for (auto& part : worse_) part /= sd_percent_;
    }

    double stated_percent() const { return stated_percent_; }
    double sd_percent() const { return sd_percent_; }

    /// Where a line falls below `left_percent` [deviations].
    double threshold(std::size_t line, double left_percent, double guess) const {
        const auto across = across_of(line);
        std::vector<double> normals(across.size());
        double above = -furthest;
        double below = furthest;
        double at = std::clamp(guess, above, below);
        for (int round = 0; round < most_rounds && below - above > 1e-6; ++round) {
            for (std::size_t k = 0; k < normals.size(); ++k) normals[k] = across[k] + at * worse_[k];
            const double spare_percent = flights_.left_percent(normals) - left_percent;
            if (std::abs(spare_percent) <= 1e-4 * sd_percent_) return at;
            (spare_percent > 0.0 ? above : below) = at;
            at += spare_percent / sd_percent_;
            const bool is_slow = round % 4 == 3 && above > -furthest && below < furthest;  // at a jump
            if (!(at > above && at < below) || is_slow) at = std::midpoint(above, below);
        }
        return at;
    }

  private:
    /// Neighbours mirror each other.
    std::vector<double> across_of(std::size_t line) const {
        auto across = draw_normals(worse_.size(), seed_of_lines, line / 2);
        const double along = std::inner_product(across.begin(), across.end(), worse_.begin(), 0.0);
        const double sign = line % 2 == 0 ? 1.0 : -1.0;
        for (std::size_t k = 0; k < across.size(); ++k) across[k] = sign * (across[k] - along * worse_[k]);
        return across;
    }

    const Flights& flights_;
    std::vector<double> worse_;  ///< the direction, of length 1
    double stated_percent_;
    double sd_percent_ = 0.0;
};

/// The chance to be left with less than some state of charge, over the lines so far.
class ChanceBelow {
  public:
    ChanceBelow(const FlightLines& lines, double left_percent) : lines_(lines), left_percent_(left_percent) {
        add_lines(first_lines);
    }

    std::size_t lines() const { return thresholds_.size(); }
    double left_percent() const { return left_percent_; }

    void add_lines(std::size_t count) {
        const auto before = thresholds_.size();
        const double guess =
            before > 0 ? mean(thresholds_) : (lines_.stated_percent() - left_percent_) / lines_.sd_percent();
        thresholds_.resize(before + count, guess);
        solve(before);
    }

    void move_to(double left_percent) {
        for (auto& at : thresholds_) at += (left_percent_ - left_percent) / lines_.sd_percent();
        left_percent_ = left_percent;
        solve(0);
    }

    double chance() const { return mean(of_pairs()); }
    double standard_error() const {
        const auto chances = of_pairs();
        return sample_sd(chances) / std::sqrt(static_cast<double>(chances.size()));
    }

  private:
    void solve(std::size_t from) {
        for_each_index(thresholds_.size() - from, [&](std::size_t i) {
            thresholds_[from + i] = lines_.threshold(from + i, left_percent_, thresholds_[from + i]);
        });
    }
    std::vector<double> of_pairs() const {
        std::vector<double> chances;
        for (std::size_t i = 0; i + 1 < thresholds_.size(); i += 2)
            chances.push_back((chance_beyond(thresholds_[i]) + chance_beyond(thresholds_[i + 1])) / 2.0);
        return chances;
    }

    const FlightLines& lines_;
    double left_percent_;
    std::vector<double> thresholds_;
};

/// Moves to the state of charge that is missed with just `wanted`; at a jump, to where it is less.
void move_to_chance(double wanted, double sd_percent, ChanceBelow& below) {
    constexpr double tolerance = 1e-3;  // of the chance
    constexpr double least_chance = 1e-15;
    const double wanted_deviations = normal_quantile(wanted);
    std::optional<double> seldom_percent;
    std::optional<double> often_percent;
    for (int round = 0; round < most_rounds; ++round) {
        const double chance = below.chance();
        if (std::abs(chance - wanted) <= tolerance * wanted) return;
        const double at_percent = below.left_percent();
        (chance < wanted ? seldom_percent : often_percent) = at_percent;
        if (seldom_percent && often_percent && *often_percent - *seldom_percent < 1e-6 * sd_percent) break;
        const double deviations = normal_quantile(std::clamp(chance, least_chance, 1.0 - least_chance));
        double next_percent = at_percent + sd_percent * (wanted_deviations - deviations);
        if (seldom_percent && often_percent &&
            (!(next_percent > *seldom_percent && next_percent < *often_percent) || round % 4 == 3))
            next_percent = std::midpoint(*seldom_percent, *often_percent);
        below.move_to(next_percent);
    }
    if (seldom_percent) below.move_to(*seldom_percent);
}

}  // namespace

LandingQuantile landing_quantile(const Mission& mission, const FlightSpreads& spreads, double probability) {
    if (!(probability >= 0.5 && probability < 1.0))
        throw std::invalid_argument("landing_quantile: the probability is not from 0.5 to below 1");
    const Flights flights(mission, spreads);
    const FlightLines lines(flights);
    LandingQuantile quantile{lines.stated_percent(), 0.0, lines.sd_percent()};
    if (quantile.sd_percent == 0.0) return quantile;
    const double wanted = 1.0 - probability;
    const double enough = standard_error_part * std::sqrt(wanted * probability / compared_flights);
    ChanceBelow below(lines, lines.stated_percent() + normal_quantile(wanted) * quantile.sd_percent);
    for (;;) {
        move_to_chance(wanted, quantile.sd_percent, below);
        if (below.standard_error() <= enough || below.lines() >= most_lines) break;
        below.add_lines(below.lines());
    }
    quantile.left_percent = below.left_percent();
    quantile.margin_percent = lines.stated_percent() - quantile.left_percent;
    return quantile;
}

}  // namespace flightwatt::mission
