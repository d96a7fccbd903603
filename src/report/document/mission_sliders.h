#pragma once

#include "report/document/simulated_mission.h"

#include <span>

namespace flightwatt::report {

/// Adds to a document, for a page that runs the program, what the reader may change in its missions (MissionAgain of
/// web/app/src/documents.ts; null for one over several packs), and the files that they name. `missions` are those of the
/// document, in its order. Throws InputError for a file that cannot be read again.
void add_sliders(std::span<const SimulatedMission> missions, Json& document);

}  // namespace flightwatt::report
