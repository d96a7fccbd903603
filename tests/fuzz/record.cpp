// The record of a log in a batch.

#include "batch/flight_record.h"
#include "fuzz/fuzz_target.h"

#include <string>

void flightwatt::fuzz::run(std::string_view bytes) { batch::record_from_json(std::string(bytes)); }
