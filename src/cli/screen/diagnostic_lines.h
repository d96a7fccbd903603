#pragma once

#include "base/diagnostic.h"

#include <string>
#include <vector>

/// Diagnostics as the lines of a screen.
namespace flightwatt::cli {

/// The lines "warning: gaps in the power: 5 logs (a, b, c and 2 more), the first: ...", one for each kind of errors and
/// warnings; one for each finding where all are of one flight, and for up to five errors of a kind. `with_notes` lists
/// each finding, and the notes too.
std::vector<std::string> diagnostic_lines(const Diagnostics& diagnostics, bool with_notes);

/// "notes: cut at power-off (5 logs), no .log (2 logs); --notes lists them"; empty without notes.
std::string notes_line(const Diagnostics& diagnostics);

}  // namespace flightwatt::cli
