// A mechanical model.

#include "fuzz/fuzz_target.h"
#include "mechanical/mechanical_model.h"

void flightwatt::fuzz::run(std::string_view bytes) { mechanical::read_mechanical_model(as_file(bytes, "fuzz.toml")); }
