#pragma once

#include "base/parallel.h"
#include "mechanical/measured_flight.h"
#include "mechanical/model_fit.h"
#include "mechanical/prediction.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// Prediction of a hold-out flight by one model.
struct FlightPrediction {
    std::string model;
    flight::PerPhase<std::optional<EnergyEstimate>> phases;  ///< with what was flown of them
    std::optional<EnergyEstimate> total = {};                ///< none: their sum, as if they were independent
    /// Of "fourier" and "constant_mean" for whole flights: mean square of the samples' deviations from the prediction.
    flight::PerPhase<std::optional<double>> square_error_w2 = {};
};

struct ValidatedFlight {
    std::string flight;
    flight::PerPhase<std::optional<double>> measured_wh;  ///< phases that were predicted
    flight::PerPhase<std::optional<double>> counter_wh;
    std::vector<FlightPrediction> predictions;
    double flown_wh = 0.0;  ///< before the prediction
    double total_wh = 0.0;  ///< measured, of these phases and those flown before; 0 without FlightPrediction::total
};

/// Of more flights than this, groups are left out together (make_folds).
inline constexpr std::size_t max_validation_folds = 40;

/// Throws UsageError for a flight that is given twice.
void require_distinct(std::span<const MeasuredFlight> flights);

/// Excludes each flight in turn (or each of `max_folds` groups), fits the others and predicts the energy of its phases
/// from their durations and, by "physical", their motion (docs/guide.md, validate). Of a flight with `flown` the
/// rest is predicted, also by "in_flight", "in_flight_constant" and "in_flight_physical".
/// `progress` gets the numbers of done and of all folds, from one thread at a time. Throws NoResultError for fewer than
/// 2 flights, and as fit_phase_model.
std::vector<ValidatedFlight> leave_one_out(std::span<const MeasuredFlight> flights, const ModelFitOptions& options = {},
                                           const Progress& progress = {}, std::size_t max_folds = max_validation_folds);

/// Errors of one model over the flights, in one phase or in the whole.
struct ModelScore {
    std::size_t flights = 0;
    double mean_absolute_error_wh = 0.0;
    std::optional<double> mean_absolute_error_percent;       ///< of the measured energy; none for landing
    std::optional<double> mean_absolute_error_rest_percent;  ///< of the energy not flown yet; only of the whole
    double bias_wh = 0.0;                                    ///< mean of predicted - measured
    std::optional<double> coverage_95;  ///< fraction of the flights within the interval; none if one has no interval
};

/// The phase's score, or the whole flight's without a phase: the sum over the phases that were predicted.
/// std::nullopt if the model predicted it for none of the flights, or not for all that another predicted.
std::optional<ModelScore> score_of(std::span<const ValidatedFlight> flights, const std::string& model,
                                   std::optional<flight::Phase> phase);

/// A flight's measured and predicted energy in a phase, or in the whole; std::nullopt where it was not predicted.
struct PredictedEnergy {
    double measured_wh = 0.0;
    EnergyEstimate estimate;
};
std::optional<PredictedEnergy> predicted_energy(const ValidatedFlight& flight, const std::string& model,
                                                std::optional<flight::Phase> phase);

/// Removes the predictions of the physical model from all flights if its error is greater than the mean power's, over
/// the flights that it predicts as a whole. Returns the reason; empty: not removed.
std::string remove_rejected(std::vector<ValidatedFlight>& flights);

/// Decides what predicts each phase of a fitted model (PhaseModel::power), the only place that does. The curve does
/// where three flights or more have samples all over the phase, and on flights left out its energies are as near as
/// those of the mean power (or 5 % farther, which a few flights cannot distinguish) and the power over time is nearer.
/// Else the mean power does, and the drift is about it. `flights` are the model's, in its order; `validated` some of
/// them, left out.
void decide_power(MechanicalModel& model, std::span<const MeasuredFlight> flights,
                  std::span<const ValidatedFlight> validated);

/// The scores of the models that missions can use, each over the flights whose three phases it predicts, without those
/// that remove_rejected removes; of a decided model whose phases differ also "by_phase". std::nullopt where curve or
/// mean power has none.
std::optional<ModelValidation> validation_of(std::vector<ValidatedFlight> flights, const MechanicalModel& model);

/// Returns the flights by which a model is validated: of more than max_validation_folds that many, evenly from all.
std::vector<MeasuredFlight> validated_flights(std::span<const MeasuredFlight> flights);

/// Decides what predicts the phases of a fitted model, and adds its validation, and the physical model if it has none
/// and the flights determine it: it answers what another airspeed, wind or payload costs, also where the mean predicts
/// plain flights as well. Of more than max_validation_folds flights that many are validated, evenly from all. A single
/// flight, or folds that cannot be fitted, have no validation.
void add_best_power(MechanicalModel& model, std::span<const MeasuredFlight> flights, const ModelFitOptions& options,
                    const Progress& progress = {});

/// The models that predicted anything, in the order in which they are shown.
std::vector<std::string> model_names(std::span<const ValidatedFlight> flights);

}  // namespace flightwatt::mechanical
