// A .data text without its .log, to the phases of every aircraft.

#include "flight/segment.h"
#include "flight/telemetry_series.h"
#include "fuzz/fuzz_target.h"
#include "helpers/selected_tracks.h"
#include "telemetry/log_reader.h"
#include "telemetry/telemetry_log.h"

void flightwatt::fuzz::run(std::string_view bytes) {
    const auto log = telemetry::read_telemetry(bytes, "fuzz.data", std::nullopt, flight::flight_messages());
    for (const auto& id : flight::telemetry_senders(log)) {
        const auto series = flight::flight_series(log, id);
        flight::require_power(select_tracks(series));
        flight::segment(select_tracks(series));
    }
}
