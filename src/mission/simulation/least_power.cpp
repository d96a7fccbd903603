#include "mission/simulation/least_power.h"

#include "base/error.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <boost/math/tools/minima.hpp>
#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double points_a_turn = 16.0;        // of the highest harmonic: one valley lies between two neighbours
constexpr double rounding_of_power_w = 1e-6;  // fits that touch 0 do not charge

/// No harmonic can be more negative than its amplitude.
double bound_below_w(const mechanical::FourierModel& curve) {
    double bound_w = curve.a0_w;
    for (std::size_t n = 0; n < curve.cos_w.size(); ++n) bound_w -= std::hypot(curve.cos_w[n], curve.sin_w[n]);
    return bound_w;
}

}  // namespace

PowerAt min_power_w(const mechanical::FourierModel& curve, const CurveInterval& within, double enough_w) {
    const double bound_w = bound_below_w(curve);
    if (bound_w >= enough_w || curve.cos_w.empty()) return {within.start_s, bound_w};
    const double length_s = within.end_s - within.start_s;
    const double turns =
        static_cast<double>(curve.cos_w.size()) * curve.omega_rad_per_s * length_s / units::rad_per_turn;
    const auto points = static_cast<std::size_t>(std::clamp(std::ceil(turns * points_a_turn), 16.0, 1e6));
    const double step_s = length_s / static_cast<double>(points);
    const auto power = [&](double time_s) { return power_w(curve, time_s); };
    PowerAt least{within.start_s, power(within.start_s)};
    for (std::size_t k = 1; k <= points; ++k) {
        const double time_s = within.start_s + static_cast<double>(k) * step_s;
        if (const double now_w = power(time_s); now_w < least.power_w) least = {time_s, now_w};
    }
    constexpr int bits = 24;
    const auto [time_s, valley_w] = boost::math::tools::brent_find_minima(
        power, std::max(within.start_s, least.time_s - step_s), std::min(within.end_s, least.time_s + step_s), bits);
    return valley_w < least.power_w ? PowerAt{time_s, valley_w} : least;
}

void refuse_charging(const MissionSetup& mission, const std::vector<LoadSegment>& segments) {
    if (mission.may_charge) return;
    for (const auto& segment : segments) {
        PowerAt least{segment.start_s - segment.phase_start_s, 0.0};
        if (segment.mechanical)
            least = min_power_w(*segment.mechanical, {least.time_s, segment.end_s - segment.phase_start_s},
                                -segment.compute_w);
        if (least.power_w + segment.compute_w >= -rounding_of_power_w) continue;
        throw InputError(
            {mission.file},
            fmt::format("{}: {:.1f} s into the {} it draws {:.4g} W ({:.4g} W mechanical, {:.4g} W computing), which "
                        "charges the battery in flight",
                        mission.name, least.time_s, to_string(segment.phase), least.power_w + segment.compute_w,
                        least.power_w, segment.compute_w),
            "a model or profile is wrong there: fit it anew (another order, flights whose power is measured right), or "
            "say may_charge = true if something aboard feeds the battery");
    }
}

}  // namespace flightwatt::mission
