#pragma once

#include "cli/stage.h"
#include "mechanical/model_errors.h"
#include "mechanical/order_choice.h"

#include <nlohmann/json.hpp>

/// What a fit says of its errors, its outliers and its order.
namespace flightwatt::cli {

/// Adds errors, frequency_profile and spread to each phase of the stage's JSON.
void add_errors_json(nlohmann::ordered_json& json, const mechanical::MechanicalModel& model,
                     const flight::PerPhase<mechanical::PhaseErrorReport>& reports);

/// Adds each phase's loss and the samples that it gives less than half weight.
void add_loss_json(nlohmann::ordered_json& json, const mechanical::ModelFit& fit);

/// Adds the chosen order of a phase with the error of every order that was tried.
void add_order_json(nlohmann::ordered_json& json, flight::Phase phase, const mechanical::OrderChoice& choice);

/// Notes the chosen order and the prediction error of every order.
void note_order(const StageCall& call, flight::Phase phase, const mechanical::OrderChoice& choice);

/// Warns of intervals that are conditional on a given frequency.
void warn_of_given_frequencies(const StageCall& call, const mechanical::MechanicalModel& model);

/// Notes how many samples have less than half weight, and the three of least weight.
void note_down_weighted(const StageCall& call, const mechanical::ModelFit& fit);

}  // namespace flightwatt::cli
