#pragma once

#include "batch/batch_fit.h"
#include "batch/flight_record.h"
#include "mechanical/measured_flight.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::report {

/// One log as the report shows it.
struct ReportFlight {
    std::string name;
    std::string log;              ///< where it was read from
    std::string rejected;         ///< why it could not be used; empty if it could
    flight::FlightSeries series;  ///< of a log that was not rejected
    flight::FlightPhases phases;  ///< with the evidence at their edges
    std::vector<std::string> warnings;
    std::vector<std::string> exclusions;  ///< what the model was not fitted to, and why
    std::vector<batch::RecordedEdgeCheck> verdicts = {};
    std::string unusable_power = {};        ///< why its power record is used for nothing; empty if it is
    std::size_t batch = 0;                  ///< the place of its folder among those of the page
    std::vector<std::string> folders = {};  ///< that hold it, where the page shows several
    bool is_shown_elsewhere = false;        ///< it stands under another of the page's folders
};

/// How much of it the model was fitted to: "all", "in part" or "no".
std::string_view fitted_part(const ReportFlight& flight);

/// What flightwatt report takes from a batch's folder.
struct BatchContent {
    std::string folder;  ///< what the page calls it, where it shows several
    std::vector<ReportFlight> flights;
    std::vector<mechanical::MeasuredFlight> measured;  ///< what the batch's fit took of them
    std::optional<batch::BatchFit> fit;                ///< absent where the batch could not fit them
    std::vector<std::string> damaged;                  ///< flights whose files are not as the batch wrote them, and why
};

/// The folder's flights, those with a usable power record first. Throws InputError as read_stored_flights and
/// read_batch_fit.
BatchContent read_batch_content(const std::filesystem::path& out);

/// Several folders for one page.
struct BatchContents {
    std::vector<BatchContent> batches;
    std::vector<std::string> notes;  ///< what a reader must know of folders that stand side by side
};

/// The folders, in their order, under their names or, where these do not differ, their paths. A flight that several
/// hold is shown under the first one; flights of one name that are not one flight are renamed "NAME (FOLDER)". Notes
/// tell both, and where the folders' aircraft or the options of their fits differ. Throws UsageError for a folder that
/// is given twice, and as read_batch_content.
BatchContents read_batch_contents(std::span<const std::filesystem::path> outs);

/// Takes out the flights that are to be shown, those with a usable power record first.
std::vector<ReportFlight> take_shown_flights(std::vector<BatchContent>& batches);

/// Which flights are of which aircraft, where they are of several and the batch was not asked to mix them; else empty.
std::string aircraft_mix(const BatchContent& content);

/// `measured`, with the power that the flights' series hold: what is flown in a replay.
std::vector<mechanical::MeasuredFlight> flights_with_power(const BatchContent& content);

/// What people know a flight by.
struct FlightSummary {
    std::optional<double> start_clock_s;  ///< Unix time, UTC where the .log has its clock, else as its name has it
    std::string date;                     ///< the same as "2020-07-03 12:17"; empty if unknown
    double in_air_s = 0.0;
    std::optional<double> distance_m;      ///< over ground, in the air; of position's samples joined by lines
    std::optional<double> air_distance_m;  ///< through the air; of logs that measured airspeed
    std::optional<double> height_m;        ///< the greatest above the ground at lift-off
    std::optional<double> energy_wh;       ///< in the air
    std::optional<double> cruise_power_w;  ///< the mean of its cruises
};

/// `flight` was not rejected. Only the sortie counted from 0, or all of them.
FlightSummary summarize_flight(const ReportFlight& flight, std::optional<std::size_t> sortie = std::nullopt);

}  // namespace flightwatt::report
