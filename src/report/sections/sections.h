#pragma once

#include "base/text_table.h"
#include "batch/batch_fit.h"
#include "battery/identification.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/model_fit.h"
#include "mechanical/validation.h"
#include "mission/packs.h"
#include "mission/replay.h"
#include "report/batch_content.h"
#include "report/figure.h"
#include "report/html.h"
#include "report/outline.h"
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
Section model_section(const ReportModel& model, const std::string& id);

/// Errors of predictions by leave-one-out, compared with the baselines. `flights` is not empty; a warning is for
/// `synthetic` ones.
Section validation_section(const std::vector<mechanical::ValidatedFlight>& flights, bool synthetic = false);

/// Power from airspeed and climb: figure, constants and trials. std::nullopt where it cannot be fitted.
std::optional<Section> physical_section(std::span<const mechanical::MeasuredFlight> flights);

/// Each mechanical model that is not in `shown` and each software once, schedules as Fig. 3 with the ranking, maps over
/// the quality of service as Fig. 4. `missions` is not empty.
std::vector<Section> mission_sections(std::span<const SimulatedMission> missions,
                                      std::span<const mechanical::MechanicalModel> shown = {});

/// Missions over several packs: a row for each flight.
Section packs_section(std::span<const mission::PackFlights> missions);

/// Schedules of missions on the flights' measured power. `replays` is not empty.
Section replay_section(std::span<const mission::Replay> replays);

/// Contents of the first section.
struct PageSummary {
    std::vector<SimulatedMission> missions;  ///< the worst first
    std::vector<MissionAssessment> answers;  ///< one a mission
    std::vector<mechanical::ValidatedFlight> validated;
    std::optional<mechanical::MechanicalModel> model;  ///< the batch's
    std::optional<battery::BatteryIdentification> pack;
    std::vector<std::string> warnings;  ///< of the fits
    std::vector<std::string> notes;     ///< missing parts of the page, with reasons
};

/// The first screen: headline, a card for each mission (one is shown), their table, and the aircraft.
/// `flights` may be empty.
Section summary_section(const PageSummary& answers, std::span<const ReportFlight> flights);

/// Warnings of the fits, and missing contents; std::nullopt without any.
std::optional<Section> notes_section(const PageSummary& answers);

/// The missions' states of charge in one drawing.
Section curves_section(std::span<const SimulatedMission> missions);

/// Power by phase, energy of the cruise, error of predictions, pack, notes: HTML; empty without flights and missions.
std::string aircraft_panel(const PageSummary& answers, std::span<const ReportFlight> flights);

/// "20 Faulty: 3 flights, 3 to 10 July 2020; 9 missions".
std::string page_title(std::span<const ReportFlight> flights, std::size_t missions);

/// "3 July 2020" (UTC).
std::string day_text(double clock_s);

/// "3 July 2020, 10:17", or the flight's name where its date is unknown.
std::string flight_title(const ReportFlight& flight);

/// "flight-20_07_03__12_17_45": unique names of files and anchors.
std::vector<std::string> flight_ids(std::span<const ReportFlight> flights);

/// A map for each flight with positions, on one scale: phases, charge every 5 minutes, and outlines below them.
/// `battery` may be null; std::nullopt without positions.
std::optional<Section> tracks_section(const BatchContent& batch, const ReportBattery* battery,
                                      const std::vector<Outline>& outlines = {});

/// "20 Faulty: 3 flights, 1 h 6 min in the air, 26.1 Wh" of each aircraft, with SYNTHETIC.
std::vector<std::string> aircraft_lines(std::span<const ReportFlight> flights);

/// Whether any of the accepted flights is synthetic.
bool any_synthetic(std::span<const ReportFlight> flights);

/// Mean error of the energy by leave-one-out: of the physical model, which knows the airspeed, and of the model that
/// missions use without it; empty without validation.
std::string prediction_line(const PageSummary& answers, bool synthetic);

/// `html` as zlib's deflate (RFC 1950) in base64 (RFC 4648), which the page opens by DecompressionStream("deflate").
std::string compressed_block(std::string_view html);

/// A specification with its inline CSV tables as {"packed": [[name, decimals, [first, step, step ...]], [name, [text,
/// text ...]]]}: a step leads to the next number, in units of the last decimal; null is an empty cell. unpacked() in
/// web/blocks.js makes the same rows. Named datasets are kept.
VegaJson packed_tables(VegaJson spec);

}  // namespace flightwatt::report
