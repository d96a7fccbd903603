#pragma once

#include "report/batch_content.h"
#include "report/document/battery_document.h"

namespace flightwatt::report {

/// Returns the ground track of an accepted flight within 2 m, by phases, with marks of time and charge (FlightTrack of
/// web/app/src/documents.ts); null without positions. `battery` may be null.
Json track_json(const ReportFlight& flight, const ReportBattery* battery);

}  // namespace flightwatt::report
