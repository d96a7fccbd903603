#pragma once

#include "report/document/quality_of_service.h"
#include "report/figure.h"

#include <string>

/// Figures for papers from the parts of a document (web/app/src/documents.ts).
namespace flightwatt::report {

/// Returns the figure of a flight with power: altitude, throttle and power over time, with phases, edges and the model's
/// curve of each phase. `detail` is its FlightDetail.
Figure flight_figure(const std::string& flight, const VegaJson& detail, const std::string& id);

/// Returns the figure of a ModelDocument as the paper's Fig. 2, a panel a phase: curve, envelope of the flights and 95 %
/// band of the mean.
Figure model_figure(const VegaJson& model, const std::string& id);

/// Returns the figure of a PhysicalDocument: the power over airspeed in level flight with its 95 % band, the flown range,
/// the bins less the power of their climb and turns, and the best speeds with their intervals.
Figure physical_figure(const VegaJson& physical, const std::string& id);

/// Returns the figure of a ValidationDocument: the errors of the energy by leave-one-out, a point a flight, a row a
/// model.
Figure validation_figure(const VegaJson& validation, const std::string& id);

/// Returns the figure of a BatteryDocument's terminal voltages over time, a panel a flight.
Figure voltage_figure(const VegaJson& battery, const std::string& id);

/// Returns the figure of a BatteryDocument's open-circuit voltage over the state of charge with 95 % intervals of its
/// knots.
Figure open_circuit_figure(const VegaJson& battery, const std::string& id);

/// Returns the figure of a SoftwareProfile: power over the first parameter, a panel a component, a line for each value of
/// the others.
Figure profile_figure(const VegaJson& software, const std::string& id);

/// Returns the figure of the state of charge over time of a list of MissionDocument as the paper's Fig. 3, with the
/// phases that all have in common; below, the schedules, coloured by power. `missions` is not empty.
Figure schedule_figure(const VegaJson& missions, const std::string& id);

/// Returns the figure of a map as the paper's Fig. 4: a cell has the mean of its corners.
Figure quality_figure(const QosMap& map, const std::string& id);

/// Returns the figure of the known trends of one aircraft in a TrendsDocument.
Figure trends_figure(const VegaJson& trends, const std::string& aircraft, const std::string& id);

}  // namespace flightwatt::report
