#pragma once

#include "battery/discharge_record.h"
#include "battery/identified_battery.h"
#include "mechanical/model_errors.h"
#include "mechanical/physical_fit.h"
#include "mechanical/prediction.h"
#include "mechanical/validation.h"
#include "report/batch_content.h"
#include "report/figure.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The figures of flights, and of what was learnt from them: model, validation and battery.

namespace flightwatt::report {

/// Where a phase of a flight begins or ends.
struct NamedEdge {
    double time_s = 0.0;
    std::string name;
    std::string evidence;  ///< what was seen there
    std::string verdict;   ///< what the autopilot says of it
};

/// The edges of a flight's phases, each once: a phase ends where the next one begins.
std::vector<NamedEdge> edges_of(const ReportFlight& flight);

/// Altitude, throttle and power of a flight on one time axis, its phases shaded, their edges explained, and
/// the model over the power: each phase's curve stretched to the time flown. The flight was not rejected.
Figure flight_figure(const ReportFlight& flight, const std::optional<mechanical::MechanicalModel>& model,
                     const std::string& id);

/// The ground track of a flight from above, coloured by phase, metres east and north on equal scales;
/// std::nullopt where the log has no position.
std::optional<Figure> track_figure(const ReportFlight& flight, const std::string& id);

/// What flightwatt predict would have said at a moment: what was measured until then and what was to come.
struct PredictedMoment {
    double flown_s = 0.0;    ///< since lift-off
    double energy_wh = 0.0;  ///< of the whole flight
    mechanical::EnergyInterval interval;
};

/// A flight that was predicted while it cruised.
struct PredictedFlight {
    std::vector<PredictedMoment> moments;  ///< every minute of the cruise
    double measured_wh = 0.0;              ///< of the whole flight
    std::size_t others = 0;                ///< flights that the model was fitted to
};

/// What would have been predicted while the flight cruised, with its 95 % intervals, over time, and what was measured.
/// `flight` has moments.
Figure in_flight_figure(const std::string& name, const PredictedFlight& flight, const std::string& id);

/// The mechanical model as the paper's Fig. 2, a panel a phase: the curve, the envelope of the flights and
/// the 95 % band of the mean, where they are known (bands of no times: unknown), and the digitised figure's
/// points where they are given.
Figure model_figure(const mechanical::MechanicalModel& model, const flight::PerPhase<mechanical::CurveBand>& bands,
                    const PublishedFigures& published, const std::string& id);

/// How far each model's prediction of the energy of a flight that it has not seen was off: a point a flight,
/// a row a model.
Figure validation_figure(std::span<const mechanical::ValidatedFlight> flights, const std::string& id);

/// Power over airspeed: a point a stretch of a flight, coloured by its climb, and the model's power in level flight,
/// climbing and descending. `flights` have bins.
Figure physical_figure(const mechanical::PhysicalModel& model, std::span<const mechanical::BinnedFlight> flights,
                       const std::string& id);

/// Terminal voltage over time, measured and modelled, a panel a flight: the model follows from the current and the
/// charge missing at the start. `records` is not empty: those that were identified, in their order.
Figure voltage_figure(const battery::BatteryIdentification& identified,
                      std::span<const battery::DischargeRecord> records, const std::string& id);

/// The open-circuit voltage over the state of charge with the 95 % intervals of its knots, and from where on
/// the chart of LiPo cells stands in.
Figure open_circuit_figure(const battery::BatteryIdentification& identified, const std::string& id);

}  // namespace flightwatt::report
