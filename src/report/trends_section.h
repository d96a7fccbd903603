#pragma once

#include "base/statistics.h"
#include "base/text_table.h"
#include "batch/trend.h"
#include "battery/discharge_record.h"
#include "battery/identification.h"
#include "report/batch_content.h"
#include "report/html.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// One flight, with all that may change with age.
struct FlightTrendData {
    std::string name;
    std::string aircraft;  ///< id and name as text
    std::string aircraft_id = {};
    std::string aircraft_name = {};
    FlightSummary facts;
    std::vector<battery::DischargeRecord> records;
    std::string no_record;  ///< why there are none of these
    std::optional<battery::FlightResistance> resistance;
    std::optional<double> capacity_ah;  ///< of the pack, where the flight tells it
    Interval capacity_interval_ah;
    bool capacity_level_is_guess = false;  ///< of all of a pack's flights together; how they differ is measured
    std::optional<double> charge_ah;       ///< drawn from the pack, on the ground too
};

/// `flight` was not rejected.
FlightTrendData extract_trend_data(const ReportFlight& flight);

/// Resistance and capacity of each flight, by the pack that all flights of an aircraft tell together: the charge that
/// each draws for its way down their common curve of voltage (battery/identification/state_of_health.h). What is not
/// known and why, an aircraft a line. The work grows with the square of an aircraft's flights, so that `most` are
/// taken. `capacity_ah` is the mean over the flights, where it is known; else it may be a guess. Throws UsageError
/// where flights draw more.
std::vector<std::string> add_state_of_health(std::vector<FlightTrendData>& flights, std::size_t most,
                                             std::optional<double> capacity_ah = {});

struct TrendQuantity {
    const char* name;   ///< with its unit, as in files
    const char* title;  ///< as in figures, short
    std::optional<double> (*value)(const FlightTrendData&);
};

/// What has a trend. The charge that was drawn has none: it says how long the flight was.
std::span<const TrendQuantity> trend_quantities();

/// A quantity of one aircraft over its flights' dates.
struct AircraftTrend {
    std::string aircraft;
    std::string quantity;
    std::vector<batch::DatedValue> values;  ///< days since 1970
    batch::TrendResult answer;
    bool level_is_guess = false;  ///< the slope is known in percent of the level, not in the quantity's unit
    std::string aircraft_id = {};
    std::string aircraft_name = {};
};

/// Of each aircraft, all quantities.
std::vector<AircraftTrend> trends_of(std::span<const FlightTrendData> flights);

/// Slopes are told of this many days.
inline constexpr double trend_days = 30.0;

/// The slope and its 95 % interval over trend_days: in the quantity's unit, or where the level is a guess in percent of
/// it.
struct ShownSlope {
    double slope = 0.0;
    double low = 0.0;
    double high = 0.0;
    std::string unit;  ///< " %" or empty
};

/// The trend is there.
ShownSlope shown_slope(const AircraftTrend& trend);

/// "rises", "falls" or "none to be seen"; of one that has no trend "none" and why.
std::string trend_direction(const AircraftTrend& trend);

/// A row an aircraft and quantity.
TextTable trend_table(std::span<const AircraftTrend> trends);

/// Those that are told over the flights' dates, with the table of all. std::nullopt where none is told.
std::optional<Section> trends_section(std::span<const AircraftTrend> trends);

}  // namespace flightwatt::report
