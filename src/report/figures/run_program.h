#pragma once

#include <string>
#include <vector>

namespace flightwatt::report {

/// Runs a program of the PATH with its output on standard error; false if it is not installed. Throws OutputError if it
/// fails.
bool run_program(std::vector<std::string> command);

}  // namespace flightwatt::report
