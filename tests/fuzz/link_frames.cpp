// Bytes of a link, in pieces, to the state of the flight in the air.

#include "fuzz/flight_sink.h"
#include "fuzz/fuzz_target.h"

#include <memory>
#include <string>

void flightwatt::fuzz::run(std::string_view bytes) {
    static const std::string definitions = std::string(FLIGHTWATT_SOURCE_DIR) + "/logs/opterra_synthetic_01.log";
    static const auto messages =
        std::make_shared<const telemetry::MessageDictionary>(telemetry::read_message_dictionary(definitions));
    FlightSink sink;
    live::LinkReader reader(sink, messages);
    sink.receive(reader, bytes);
}
