// A recording of MAVLink (.tlog), as a log and as it grows, and its bytes as a link, up to the flight. mavlink_frames
// has the frames alone.

#include "flight/load_flight.h"
#include "flight/telemetry_series.h"
#include "fuzz/flight_sink.h"
#include "fuzz/fuzz_target.h"
#include "fuzz/mavlink_checksums.h"

#include <memory>
#include <string>

namespace {

using namespace flightwatt;

void receive(std::string_view bytes, bool is_tlog) {
    fuzz::FlightSink sink;
    live::MavlinkReader reader(sink, std::make_shared<telemetry::MavlinkVehicles>(flight::mavlink_flight_messages()),
                               is_tlog);
    sink.receive(reader, bytes);
}

}  // namespace

void flightwatt::fuzz::run(std::string_view bytes) {
    const auto repaired = with_mavlink_checksums(std::string(bytes));
    receive(bytes, false);
    receive(repaired, false);
    receive(repaired, true);
    flight::load_flights(as_file(repaired, "fuzz.tlog"));
}
