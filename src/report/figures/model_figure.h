#pragma once

#include "mechanical/mechanical_model.h"
#include "mechanical/model_errors.h"
#include "report/figure.h"
#include "report/figures/published_figures.h"

#include <vector>

namespace flightwatt::report {

/// The mechanical model as the paper's Fig. 2, a panel a phase: the curve, the envelope of the flights and
/// the 95 % band of the mean, where they are known (bands of no times: unknown), and the digitised figure's
/// points where they are given.
Figure model_figure(const mechanical::MechanicalModel& model,
                    const flight::PerPhase<mechanical::CurveBand>& bands, const PublishedFigures& published,
                    const std::string& id);

}  // namespace flightwatt::report
