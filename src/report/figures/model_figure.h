#pragma once

#include "mechanical/mechanical_model.h"
#include "mechanical/model_errors.h"
#include "report/figure.h"
#include "report/figures/published_figures.h"

#include <vector>

namespace flightwatt::report {

/// What is known of a model's curve over one phase, at evenly spread times.
struct CurveBand {
    std::vector<double> time_s;
    std::vector<double> low_95_w;  ///< of the weighted mean of these flights
    std::vector<double> high_95_w;
    std::vector<double> flights_low_w;  ///< envelope of the flights' own curves; empty of a single flight
    std::vector<double> flights_high_w;
};

/// The bands of a fit whose errors were analysed.
flight::PerPhase<CurveBand> curve_bands(const mechanical::ModelFit& fit,
                                        const flight::PerPhase<mechanical::PhaseErrorReport>& reports);

/// The mechanical model as the paper's Fig. 2, a panel a phase: the curve, the envelope of the flights and
/// the 95 % band of the mean, where they are known (bands of no times: unknown), and the digitised figure's
/// points where they are given.
Figure model_figure(const mechanical::MechanicalModel& model, const flight::PerPhase<CurveBand>& bands,
                    const PublishedFigures& published, const std::string& id);

}  // namespace flightwatt::report
