#pragma once

#include "flightwatt/flight.h"
#include "flightwatt/log.h"

#include <filesystem>
#include <memory>
#include <vector>

/// Power models: what an aircraft needs in take-off, cruise and landing.
///
/// fit_model() fits a third-order Fourier series to the power of each phase over all flights, with one frequency
/// (docs/methods.md), and decides by leave-one-out whether the curve or the mean predicts a phase. write_model() and
/// read_model() use the file of `flightwatt fit`.
///
///     const auto model = flightwatt::fit_model(flightwatt::read_logs({"1.bin", "2.bin", "3.bin"}));
///     std::printf("%.1f W in cruise\n", flightwatt::mean_power_w(model, flightwatt::Phase::cruise));
///     flightwatt::write_model(model, "model.toml");
namespace flightwatt {

namespace mechanical {
struct MechanicalModel;
}

/// A power model. Copies are cheap and share the data, which does not change.
class Model {
  public:
    explicit Model(std::shared_ptr<const mechanical::MechanicalModel> model);

    const mechanical::MechanicalModel& parts() const { return *model_; }  ///< Returns what the other functions read.

  private:
    std::shared_ptr<const mechanical::MechanicalModel> model_;
};

/// Fits the flights of logs, of one aircraft. Logs whose power is not to be used (Log::exclusion) and incomplete phases
/// are left out. Throws if a phase is in none of the flights, or a flight is given twice.
Model fit_model(const std::vector<Log>& logs);

Model read_model(const std::filesystem::path& file);                      ///< Reads a model's file.
void write_model(const Model& model, const std::filesystem::path& file);  ///< Writes a model's file as a whole.

/// Returns the duration [s] of a phase, the weighted mean of the flights.
double duration_s(const Model& model, Phase phase);
/// Returns the power [W] at a time since the phase began: of the curve, or the mean where that predicts better.
double power_w(const Model& model, Phase phase, double time_s);
/// Returns the mean power [W] of a phase over its duration.
double mean_power_w(const Model& model, Phase phase);
/// Returns whether the Fourier curve predicts a phase; false: its mean does.
bool has_curve(const Model& model, Phase phase);

}  // namespace flightwatt
