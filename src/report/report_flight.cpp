#include "report/report_flight.h"

namespace flightwatt::report {

std::string_view fitted_part(const ReportFlight& flight) {
    if (flight.exclusions.empty()) return "all";
    return flight.unusable_power.empty() ? "in part" : "no";
}

}  // namespace flightwatt::report
