#pragma once

#include "base/text_table.h"
#include "mission/replay.h"
#include "report/html.h"

#include <span>
#include <vector>

namespace flightwatt::report {

/// What the missions' schedules came to on the flights' measured power: tables, sentences, and a figure a mission that
/// is yet to be planned. `replays` is not empty.
Section replay_section(std::span<const mission::Replay> replays);

/// Its tables.
std::vector<CaptionedTable> replay_tables(std::span<const mission::Replay> replays);

}  // namespace flightwatt::report
