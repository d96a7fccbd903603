#include "live/state/path_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace flightwatt::live {
namespace {

// Chosen by what they mean; none was fitted to flights.
constexpr double course_weight = 2.0;
constexpr double off_sds = 3.5;  // from there on it is likelier that the path was left
constexpr double negligible = 1e-15;

struct Advance {
    std::ptrdiff_t places = 0;
    double chance = 0.0;
};
// In the time that a place takes as planned; off the path a flight goes on where it left it, or elsewhere.
constexpr std::array advances_on_path{Advance{0, 0.25}, Advance{1, 0.45}, Advance{2, 0.22}, Advance{3, 0.08}};
constexpr std::array advances_off_path{Advance{0, 0.7},     Advance{1, 0.2},      Advance{2, 0.07},
                                       Advance{3, 0.029},   Advance{-30, 0.0002}, Advance{30, 0.0005},
                                       Advance{100, 0.0003}};
constexpr std::size_t max_back = 30;
constexpr std::size_t max_ahead = 100;
constexpr double leaves = 0.02;
constexpr double comes_back = 0.05;

}  // namespace

PathFilter::PathFilter(const PathGrid& places) : places_(&places) {
    for (auto* of : {&on_, &off_, &next_on_}) of->resize(places.of.size());
    next_off_.resize(max_back + places.of.size() + max_ahead);
}

void PathFilter::begin(double off_path_m, const Displacement& origin) {
    off_path_m_ = off_path_m;
    origin_ = origin;
    taken_ = 0;
    known_s_ = 0.0;
    seen_on_path_s_ = 0.0;
    std::ranges::fill(on_, 0.0);
    std::ranges::fill(off_, 0.0);
    on_[0] = 1.0 - leaves;
    off_[0] = leaves;
    on_path_ = on_[0];
}

void PathFilter::add_observation(const Observation& seen) {
    if (taken_ > 0) predict_step();
    ++taken_;
    if (!seen.is_known) return;
    update_step(seen);
    known_s_ += places_->step_s;
    if (is_on_path()) seen_on_path_s_ += places_->step_s;
}

void PathFilter::predict_step() {
    std::ranges::fill(next_on_, 0.0);
    std::ranges::fill(next_off_, 0.0);
    const auto count = on_.size();
    double* const next_off = next_off_.data() + max_back;
    for (std::size_t i = 0; i < count; ++i) {
        if (off_[i] <= negligible) off_[i] = 0.0;
        next_on_[i] += off_[i] * comes_back;
        if (!(on_[i] > negligible)) continue;
        for (const auto& [places, chance] : advances_on_path) {
            const auto to = i + static_cast<std::size_t>(places_->of[i].is_unconstrained ? 1 : places);
            next_on_[std::min(to, count - 1)] += on_[i] * chance * (1.0 - leaves);
        }
        next_off[i] += on_[i] * leaves;
    }
    for (const auto& [places, chance] : advances_off_path) {
        const double part = chance * (1.0 - comes_back);
        double* const to = next_off + places;
        for (std::size_t i = 0; i < count; ++i) to[i] += off_[i] * part;
    }
    on_.swap(next_on_);
    std::copy_n(next_off, count, off_.begin());
    off_.front() += std::accumulate(next_off_.data(), next_off, 0.0);
    off_.back() += std::accumulate(next_off + count, next_off + count + max_ahead, 0.0);
    on_path_ = std::accumulate(on_.begin(), on_.end(), 0.0);
}

void PathFilter::update_step(const Observation& seen) {
    last_seen_ = seen;
    const double off_chance = std::exp(-likelihood_weight * 0.5 * off_sds * off_sds);
    double on_path = 0.0;
    double off_path = 0.0;
    for (std::size_t i = 0; i < on_.size(); ++i) {
        if (on_[i] > negligible) on_[i] *= std::exp(likelihood_weight * log_likelihood(i));
        off_[i] *= off_chance;
        on_path += on_[i];
        off_path += off_[i];
    }
    const double scale = 1.0 / (on_path + off_path);
    for (std::size_t i = 0; i < on_.size(); ++i) {
        on_[i] *= scale;
        off_[i] *= scale;
    }
    on_path_ = on_path * scale;
}

double PathFilter::log_likelihood(std::size_t i) const {
    constexpr double anywhere = -0.5;
    const auto& point = places_->of[i];
    if (point.is_unconstrained) return anywhere;
    const auto& seen = last_seen_;
    const auto off = minus(minus(seen.at, origin_), point.at);
    const bool have_courses = dot(point.course, point.course) > 0.0 && dot(seen.course, seen.course) > 0.0;
    const double turned = have_courses ? 1.0 - dot(point.course, seen.course) : 0.0;
    return -0.5 * dot(off, off) / (off_path_m_ * off_path_m_) - course_weight * turned;
}

double PathFilter::median_position() const {
    const auto& of = is_on_path() ? on_ : off_;
    const double half = 0.5 * std::accumulate(of.begin(), of.end(), 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < of.size(); ++i) {
        if (sum + of[i] >= half && of[i] > 0.0) return static_cast<double>(i) - 0.5 + (half - sum) / of[i];
        sum += of[i];
    }
    return static_cast<double>(of.size()) - 1.0;
}

double PathFilter::nearest_position() const {
    constexpr double about = 4.0;
    constexpr double prior_fraction = 0.1;
    const double middle = median_position();
    double best = -std::numeric_limits<double>::infinity();
    auto nearest = index_of(middle);
    for (std::size_t i = 0; i < on_.size(); ++i) {
        if (!(on_[i] > negligible) || std::abs(static_cast<double>(i) - middle) > about) continue;
        const double score = log_likelihood(i) + prior_fraction * std::log(on_[i]);
        if (score <= best) continue;
        best = score;
        nearest = i;
    }
    const auto& point = places_->of[nearest];
    if (point.is_unconstrained) return middle;
    const double ahead_m = dot(minus(minus(last_seen_.at, origin_), point.at), point.course);
    const auto step = minus(places_->of[std::min(nearest + 1, on_.size() - 1)].at, point.at);
    const double step_m = std::max(1.0, std::hypot(step.east_m, step.north_m));
    return static_cast<double>(nearest) + std::clamp(ahead_m / step_m, -0.5, 0.5);
}

Displacement PathFilter::off(double place) const { return minus(minus(last_seen_.at, origin_), point_of(place).at); }

const PathPoint& PathFilter::point_of(double place) const { return places_->of[index_of(place)]; }

std::size_t PathFilter::index_of(double place) const {
    const double last = static_cast<double>(on_.size()) - 1.0;
    return static_cast<std::size_t>(std::clamp(std::round(place), 0.0, last));
}

}  // namespace flightwatt::live
