#pragma once

#include "base/error.h"
#include "mission/feasibility_limits.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <string>

namespace flightwatt::mission {

/// Looks for the least margin above a reserve whose answer keeps the reserve with a chance. More margin, more is left.
class MarginSearch {
  public:
    explicit MarginSearch(double first_percent) : margin_percent_(first_percent) {}

    double margin_percent() const { return margin_percent_; }

    /// What the flights of the answer keep with that chance above the reserve, and what they should at most.
    void add_result(double slack_percent, double wanted_percent) {
        auto& end_percent = slack_percent >= 0.0 ? enough_percent_ : too_little_percent_;
        end_percent = margin_percent_;
        const double step = margin_per_slack(slack_percent);
        last_ = {margin_percent_, slack_percent};
        move_to(margin_percent_ + step * (wanted_percent - slack_percent));
    }

    /// The answer keeps so much, though it need not: it is that of every margin up to this one.
    void raise_lower_bound(double kept_percent) { margin_percent_ = std::max(margin_percent_, kept_percent); }

    /// There is no answer with so much.
    void mark_infeasible() {
        enough_percent_ = margin_percent_;
        move_to(std::midpoint(too_little_percent_.value_or(0.0), margin_percent_));
    }

    /// Nothing is left between what is enough and what is not.
    bool has_converged() const {
        return too_little_percent_ && enough_percent_ && *enough_percent_ - *too_little_percent_ < 1e-6;
    }

  private:
    struct Learnt {
        double margin_percent;
        double slack_percent;
    };

    /// How much more margin a point of slack takes, by the last two: chances that are not normal take more than one.
    double margin_per_slack(double slack_percent) const {
        constexpr double least = 0.5;
        constexpr double most = 8.0;
        if (!last_ || slack_percent == last_->slack_percent) return 1.0;
        const double slope = (margin_percent_ - last_->margin_percent) / (slack_percent - last_->slack_percent);
        return slope > 0.0 ? std::clamp(slope, least, most) : 1.0;
    }

    void move_to(double margin_percent) {
        margin_percent_ = margin_percent;
        if (!too_little_percent_ || !enough_percent_) return;
        if (!(margin_percent_ > *too_little_percent_ && margin_percent_ < *enough_percent_))
            margin_percent_ = std::midpoint(*too_little_percent_, *enough_percent_);
    }

    double margin_percent_;
    std::optional<Learnt> last_;
    std::optional<double> too_little_percent_;
    std::optional<double> enough_percent_;
};

/// What is left of a mission above its reserve, as one of its numbers changes; and where nothing is any more.
class LimitSearch {
  public:
    /// How well a probability is computed: a rough one is much sooner known.
    enum class Accuracy { rough, exact };

    LimitSearch(MissionVariation variation, const std::optional<double>& probability)
        : variation_(std::move(variation)), probability_(probability) {}

    /// Throws InputError where the schedule does not fit.
    Mission mission(double value) const;

    std::optional<Mission> mission_if_it_fits(double value);

    /// Why the last that did not fit the schedule does not.
    const std::optional<InputError>& misfit() const { return misfit_; }

    /// What the flight as stated has left above reserve and margin.
    double surplus(double value) const { return surplus(mission(value)); }
    double surplus(Mission changed) const;

    /// What that part of the flights which the probability asks for has left above the reserve, without one the flight
    /// as stated; none where the schedule does not fit.
    std::optional<double> drawn_surplus(double value, Accuracy accuracy = Accuracy::exact);

    /// The value, found by `find` for the margin that is set, with which the part of the flights that the probability
    /// asks for, no more and no less, keep the reserve; without one, that of the flight as stated. Where its flights
    /// fail from one value to the next, the last with which they do not.
    double find_with_margin(const std::function<double()>& find);

    /// The value as a limit, of which `beyond` is a little more. Its flights were drawn exactly.
    FeasibilityLimit limit(double value, double beyond) const;

  private:
    MissionVariation variation_;
    std::optional<double> probability_;
    double margin_percent_ = 0.0;  ///< above the reserve
    std::optional<InputError> misfit_;
    std::map<double, double> margins_percent_;  ///< that the flights of a value need
};

}  // namespace flightwatt::mission
