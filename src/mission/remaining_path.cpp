#include "mission/remaining_path.h"

#include <algorithm>
#include <limits>

namespace flightwatt::mission {

PathPlace place_at(const FlownPath& flown, double time_s) {
    double start_s = 0.0;
    for (std::size_t i = 0; i < flown.element_s.size(); ++i) {
        const double element_s = flown.element_s[i];
        if (time_s < start_s + element_s) return {i, std::max(time_s - start_s, 0.0) / element_s};
        start_s += element_s;
    }
    return {flown.element_s.size(), 0.0};
}

FlownPath rest_from(const FlownPath& flown, const PathPlace& place) {
    FlownPath rest;
    rest.element_s = flown.element_s;
    rest.blown = flown.blown;
    double skipped_s = 0.0;
    for (std::size_t i = 0; i < flown.element_s.size(); ++i) {
        const double part = i < place.element ? 1.0 : i == place.element ? place.part : 0.0;
        skipped_s += part * flown.element_s[i];
        rest.element_s[i] *= 1.0 - part;
    }
    for (auto piece : flown.pieces) {
        const double here_s = std::min(skipped_s, piece.time_s);
        skipped_s -= here_s;
        piece.time_s -= here_s;
        if (!(piece.time_s > 0.0)) continue;
        rest.duration_s += piece.time_s;
        rest.pieces.push_back(piece);
    }
    return rest;
}

RemainingPath predict_rest_of_path(const PathPlan& plan, const mechanical::FlightProgress& flown,
                                   const PathPlace& place) {
    const auto predict_in = [&](const Wind& wind) {
        const auto ahead = rest_from(fly_path(plan.path, wind, ForbiddenLeg::crawl), place);
        const auto cruise = predict_rest_by_motion(plan.power, flown, mean_terms(ahead), ahead.duration_s);
        return RemainingPath{cruise, ahead.duration_s};
    };
    auto rest = predict_in(plan.wind);
    const auto add_wind_share = [&](double Wind::*what, double sd) {
        if (!(sd > 0.0)) return;
        auto more = plan.wind;
        auto less = plan.wind;
        more.*what += sd;
        less.*what -= sd;
        const double sd_wh =
            0.5 * (predict_in(more).cruise.energy.energy_wh - predict_in(less).cruise.energy.energy_wh);
        add_share(rest.cruise.energy, {sd_wh * sd_wh, std::numeric_limits<double>::infinity()});
    };
    add_wind_share(&Wind::speed_m_per_s, plan.wind.speed_sd_m_per_s);
    add_wind_share(&Wind::from_deg, plan.wind.direction_sd_deg);
    return rest;
}

}  // namespace flightwatt::mission
