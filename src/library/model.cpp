#include "base/atomic_file.h"
#include "flight/load_flight.h"
#include "mechanical/measured_flight.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/model_fit.h"
#include "mechanical/validation.h"

#include <utility>

#include <flightwatt/model.h>

namespace flightwatt {
namespace {

/// Returns the phase with the curve or the constant that predicts it.
mechanical::PhaseModel predicting_phase(const Model& model, Phase phase) {
    return mechanical::with_decided_power(model.parts()).phases[static_cast<flight::Phase>(phase)];
}

}  // namespace

Model::Model(std::shared_ptr<const mechanical::MechanicalModel> model) : model_(std::move(model)) {}

Model fit_model(const std::vector<Log>& logs) {
    std::vector<mechanical::MeasuredFlight> measured;
    for (const auto& log : logs)
        for (auto& flight : mechanical::extract_flights(log.loaded()).flights) measured.push_back(std::move(flight));
    exclude_hover(measured);
    std::vector<mechanical::FlightSamples> samples;
    samples.reserve(measured.size());
    for (const auto& flight : measured) samples.push_back(flight.samples);
    const mechanical::ModelFitOptions options;
    auto model = mechanical::fit_model(samples, options).model;
    mechanical::add_best_power(model, measured, options);
    return Model(std::make_shared<const mechanical::MechanicalModel>(std::move(model)));
}

Model read_model(const std::filesystem::path& file) {
    return Model(std::make_shared<const mechanical::MechanicalModel>(mechanical::read_mechanical_model(file)));
}

void write_model(const Model& model, const std::filesystem::path& file) {
    write_file_atomically(file, to_toml(model.parts()));
}

double duration_s(const Model& model, Phase phase) {
    return model.parts().phases[static_cast<flight::Phase>(phase)].duration_s;
}

double power_w(const Model& model, Phase phase, double time_s) {
    return mechanical::power_w(predicting_phase(model, phase).fourier, time_s);
}

double mean_power_w(const Model& model, Phase phase) {
    return mechanical::mean_power_w(predicting_phase(model, phase));
}

bool has_curve(const Model& model, Phase phase) { return !predicting_phase(model, phase).fourier.cos_w.empty(); }

}  // namespace flightwatt
