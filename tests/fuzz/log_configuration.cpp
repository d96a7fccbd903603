// A .log: its catalogue of messages and its aircraft.

#include "telemetry/log_configuration.h"

#include "fuzz/fuzz_target.h"

#include <string>

void flightwatt::fuzz::run(std::string_view bytes) {
    telemetry::parse_log_configuration(std::string(bytes), "fuzz.log");
}
