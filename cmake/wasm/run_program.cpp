#include "report/figures/run_program.h"

// A browser starts no programs: as if none were installed.
bool flightwatt::report::run_program(std::vector<std::string>) { return false; }
