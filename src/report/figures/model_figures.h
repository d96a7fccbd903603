#pragma once

#include "battery/discharge_record.h"
#include "battery/identified_battery.h"
#include "mechanical/model_fit.h"
#include "mechanical/physical_fit.h"
#include "mechanical/validation.h"
#include "report/figure.h"

#include <span>
#include <string>

/// Figures of models, their validation, and batteries.
namespace flightwatt::report {

/// Returns the figure of a mechanical model as the paper's Fig. 2, a panel a phase: curve, envelope of the flights and
/// 95 % band of the mean (a band without times is unknown).
Figure model_figure(const mechanical::MechanicalModel& model, const flight::PerPhase<mechanical::CurveBand>& bands,
                    const std::string& id);

/// Returns the figure of the errors of the energy predicted by leave-one-out: a point a flight, a row a model.
Figure validation_figure(std::span<const mechanical::ValidatedFlight> flights, const std::string& id);

/// Returns the figure of the power over airspeed in level flight with its 95 % band, the flown range, the bins less the
/// power of their climb and turns, and the best speeds with their intervals.
Figure physical_figure(const mechanical::PhysicalFit& fit, std::span<const mechanical::BinnedFlight> flights,
                       const std::string& id);

/// Returns the figure of the terminal voltage over time, measured and modelled from the current, a panel a flight.
/// `records` are those of the identification, in its order.
Figure voltage_figure(const battery::BatteryIdentification& identified,
                      std::span<const battery::DischargeRecord> records, const std::string& id);

/// Returns the figure of the open-circuit voltage over the state of charge with 95 % intervals of its knots; below the
/// flights' range it follows a chart.
Figure open_circuit_figure(const battery::BatteryIdentification& identified, const std::string& id);

}  // namespace flightwatt::report
