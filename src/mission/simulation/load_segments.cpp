#include "mission/simulation/load_segments.h"

#include <algorithm>

namespace flightwatt::mission {
namespace {

constexpr double edge_tolerance_s = 1e-9;

/// Times at which something changes, in order, between the segment's start and its end.
std::vector<double> cuts_of(const LoadSegment& segment, const std::vector<Disturbance>& disturbances) {
    std::vector<double> cuts;
    for (const auto& disturbance : disturbances) {
        for (const double time_s : {disturbance.start_s, disturbance.end_s}) {
            if (time_s > segment.start_s + edge_tolerance_s && time_s < segment.end_s - edge_tolerance_s)
                cuts.push_back(time_s);
        }
    }
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    cuts.push_back(segment.end_s);
    return cuts;
}

void disturb_power(const Disturbance& disturbance, LoadSegment& segment) {
    segment.compute_w = segment.compute_w * disturbance.compute_factor + disturbance.compute_w;
    if (!segment.mechanical) return;
    auto& curve = *segment.mechanical;
    curve.a0_w = curve.a0_w * disturbance.mechanical_factor + disturbance.mechanical_w;
    for (auto* terms_w : {&curve.cos_w, &curve.sin_w}) {
        for (auto& term_w : *terms_w) term_w *= disturbance.mechanical_factor;
    }
}

}  // namespace

std::vector<LoadSegment> load_segments(const MissionSetup& mission,
                                       const std::vector<ScheduleSegment>& schedule) {
    const auto timeline = timeline_of(mission.duration_s);
    std::vector<LoadSegment> segments;
    for (const auto& scheduled : schedule) {
        LoadSegment segment;
        segment.phase = scheduled.phase;
        segment.phase_start_s = timeline.start_s[scheduled.phase];
        segment.start_s = segment.phase_start_s + scheduled.start_s;
        segment.end_s = segment.phase_start_s + scheduled.end_s;
        segment.compute_w = power_w(mission.compute, scheduled.run);
        if (mission.mechanical) {
            segment.mechanical = flown_model(mission.mechanical->phases[scheduled.phase],
                                             mission.duration_s[scheduled.phase], mission.phase_clock);
        }
        segments.push_back(std::move(segment));
    }
    return segments;
}

std::vector<LoadSegment> disturbed(const std::vector<LoadSegment>& segments,
                                   const std::vector<Disturbance>& disturbances) {
    std::vector<LoadSegment> result;
    result.reserve(segments.size() + 2 * disturbances.size());
    for (const auto& segment : segments) {
        double start_s = segment.start_s;
        for (const double end_s : cuts_of(segment, disturbances)) {
            result.push_back(segment);
            auto& part = result.back();
            part.start_s = start_s;
            part.end_s = end_s;
            for (const auto& disturbance : disturbances) {
                if (disturbance.start_s >= end_s - edge_tolerance_s ||
                    disturbance.end_s <= start_s + edge_tolerance_s)
                    continue;
                disturb_power(disturbance, part);
                if (disturbance.start_s >= start_s - edge_tolerance_s)
                    part.soc_drop_percent += disturbance.soc_drop_percent;
            }
            start_s = end_s;
        }
    }
    return result;
}

double mechanical_w(const LoadSegment& segment, double time_s) {
    return segment.mechanical ? power_w(*segment.mechanical, time_s - segment.phase_start_s) : 0.0;
}

double power_w(const LoadSegment& segment, double time_s) {
    return mechanical_w(segment, time_s) + segment.compute_w;
}

double mechanical_energy_j(const LoadSegment& segment, double time_s) {
    if (!segment.mechanical) return 0.0;
    return energy_j(*segment.mechanical, time_s - segment.phase_start_s) -
           energy_j(*segment.mechanical, segment.start_s - segment.phase_start_s);
}

double compute_energy_j(const LoadSegment& segment, double time_s) {
    return segment.compute_w * (time_s - segment.start_s);
}

}  // namespace flightwatt::mission
