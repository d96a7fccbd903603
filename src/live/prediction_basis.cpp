#include "live/prediction_basis.h"

#include "base/error.h"
#include "mission/sampled_flights.h"

#include <memory>
#include <utility>

namespace flightwatt::live {
namespace {

/// Throws InputError where the model does not allow a prediction.
void require_predicting(const PredictionInput& basis, const std::string& file) {
    if (basis.path)
        require_physical(basis.model, file, "--mission");
    else
        require_interval(basis.model, flight::Phase::cruise, file);
    if (basis.landing_s > 0.0) require_interval(basis.model, flight::Phase::landing, file);
}

/// Model and path, or time, of a mission.
PredictionInput basis_of(const mission::MissionSetup& setup) {
    PredictionInput basis{setup.mechanical.value(), {}, setup.duration_s[flight::Phase::landing]};
    basis.limits = {setup.cutoff_voltage_v, setup.reserve_soc_percent};
    if (setup.cruise_path) {
        basis.path = std::make_shared<const mission::PathForecast>(*setup.cruise_path->plan);
        basis.model.physical = basis.path->plan().power;  // where the model has but a law of airspeed, that
    } else {
        basis.cruise_s = setup.duration_s[flight::Phase::cruise];
    }
    return basis;
}

/// The mission's own battery; and where a schedule is all that the mission can tell, that and why.
void add_mission_battery(const mission::MissionSetup& setup, const std::string& file, PredictionInput& basis) {
    basis.battery = setup.battery;
    basis.battery->intervals.capacity_ah = capacity_interval_ah(setup);
    basis.battery_file = file;
    if (!setup.battery.thevenin) basis.initial_soc_percent = setup.initial_soc_percent;
    try {
        require_predicting(basis, file);
    } catch (const InputError& error) {
        basis.no_prediction_reason = error.what();
    }
}

}  // namespace

PredictionInput input_from_mission(const mission::MissionSetup& setup, const std::string& file) {
    auto basis = basis_of(setup);
    add_mission_battery(setup, file, basis);
    return basis;
}

PredictionInput path_input_from_mission(const mission::MissionSetup& setup, const std::string& file) {
    auto basis = basis_of(setup);
    require_predicting(basis, file);
    return basis;
}

PredictionInput input_from_model(mechanical::MechanicalModel model, const std::string& file, double remaining_s) {
    PredictionInput basis;
    for (const auto phase : {flight::Phase::cruise, flight::Phase::landing}) require_interval(model, phase, file);
    basis.model = std::move(model);
    basis.remaining_s = remaining_s;
    basis.landing_s = basis.model.phases[flight::Phase::landing].duration_s;
    return basis;
}

}  // namespace flightwatt::live
