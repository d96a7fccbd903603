#include "compute/compute_model.h"

namespace flightwatt::compute {

double power_w(const ComputeModel& model, const Configuration& configuration) {
    double power = 0.0;
    for (const auto& running : configuration) {
        power += power_w(model.components.at(running.component).profile, running.qos);
    }
    return power;
}

}  // namespace flightwatt::compute
