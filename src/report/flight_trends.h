#pragma once

#include "answer/pack_ledger.h"
#include "base/statistics.h"
#include "batch/trend.h"
#include "battery/identified_battery.h"
#include "record/record.h"
#include "report/batch_content.h"
#include "report/latex_tables.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// The quantities of a flight that may change with age.
struct FlightTrendData {
    std::string name;
    std::string aircraft;  ///< id and name of the aircraft as text
    std::string aircraft_id = {};
    std::string aircraft_name = {};
    FlightSummary facts;
    std::vector<answer::PackUse> uses;  ///< until take_uses()
    std::string no_uses_reason;         ///< reason why there is no use
    std::optional<battery::FlightResistance> resistance;
    std::optional<double> capacity_ah;  ///< capacity of the pack, if the flight determines it
    Interval capacity_interval_ah;
    std::optional<double> capacity_percent;  ///< capacity in percent of the mean of the flights, which may be a guess
    std::optional<double> charge_ah;         ///< charge drawn from the pack, also on the ground
    bool only_hovers = false;                ///< a VTOL that is never on its wing
};

/// Collects the quantities of an accepted flight; `folder` is that of its log.
FlightTrendData extract_trend_data(const ReportFlight& flight, const std::string& folder = {});

/// Moves the uses of packs out of the flights, to name their packs.
std::vector<answer::PackUse> take_uses(std::vector<FlightTrendData>& flights);

/// Makes the ledger of the flights' packs, and adds resistance and capacity of each flight, of its first pack.
answer::PackLedger add_state_of_health(std::vector<FlightTrendData>& flights, std::vector<answer::PackUse> uses,
                                       const answer::LedgerOptions& options = {});

/// A quantity whose trend is estimated.
struct TrendQuantity {
    const char* name;   ///< name with its unit, as in files
    const char* title;  ///< short name, as in figures
    std::optional<double> (*value)(const FlightTrendData&);
    bool is_of_pack = false;
};

/// Returns the quantities whose trends are estimated; not the charge drawn, which depends on the length of the flight.
std::span<const TrendQuantity> trend_quantities();

/// A quantity of one aircraft over the dates of its flights, and its trend.
struct AircraftTrend {
    std::string aircraft;
    std::string quantity;
    std::vector<batch::DatedValue> values;  ///< values over days since 1970
    batch::TrendResult answer;
    std::string aircraft_id = {};
    std::string aircraft_name = {};
};

/// Estimates the trends of all quantities of each aircraft; those of its power without flights of a VTOL that only hover
/// where others are on the wing.
std::vector<AircraftTrend> estimate_trends(std::span<const FlightTrendData> flights);

Fields<AircraftTrend> record_fields(const AircraftTrend*);

/// Number of days in which trends are shown as changes.
inline constexpr double shown_days = 30.0;

/// Returns the direction of a trend: "rises", "falls", "not significant", or "unknown" with the reason.
std::string trend_direction(const AircraftTrend& trend);

/// Returns the ledger of packs and all trends (TrendsDocument of web/app/src/documents.ts), and adds their tables; null
/// without any trend and any named pack.
Json trends_json(const std::vector<AircraftTrend>& trends, const answer::PackLedger& ledger, LatexTables& tables);

}  // namespace flightwatt::report
