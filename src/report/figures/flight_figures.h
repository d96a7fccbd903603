#pragma once

#include "mechanical/mechanical_model.h"
#include "report/batch_content.h"
#include "report/figure.h"

#include <string>
#include <vector>

namespace flightwatt::report {

/// An edge of a phase with its name and evidence.
struct NamedEdge {
    double time_s = 0.0;
    std::string name;
    std::string evidence;
};

/// Returns the edges of a flight's phases; the common edge of two phases once.
std::vector<NamedEdge> name_edges(const ReportFlight& flight);

/// Returns the figure of an accepted flight: altitude, throttle and power over time, with phases, edges and the model's
/// curve of each phase, scaled to its duration. `model` may be null.
Figure flight_figure(const ReportFlight& flight, const mechanical::MechanicalModel* model, const std::string& id);

}  // namespace flightwatt::report
