#pragma once

#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mission/replay.h"

#include <span>
#include <string>
#include <vector>

namespace flightwatt::mission {
Fields<Comparison> record_fields(const Comparison*);
Fields<SkippedReplay> record_fields(const SkippedReplay*);
Fields<Replay> record_fields(const Replay*);
Fields<Replays> record_fields(const Replays*);
}  // namespace flightwatt::mission

/// Output of replay, also for the report.
namespace flightwatt::cli {

/// Data of each replay: model, durations, energies, gaps. One row a flight and mission.
TextTable replay_basis_table(std::span<const mission::Replay> replays);

/// Results: one row a flight, mission and schedule.
TextTable replay_table(std::span<const mission::Replay> replays);

/// Replanning compared with planning before the flight, a sentence a mission and baseline.
std::vector<std::string> replay_sentences(std::span<const mission::Replay> replays);

/// The components of the measured power.
std::string replay_remark();

/// All tables and sentences.
std::string replay_text(std::span<const mission::Replay> replays, const Screen& screen);

/// flight,mission,schedule,... (docs/reference/replay.md), one row a flight, mission and schedule.
std::string replay_csv(std::span<const mission::Replay> replays);

}  // namespace flightwatt::cli
