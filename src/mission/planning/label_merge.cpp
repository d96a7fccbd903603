#include "mission/planning/label_merge.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace flightwatt::mission {
namespace {

constexpr std::size_t max_compared = 32;  // labels before one in the order of charge, to become one with

/// Utilities by keys, of which none is less than another one's with both less key and less utility.
class UtilityFront {
  public:
    /// Whether something with as much key has as much utility, or nearly.
    bool dominates(double key, double utility, double as_good) const {
        const auto found = utility_by_key_.lower_bound(key);
        return found != utility_by_key_.end() && found->second + as_good >= utility;
    }

    void add(double key, double utility) {
        auto at = utility_by_key_.insert_or_assign(key, utility).first;
        while (at != utility_by_key_.begin() && std::prev(at)->second <= utility) utility_by_key_.erase(std::prev(at));
    }

  private:
    std::map<double, double> utility_by_key_;
};

double joining_costs(const StateLabel& into, const StateLabel& label, const MergeWeights& weights) {
    return weights.utility_per_percent * weights.rc_joined *
           std::abs(into.state.rc_voltage_v - label.state.rc_voltage_v);
}

/// The state of `into` becomes one that is no worse than either.
void join(const StateLabel& label, const MergeWeights& weights, StateLabel& into) {
    auto& state = into.state;
    const auto& other = label.state;
    const double rc_v = std::min(state.rc_voltage_v, other.rc_voltage_v);
    state.soc_percent = std::max(state.soc_percent - weights.rc_low * (state.rc_voltage_v - rc_v),
                                 other.soc_percent - weights.rc_low * (other.rc_voltage_v - rc_v));
    state.rc_voltage_v = rc_v;
    into.utility = std::max(into.utility, label.utility);
}

}  // namespace

std::vector<StateLabel> merge_labels(const std::vector<StateLabel>& labels, const MergeWeights& weights,
                                     double tolerance) {
    std::vector<StateLabel> kept;
    std::vector<double> utility_as_kept;
    UtilityFront front;
    for (const auto& label : labels) {
        const double key = std::isfinite(weights.rc_high)
                               ? label.state.soc_percent - weights.rc_high * label.state.rc_voltage_v
                               : -label.state.rc_voltage_v;
        if (front.dominates(key, label.utility, weights.utility_tolerance)) continue;
        const std::size_t first = kept.size() > max_compared ? kept.size() - max_compared : 0;
        std::size_t at = kept.size();
        while (at > first && (label.utility > utility_as_kept[at - 1] + tolerance ||
                              joining_costs(kept[at - 1], label, weights) > tolerance))
            --at;
        if (at > first) {
            join(label, weights, kept[at - 1]);
            continue;
        }
        front.add(key, label.utility);
        kept.push_back(label);
        utility_as_kept.push_back(label.utility);
    }
    return kept;
}

}  // namespace flightwatt::mission
