// A log of PX4, to the checked flights of each recording.

#include "flight/load_flight.h"
#include "fuzz/fuzz_target.h"

void flightwatt::fuzz::run(std::string_view bytes) { flight::load_flights(as_file(bytes, "fuzz.ulg")); }
