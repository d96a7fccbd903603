#include "mission/path_limits.h"

#include "mission/planning/planner.h"
#include "mission/sampling/landing_distribution.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double max_circles_tried = 1e4;
constexpr std::size_t rough_flights = 1250;

/// Looks for the greatest extent that keeps the reserve. Short ones may not fit the schedule.
class ExtentSearch {
  public:
    /// How well a probability is computed: a rough one is much sooner known.
    enum class Chance { rough, exact };

    ExtentSearch(const MissionForExtent& mission_of, const std::optional<double>& probability)
        : mission_of_(mission_of), probability_(probability) {}

    Mission mission(double extent) const { return with_minimum_energy_schedule(mission_of_(extent)); }

    /// What is left above the reserve; none where the schedule does not fit.
    std::optional<double> spare_percent(double extent, Chance chance = Chance::exact) {
        try {
            const auto flown = mission(extent);
            if (!probability_) return mission::surplus_percent(flown);
            require_known_spread(flown);
            const auto spreads = collect_uncertainty(flown);
            if (chance == Chance::rough)
                return draw_landings(flown, spreads, rough_flights).spare_percent(*probability_);
            const auto landings = draw_landings_until_known(flown, spreads, *probability_);
            const double spare = landings.spare_percent(*probability_);
            margins_percent_[extent] = std::max(0.0, landings.nominal_spare_percent() - spare);
            return spare;
        } catch (const InputError& error) {
            misfit_ = error;
            return std::nullopt;
        }
    }

    /// The longest that can be flown at all, to within `apart`: a leg may forbid the way back of all that lie behind
    /// it.
    std::optional<double> max_flown(double most, double apart) {
        constexpr int tried = 64;
        if (fits(most)) return most;
        double high = most;
        for (int k = tried - 1; k > 0; --k, high -= most / tried) {
            double low = most * k / tried;
            if (!fits(low)) continue;
            while (high - low > apart) {
                const double middle = std::midpoint(low, high);
                (fits(middle) ? low : high) = middle;
            }
            return low;
        }
        return std::nullopt;
    }

    /// Halves what lies between an extent that is too short or good and one that is too long, until they are `apart`.
    std::optional<double> last_good(double low, double high, double apart, Chance chance = Chance::exact) {
        std::optional<double> good;
        while (high - low > apart) {
            const double middle = apart == 1.0 ? std::floor(std::midpoint(low, high)) : std::midpoint(low, high);
            const auto spare = spare_percent(middle, chance);
            if (spare && *spare < 0.0) {
                high = middle;
            } else {
                low = middle;
                if (spare) good = middle;
            }
        }
        return good;
    }

    /// Of an extent whose exact chance was asked for.
    FeasibilityLimit limit(double extent, double beyond) const {
        const auto at = mission(extent);
        auto most = limit_at(extent, probability_ ? margins_percent_.at(extent) : 0.0, at, mission(beyond));
        if (probability_) most.sources = collect_uncertainty(at).sources;
        return most;
    }

    [[noreturn]] void refuse(const std::string& message) const {
        if (misfit_) throw *misfit_;
        throw NoResultError(message);
    }

  private:
    bool fits(double extent) {
        try {
            mission(extent);
            return true;
        } catch (const InputError& error) {
            misfit_ = error;
            return false;
        }
    }

    const MissionForExtent& mission_of_;
    std::optional<double> probability_;
    std::optional<InputError> misfit_;
    std::map<double, double> margins_percent_;
};

}  // namespace

ReachCriterion default_criterion(const FlightPath& path) {
    const bool circles = std::ranges::any_of(
        path.elements, [](const auto& element) { return std::holds_alternative<Circles>(element.shape); });
    return circles ? ReachCriterion::circles : ReachCriterion::way_back;
}

FeasibilityLimit max_circles(const MissionForExtent& mission_of, const std::optional<double>& probability) {
    ExtentSearch search(mission_of, probability);
    constexpr auto rough = ExtentSearch::Chance::rough;
    double low = 0.0;
    std::optional<double> good;
    double high = 1.0;
    while (high <= max_circles_tried) {
        const auto spare = search.spare_percent(high, rough);
        if (spare && *spare < 0.0) break;
        low = high;
        if (spare) good = high;
        high *= 2.0;
    }
    if (high > max_circles_tried) {
        if (good) throw NoResultError(fmt::format("{:.0f} circles still land with the reserve", *good));
        search.refuse("the mission does not land with its reserve");
    }
    if (const auto better = search.last_good(low, high, 1.0, rough)) good = better;
    if (!good) good = high;  // near enough to be worth an exact look
    const double roughly = *good;
    const auto is_good = [&](double circles) {
        const auto spare = search.spare_percent(circles);
        return spare && *spare >= 0.0;
    };
    while (*good > 0.0 && !is_good(*good)) *good -= 1.0;
    if (*good == 0.0) throw NoResultError("the fewest circles that fit do not land with the reserve");
    if (*good == roughly)
        while (is_good(*good + 1.0)) *good += 1.0;
    return search.limit(*good, *good + 1.0);
}

FeasibilityLimit farthest_return(const MissionForExtent& mission_of, double length_m,
                                 const std::optional<double>& probability) {
    constexpr double accuracy = 1e-9;
    constexpr double accuracy_of_chance = 1e-4;
    if (!(length_m > 0.0))
        throw NoResultError("the path has no legs to turn back on: ways that take a duration_s or a hold are none");
    ExtentSearch search(mission_of, probability);
    const double apart_m = length_m * (probability ? accuracy_of_chance : accuracy);
    const auto max_m = search.max_flown(length_m, apart_m);
    if (!max_m) search.refuse("the path cannot be flown there and back");
    const auto spare = search.spare_percent(*max_m);
    if (spare && *spare >= 0.0) return search.limit(*max_m, *max_m);
    const auto good = search.last_good(0.0, *max_m, apart_m);
    if (!good) throw NoResultError("from nowhere along the path does the mission return with its reserve");
    return search.limit(*good, std::min(*max_m, *good + apart_m));
}

Reach find_reach(const MissionLoader& mission_of, const std::optional<double>& probability) {
    const auto mission = mission_of({.allow_unplanned = true});
    const auto& cruise = setup_of(mission).cruise_path;
    if (!cruise) {
        const auto of_cruise = [&](double cruise_s) {
            return mission_of({.allow_unplanned = true, .cruise_s = cruise_s});
        };
        return {ReachUnit::cruise_s, longest_cruise(of_cruise, probability)};
    }
    const auto& path = cruise->plan->path;
    if (default_criterion(path) == ReachCriterion::circles) {
        const auto of_circles = [&](double circles) {
            return mission_of({.allow_unplanned = true, .circles = circles});
        };
        return {ReachUnit::circles, max_circles(of_circles, probability)};
    }
    const auto of_return = [&](double after_m) {
        return mission_of({.allow_unplanned = true, .return_after_m = after_m});
    };
    return {ReachUnit::return_m, farthest_return(of_return, length_of_legs_m(path), probability)};
}

}  // namespace flightwatt::mission
