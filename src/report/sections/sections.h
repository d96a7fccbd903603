#pragma once

#include "base/text_table.h"
#include "batch/batch_fit.h"
#include "battery/identification.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/model_errors.h"
#include "mechanical/validation.h"
#include "mission/mission.h"
#include "mission/replay.h"
#include "report/batch_content.h"
#include "report/figure.h"
#include "report/html.h"
#include "report/sections/simulated_mission.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// A flight, or a part of it, that is not used.
struct Exclusion {
    std::string flight;
    std::string from;  ///< "from the model"
    std::string reason;
};

/// A row for each reason, with its flights.
TextTable exclusions_table(std::span<const Exclusion> exclusions);

/// The battery, as identified from the flights.
struct ReportBattery {
    std::vector<battery::DischargeRecord> records;  ///< of the flights used
    std::vector<Exclusion> exclusions;
    std::vector<std::string> notes;  ///< pack changes within a log, counter resets
    std::size_t usable = 0;          ///< usable flights; more than records where their number is limited
    std::optional<battery::BatteryIdentification> identified;
    std::vector<battery::LeaveOneOutCheck> leave_one_out;  ///< one a record, or empty
    std::string no_result_reason;                          ///< of missing results
};

/// Identifies the battery from the flights with measured current and voltage, `max_flights` at equal steps; with the
/// capacity and cells of the first pack of the missions that is of these flights. Throws UsageError as
/// identify_battery, and for another capacity than that pack's.
ReportBattery identify_for_report(std::span<const ReportFlight> flights, const battery::IdentificationOptions& options,
                                  std::size_t max_flights, std::span<const mission::MissionVariant> missions = {});

/// Parameters with intervals, voltages, errors of leave-one-out, open-circuit curve; or the reason for no battery.
Section battery_section(const ReportBattery& battery);

/// A table with a row for each sortie, exclusions, and a part for each flight, with the model of the batch.
Section flights_section(const BatchContent& batch, const Progress& progress = {});

/// A mechanical model for a section.
struct ReportModel {
    mechanical::MechanicalModel model;
    std::string origin;                                  ///< "Fitted to these flights."
    flight::PerPhase<mechanical::CurveBand> bands = {};  ///< without times: unknown
    std::optional<TextTable> table_one = {};
};

/// The model as Fig. 2 with Table I.
Section model_section(const ReportModel& model, const PublishedFigures& published, const std::string& id);

/// Errors of predictions by leave-one-out, compared with the baselines. `flights` is not empty; a warning is for
/// `synthetic` ones.
Section validation_section(const std::vector<mechanical::ValidatedFlight>& flights, bool synthetic = false);

/// Power from airspeed and climb: figure, constants and trials. std::nullopt where it cannot be fitted.
std::optional<Section> physical_section(std::span<const mechanical::MeasuredFlight> flights);

/// Each mechanical model that is not in `shown` and each software once, schedules as Fig. 3 with the ranking, maps over
/// the quality of service as Fig. 4, and plans. `missions` is not empty.
std::vector<Section> mission_sections(std::span<const SimulatedMission> missions, const PublishedFigures& published,
                                      std::span<const mechanical::MechanicalModel> shown = {});

/// Schedules of planned missions. No figures without one.
Section plan_section(std::span<const SimulatedMission> missions);

/// Schedules of missions on the flights' measured power. `replays` is not empty.
Section replay_section(std::span<const mission::Replay> replays);

/// Contents of the first section.
struct PageSummary {
    std::vector<SimulatedMission> missions;
    std::vector<MissionAssessment> answers;  ///< one a mission
    std::vector<mechanical::ValidatedFlight> validated;
    std::vector<std::string> warnings;  ///< of the fits
    std::vector<std::string> notes;     ///< missing parts of the page, with reasons
};

/// A card for each mission; a line for each aircraft and the validated model; warnings. `flights` may be empty.
Section summary_section(const PageSummary& answers, std::span<const ReportFlight> flights);

/// "20 Faulty: 3 flights, 1 h 6 min in the air, 26.1 Wh" of each aircraft, with SYNTHETIC.
std::vector<std::string> aircraft_lines(std::span<const ReportFlight> flights);

/// Whether any of the accepted flights is synthetic.
bool any_synthetic(std::span<const ReportFlight> flights);

/// Mean errors of the models by leave-one-out, the best first; empty without any.
std::string prediction_line(std::span<const mechanical::ValidatedFlight> validated, bool synthetic);

/// `html` as zlib's deflate (RFC 1950) in base64 (RFC 4648), which the page opens by DecompressionStream("deflate").
std::string compressed_block(std::string_view html);

/// A specification with its inline CSV tables as {"packed": [[name, decimals, [first, step, step ...]], [name, [text,
/// text ...]]]}: a step leads to the next number, in units of the last decimal; null is an empty cell. unpacked() in
/// web/blocks.js makes the same rows. Named datasets are kept.
VegaJson packed_tables(VegaJson spec);

}  // namespace flightwatt::report
