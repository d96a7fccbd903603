// A phases CSV.

#include "flight/phases_file.h"
#include "fuzz/fuzz_target.h"

void flightwatt::fuzz::run(std::string_view bytes) { flight::read_phases_csv(as_file(bytes, "fuzz.csv")); }
