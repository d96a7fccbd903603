#include "mission/sampling/flight_lines.h"

#include "base/parallel.h"
#include "base/statistics.h"
#include "mission/sampling/flight_outcome.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/QR>
#include <boost/math/constants/constants.hpp>

namespace flightwatt::mission {
namespace {

constexpr std::uint64_t seed_of_lines = 0x6c696e6573;
constexpr std::uint64_t seed_of_flights = 0x666c6967687473;
constexpr std::size_t first_lines = 64;
constexpr double resolution = 1e-4;          ///< of a threshold [deviations]: 3e-6 of a chance of 0.01
constexpr double tolerance_fraction = 1e-4;  ///< of the deviation of what is left
constexpr int max_rounds = 60;

double density(double deviations) {
    return std::exp(-deviations * deviations / 2.0) / boost::math::constants::root_two_pi<double>();
}

double inner_product(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Of the flights of a line that were flown, those that keep `evaluations` with the next that do not beside them.
struct KeptFlights {
    double fails_before = -max_deviation;
    double first = 0.0;
    double last = 0.0;
    double fails_behind = max_deviation;
};

std::optional<KeptFlights> kept_flights(const LineSearch& line, double left_percent) {
    std::optional<KeptFlights> kept;
    double fails_before = -max_deviation;
    for (const auto& [at, left] : line.evaluations) {
        if (left > left_percent) {
            if (!kept) kept = {fails_before, at, at, max_deviation};
            kept->last = at;
            kept->fails_behind = max_deviation;
        } else {
            fails_before = at;
            if (kept && kept->fails_behind == max_deviation) kept->fails_behind = at;
        }
    }
    return kept;
}

}  // namespace

LineSampler::LineSampler(const Mission& mission, const FlightUncertainty& spreads)
    : spreads_(spreads),
      setup_(without_model_metadata(mission)),
      schedule_(mission.schedule),
      lanes_(setup_, spreads_, schedule_),
      important_direction_(count_normals(mission)) {
    stated_percent_ = left_percent_of(important_direction_);
    std::vector<std::size_t> numbers(important_direction_.size());
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    important_direction_ = lost_percent_along(numbers);
    find_scale();
    set_direction(important_direction_);
}

/// What one deviation of each of these numbers costs, by central differences.
std::vector<double> LineSampler::lost_percent_along(const std::vector<std::size_t>& numbers) const {
    std::vector<std::vector<double>> flights;
    for (const auto number : numbers) {
        for (const double side : {1.0, -1.0}) flights.emplace_back(important_direction_.size())[number] = side;
    }
    const auto left_percent = left_percent_of_all(flights);
    std::vector<double> lost_percent;
    for (std::size_t k = 0; k < numbers.size(); ++k)
        lost_percent.push_back((left_percent[2 * k + 1] - left_percent[2 * k]) / 2.0);
    return lost_percent;
}

/// Of the differences: how widely the flights are spread, and what is drawn together turned to where they lose most.
void LineSampler::find_scale() {
    double square_sum = inner_product(important_direction_, important_direction_);
    double square_per_freedom = 0.0;
    for (auto& joint : spreads_.of_flights) {
        Eigen::VectorXd lost_percent(static_cast<Eigen::Index>(joint.quantities.size()));
        for (std::size_t k = 0; k < joint.quantities.size(); ++k) {
            std::vector<double> normals(joint.quantities.size());
            normals[k] = 1.0;
            double& worse = important_direction_[joint.quantities[k]];
            lost_percent(static_cast<Eigen::Index>(k)) = worse / student_vector(normals, joint.degrees_of_freedom)[k];
            square_sum -= worse * worse;
        }
        const double square = lost_percent.squaredNorm();
        square_sum += square;
        square_per_freedom += square * square / joint.degrees_of_freedom;
        if (square == 0.0) continue;
        const Eigen::MatrixXd turn = lost_percent.householderQr().householderQ();
        joint.factor = (joint.factor * turn).eval();
        const auto turned_percent = lost_percent_along(joint.quantities);
        for (std::size_t k = 0; k < joint.quantities.size(); ++k)
            important_direction_[joint.quantities[k]] = turned_percent[k];
    }
    constexpr double of_rounding = 1e-9;
    sd_percent_ = std::sqrt(std::max(square_sum, 0.0));
    if (sd_percent_ < of_rounding) sd_percent_ = 0.0;
    if (square_per_freedom > 0.0) degrees_of_freedom_ = square_sum * square_sum / square_per_freedom;
}

void LineSampler::count(std::span<const double> left_percent) const {
    flown_ += left_percent.size();
    if (std::ranges::any_of(left_percent, [](double percent) { return percent < 0.0; })) some_fail_ = true;
}

double LineSampler::left_percent_of(std::span<const double> normals) const {
    const double left_percent = lanes_.simulate_scalar(normals).remaining_percent;
    count({&left_percent, 1});
    return left_percent;
}

/// Side by side, and so not to the last digit as the same alone (flight_lanes.h).
std::vector<double> LineSampler::left_percent_of_all(std::span<const std::vector<double>> normals) const {
    std::vector<FlightOutcome> landings(normals.size());
    lanes_.simulate(normals, landings);
    std::vector<double> left_percent;
    left_percent.reserve(landings.size());
    for (const auto& landing : landings) left_percent.push_back(landing.remaining_percent);
    count(left_percent);
    return left_percent;
}

void LineSampler::simulate_random(std::size_t from, std::span<double> left_percent) const {
    constexpr std::size_t at_once = 256;
    for_each_in_parallel((left_percent.size() + at_once - 1) / at_once, [&](std::size_t block) {
        const auto own =
            left_percent.subspan(block * at_once).first(std::min(at_once, left_percent.size() - block * at_once));
        std::vector<std::vector<double>> normals;
        for (std::size_t i = 0; i < own.size(); ++i)
            normals.push_back(draw_normals(important_direction_.size(), seed_of_flights, from + block * at_once + i));
        std::ranges::copy(left_percent_of_all(normals), own.begin());
    });
}

void LineSampler::set_direction(std::vector<double> direction) {
    const double length = std::sqrt(inner_product(direction, direction));
    if (!(length > 0.0)) return;
    for (auto& part : direction) part /= length;
    important_direction_ = std::move(direction);
}

/// Neighbours mirror each other.
std::vector<double> LineSampler::across_of(std::size_t line) const {
    auto across = draw_normals(important_direction_.size(), seed_of_lines, line / 2);
    const double along = inner_product(across, important_direction_);
    const double sign = line % 2 == 0 ? 1.0 : -1.0;
    for (std::size_t k = 0; k < across.size(); ++k) across[k] = sign * (across[k] - along * important_direction_[k]);
    return across;
}

double LineSampler::fly(double at, LineSearch& search) const {
    auto normals = search.offset;
    for (std::size_t k = 0; k < normals.size(); ++k) normals[k] += at * important_direction_[k];
    return search.evaluations[at] = left_percent_of(normals);
}

double LineSampler::linear_threshold(double at, double spare_percent) const {
    return normal_from_student(student_from_normal(at, degrees_of_freedom_) + spare_percent / sd_percent_,
                               degrees_of_freedom_);
}

/// Flies until one flight keeps `evaluations`; false if the line seems to have none. The first steps go by the slope;
/// where flights fail at once it tells nothing, and the next go out from the middle.
bool LineSampler::find_kept(double left_percent, LineSearch& search) const {
    constexpr std::array beyond_slope{0.0, -0.2};  // deviations
    constexpr std::array from_the_middle{0.0, -1.0, 1.0, -2.0, 2.0, -3.0, 3.0};
    constexpr double least = -4.0;  // further out, what is drawn together is far out too
    for (const double beyond : beyond_slope) {
        if (kept_flights(search, left_percent)) return true;
        double& at = search.threshold;
        if (search.evaluations.contains(at)) break;
        at = std::max(least, beyond + linear_threshold(at, fly(at, search) - left_percent));
    }
    for (const double at : from_the_middle) {
        if (kept_flights(search, left_percent)) return true;
        if (!search.evaluations.contains(at)) fly(at, search);
    }
    return kept_flights(search, left_percent).has_value();
}

void LineSampler::find_thresholds(std::size_t line, double left_percent, LineSearch& search) const {
    const double kept_percent = left_percent - tolerance_fraction * sd_percent_;
    if (search.offset.empty()) search.offset = across_of(line);
    search.better_threshold = -max_deviation;
    if (!find_kept(kept_percent, search)) {
        search.threshold = -max_deviation;
        return;
    }
    find_worse_threshold(left_percent, search);
    find_better_threshold(kept_percent, search);
}

/// From a line's last flight that keeps `evaluations`.
void LineSampler::find_worse_threshold(double left_percent, LineSearch& search) const {
    const double tolerance_percent = tolerance_fraction * sd_percent_;
    const auto kept = kept_flights(search, left_percent - tolerance_percent).value();
    double above = kept.last;
    double below = kept.fails_behind;
    double& at = search.threshold;
    double spare_percent = search.evaluations.at(above) - left_percent;
    if (!(at > above && at < below)) at = linear_threshold(above, spare_percent);
    for (int round = 0; round < max_rounds && below - above > resolution; ++round) {
        if (std::abs(spare_percent) <= tolerance_percent) break;
        const bool is_slow = round % 4 == 3 && below < max_deviation;  // at a jump
        if (!(at > above && at < below) || is_slow) at = std::midpoint(above, below);
        spare_percent = fly(at, search) - left_percent;
        (spare_percent > 0.0 ? above : below) = at;
        if (std::abs(spare_percent) > tolerance_percent) at = linear_threshold(at, spare_percent);
    }
    at = std::clamp(at, above, below);
}

/// From its first, by bisection: most lines have none.
void LineSampler::find_better_threshold(double left_percent, LineSearch& search) const {
    constexpr double far_enough = -4.25;        // one of 100,000 flights lies beyond
    constexpr double chance_resolution = 1e-5;  // as much
    const auto known = kept_flights(search, left_percent).value();
    double below = known.fails_before;
    double above = known.first;
    if (above <= far_enough) return;
    if (below < far_enough) {
        if (fly(far_enough, search) > left_percent) return;
        below = far_enough;
    }
    while (normal_tail_probability(-above) - normal_tail_probability(-below) > chance_resolution) {
        const double at = std::midpoint(below, above);
        (fly(at, search) > left_percent ? above : below) = at;
    }
    search.better_threshold = below;
}

void LineSampler::redirect_to_failures(const std::vector<LineSearch>& searches) {
    std::vector<double> sum(important_direction_.size());
    for (const auto& search : searches) {
        const double along = density(search.threshold) - density(search.better_threshold);
        for (std::size_t k = 0; k < sum.size(); ++k)
            sum[k] += line_failure_probability(search) * search.offset[k] + along * important_direction_[k];
    }
    set_direction(std::move(sum));
}

double line_failure_probability(const LineSearch& line) {
    return normal_tail_probability(line.threshold) + normal_tail_probability(-line.better_threshold);
}

LineSamplingEstimate::LineSamplingEstimate(const LineSampler& lines, double left_percent)
    : lines_(&lines),
      left_percent_(left_percent),
      searches_(first_lines, {normal_from_student((lines.nominal_percent() - left_percent) / lines.sd_percent(),
                                                  lines.degrees_of_freedom())}) {
    solve(0);
}

void LineSamplingEstimate::double_lines() {
    const auto before = searches_.size();
    const double sum = std::accumulate(searches_.begin(), searches_.end(), 0.0,
                                       [](double so_far, const auto& search) { return so_far + search.threshold; });
    searches_.resize(2 * before, {.threshold = sum / static_cast<double>(before)});
    solve(before);
}

void LineSamplingEstimate::move_to(double left_percent) {
    const double freedom = lines_->degrees_of_freedom();
    const double further = (left_percent_ - left_percent) / lines_->sd_percent();
    for (auto& search : searches_)
        search.threshold = normal_from_student(student_from_normal(search.threshold, freedom) + further, freedom);
    left_percent_ = left_percent;
    solve(0);
}

double LineSamplingEstimate::chance() const { return mean(of_pairs()); }

double LineSamplingEstimate::standard_error() const {
    const auto chances = of_pairs();
    return sample_sd(chances) / std::sqrt(static_cast<double>(chances.size()));
}

void LineSamplingEstimate::solve(std::size_t from) {
    for_each_in_parallel(searches_.size() - from,
                         [&](std::size_t i) { lines_->find_thresholds(from + i, left_percent_, searches_[from + i]); });
}

std::vector<double> LineSamplingEstimate::of_pairs() const {
    std::vector<double> chances;
    for (std::size_t i = 0; i + 1 < searches_.size(); i += 2)
        chances.push_back((line_failure_probability(searches_[i]) + line_failure_probability(searches_[i + 1])) / 2.0);
    return chances;
}

}  // namespace flightwatt::mission
