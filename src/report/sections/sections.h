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
#include "report/figures/flight_figures.h"
#include "report/html.h"
#include "report/sections/simulated_mission.h"

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// A flight that the identification does not use.
struct ExcludedFlight {
    std::string flight;
    std::string reason;
};

/// The battery that the flights were flown on, as identified from them.
struct ReportBattery {
    std::vector<battery::DischargeRecord> records;  ///< of the flights that it rests on
    std::vector<ExcludedFlight> excluded;
    std::vector<std::string> notes;  ///< packs that were changed within a log, counters that began anew
    std::size_t usable = 0;          ///< flights that could be used; more than records where their number is limited
    std::optional<battery::BatteryIdentification> identified;
    std::vector<battery::LeaveOneOutCheck> leave_one_out;  ///< one a record, or empty
    std::string no_result_reason;                          ///< why it was not identified
};

/// Identifies the battery from the flights that have measured current and voltage: from `most` of them, spread evenly,
/// where there are more (the work grows with their square). If the missions fly on one pack of these flights, with its
/// capacity and its cells. Throws UsageError as identify_battery, and for another capacity than that pack's.
ReportBattery identify_for_report(std::span<const ReportFlight> flights, const battery::IdentificationOptions& options,
                                  std::size_t most, std::span<const mission::MissionVariant> missions = {});

/// Measured against modelled voltage, the open-circuit curve, parameters with intervals and how well each
/// flight is predicted by the others; or why there is no such battery.
Section battery_section(const ReportBattery& battery, const SectionScope& of = {});

/// One row a sortie of the flights that were not rejected: durations, power, energy, closure, gaps, warnings.
TextTable flights_table(std::span<const ReportFlight> flights);

/// That one, and what was excluded with the reasons: the section's tables.
std::vector<CaptionedTable> flights_tables(std::span<const ReportFlight> flights);

/// Each flight of one complete sortie, predicted by a model of the other flights, from nothing that was logged later
/// but the durations of cruise and landing, taken as known. By the flights' names; flights without a prediction are not
/// in it, and none is where there are less than 3 flights or more than `max_flights`.
std::map<std::string, PredictedFlight> predict_each_minute(const BatchContent& content, std::size_t max_flights);

/// A row a flight: the energy [Wh] that was predicted in the first, the middle and the last of these moments, with its
/// 95 % interval, beside the measured one, and the percentage of all moments' intervals that hold it.
TextTable predictions_table(const std::map<std::string, PredictedFlight>& flights);

/// All flights as a table (durations, power, energy, closure of integral and counter, gaps, warnings), those
/// that are excluded with their reasons, and a part a flight that is drawn when it is opened, with what would have
/// been predicted in flight where that is known. `models` are those of the flights' batches, by their places.
Section flights_section(std::span<const ReportFlight> flights,
                        std::span<const std::optional<mechanical::MechanicalModel>> models,
                        const std::map<std::string, PredictedFlight>& predicted = {}, const Progress& progress = {});

/// A mechanical model and what is known of it.
struct ReportModel {
    mechanical::MechanicalModel model;
    std::string origin;                                  ///< "fitted to these flights", or the file it was read from
    flight::PerPhase<mechanical::CurveBand> bands = {};  ///< without times: not known
    std::optional<TextTable> table_one = {};
};

/// The batch's model with its bands and Table I, beside a published one where there is one.
ReportModel model_of(const batch::BatchFit& fit, const std::optional<mechanical::MechanicalModel>& published);

/// The model as Fig. 2 with Table I. `id` tells several apart.
Section model_section(const ReportModel& model, const PublishedFigures& published, const std::string& id);

/// How well flights that it has not seen are predicted, beside the baselines. `flights` is not empty;
/// of `synthetic` ones it says so.
Section validation_section(const std::vector<mechanical::ValidatedFlight>& flights, bool synthetic = false,
                           const SectionScope& of = {});

/// Power from airspeed and climb, fitted to the flights: figure, constants, and what was tried. std::nullopt where no
/// flight measured its motion, or it does not tell their power.
std::optional<Section> physical_section(std::span<const mechanical::MeasuredFlight> flights,
                                        const SectionScope& of = {});

/// The missions ranked by final state of charge, under their titles.
TextTable ranking_table(std::span<const SimulatedMission> missions);

/// Those whose schedules were planned, with the proven bound; without rows where none was.
TextTable plans_table(std::span<const SimulatedMission> missions);

/// The missions' mechanical models and profiled software, each once, the model of the flights that the page shows
/// already (`shown`, one a folder) not again; their schedules as Fig. 3 with the ranking; and the map over the quality
/// of service as Fig. 4 of each flight and software with two parameters or more. `missions` is not empty.
std::vector<Section> mission_sections(std::span<const SimulatedMission> missions, const PublishedFigures& published,
                                      std::span<const mechanical::MechanicalModel> shown = {});

/// The missions whose schedules were planned: their utility and what is proven of it, beside the other missions with
/// the same flight, software and battery, and what runs when. Without figures where none was planned.
Section plan_section(std::span<const SimulatedMission> missions);

/// What the missions' schedules came to on the flights' measured power: tables, sentences, and a figure a mission that
/// is yet to be planned. `replays` is not empty.
Section replay_section(std::span<const mission::Replay> replays);

/// How one folder's model predicts flights that are not in it.
struct ValidatedBatch {
    std::string folder;  ///< empty where the page shows one
    std::vector<mechanical::ValidatedFlight> flights;
    bool has_synthetic = false;
};

/// What a page answers first.
struct PageSummary {
    std::vector<SimulatedMission> missions;
    std::vector<MissionAssessment> answers;  ///< one a mission
    std::vector<ValidatedBatch> validated;   ///< of the folders whose models were
    std::vector<std::string> warnings;       ///< of the fits
    std::vector<std::string> notes;          ///< what is not on the page, and why
};

/// A card for each mission; the aircraft and its flights in a line each; whether the model predicts flights that it has
/// not seen; and warnings. `flights` are the batch's, empty without one.
Section summary_section(const PageSummary& answers, std::span<const ReportFlight> flights);

/// "20 Faulty: 3 flights, 1 h 6 min in the air, 26.1 Wh" of each aircraft, SYNTHETIC ones so called.
std::vector<std::string> aircraft_lines(std::span<const ReportFlight> flights);

/// Whether any flight that was not rejected is synthetic, and whether all are.
bool any_synthetic(std::span<const ReportFlight> flights);
bool all_synthetic(std::span<const ReportFlight> flights);

/// How far off the models are of flights that they have not seen, best first; empty where nothing was validated.
std::string prediction_line(std::span<const mechanical::ValidatedFlight> flights);

/// That line of each folder, which it names where there are several.
std::vector<std::string> prediction_lines(std::span<const ValidatedBatch> batches);

/// `html` as zlib's deflate (RFC 1950) in base64 (RFC 4648), which the page opens by DecompressionStream("deflate").
/// The same text gives the same block.
std::string compressed_block(std::string_view html);

/// A specification with its inline CSV tables as columns: {"values": CSV, "format": ...} becomes {"packed": [[name,
/// decimals, [first, step, step ...]], [name, [text, text ...]]]}. A step leads from a number to the next, counted in
/// the last decimal; null is an empty cell. Compressed, that is a third of the CSV. A column whose numbers have
/// exponents or more digits than a double has stands as [name, [number, null ...]]. Nothing is lost: unpacked() in
/// web/blocks.js makes the same rows of it. Named datasets stay what they are.
VegaJson packed_tables(const VegaJson& spec);

}  // namespace flightwatt::report
