#include "mechanical/mechanical_model.h"

#include <cmath>

namespace flightwatt::mechanical {

std::string_view to_string(FrequencyBound bound) {
    return bound == FrequencyBound::low ? "low" : bound == FrequencyBound::high ? "high" : "none";
}

double power_w(const FourierModel& model, double time_s) {
    double power = model.a0_w;
    for (std::size_t n = 0; n < model.cos_w.size(); ++n) {
        const double angle = static_cast<double>(n + 1) * model.omega_rad_per_s * time_s;
        power += model.cos_w[n] * std::cos(angle) + model.sin_w[n] * std::sin(angle);
    }
    return power;
}

double energy_j(const FourierModel& model, double time_s) {
    double energy = model.a0_w * time_s;
    for (std::size_t n = 0; n < model.cos_w.size(); ++n) {
        const double omega = static_cast<double>(n + 1) * model.omega_rad_per_s;
        // 1 - cos(x) = 2 sin^2(x/2), without cancellation
        const double half = std::sin(omega * time_s / 2.0);
        energy += (model.cos_w[n] * std::sin(omega * time_s) + model.sin_w[n] * 2.0 * half * half) / omega;
    }
    return energy;
}

FourierModel flown_model(const PhaseModel& phase, double flown_s, PhaseClock clock) {
    FourierModel flown = phase.fourier;
    if (clock == PhaseClock::stretched) flown.omega_rad_per_s *= phase.duration_s / flown_s;
    return flown;
}

}  // namespace flightwatt::mechanical
