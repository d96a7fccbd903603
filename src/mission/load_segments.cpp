#include "mission/load_segments.h"

namespace flightwatt::mission {

std::vector<Demand> demands_of(const Mission& mission) {
    flight::PerPhase<double> begins_s;
    double time_s = 0.0;
    for (const auto phase : flight::all_phases) {
        begins_s[phase] = time_s;
        time_s += mission.duration_s[phase];
    }
    std::vector<Demand> demands;
    for (const auto& stretch : mission.schedule) {
        Demand demand;
        demand.phase = stretch.phase;
        demand.phase_begins_s = begins_s[stretch.phase];
        demand.from_s = demand.phase_begins_s + stretch.from_s;
        demand.to_s = demand.phase_begins_s + stretch.to_s;
        demand.compute_w = power_w(mission.compute, stretch.run);
        if (mission.mechanical) {
            demand.mechanical = flown_model(mission.mechanical->phases[stretch.phase],
                                            mission.duration_s[stretch.phase], mission.phase_clock);
        }
        demands.push_back(std::move(demand));
    }
    return demands;
}

double mechanical_w(const Demand& demand, double time_s) {
    return demand.mechanical ? power_w(*demand.mechanical, time_s - demand.phase_begins_s) : 0.0;
}

double power_w(const Demand& demand, double time_s) {
    return mechanical_w(demand, time_s) + demand.compute_w;
}

double mechanical_energy_j(const Demand& demand, double time_s) {
    if (!demand.mechanical) return 0.0;
    return energy_j(*demand.mechanical, time_s - demand.phase_begins_s) -
           energy_j(*demand.mechanical, demand.from_s - demand.phase_begins_s);
}

double compute_energy_j(const Demand& demand, double time_s) {
    return demand.compute_w * (time_s - demand.from_s);
}

}  // namespace flightwatt::mission
