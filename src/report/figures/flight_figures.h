#pragma once

#include "mechanical/mechanical_model.h"
#include "report/batch_content.h"
#include "report/figure.h"

#include <string>
#include <vector>

namespace flightwatt::report {

/// An edge of a phase.
struct NamedEdge {
    double time_s = 0.0;
    std::string name;
    std::string evidence;
};

/// The edges of a flight's phases; the common edge of two phases once.
std::vector<NamedEdge> name_edges(const ReportFlight& flight);

/// Altitude, throttle and power of an accepted flight over time, with phases, edges and the model's curve of each
/// phase, scaled to its duration.
Figure flight_figure(const ReportFlight& flight, const mechanical::MechanicalModel* model, const std::string& id);

}  // namespace flightwatt::report
