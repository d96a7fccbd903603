#pragma once

#include "base/text_table.h"
#include "cli/screen_table.h"
#include "mission/replay.h"

#include <span>
#include <string>
#include <vector>

/// What flightwatt replay shows, and the report of it.
namespace flightwatt::cli {

/// What each replay rests on: model, durations, energies, gaps. One row a flight and mission.
TextTable replay_basis_table(std::span<const mission::Replay> replays);

/// What came of it: one row a flight, mission and schedule.
TextTable replay_table(std::span<const mission::Replay> replays);

/// On how many flights replanning was better than planning beforehand, a sentence a mission and way of planning.
std::vector<std::string> replay_sentences(std::span<const mission::Replay> replays);

/// What the power holds and what it does not.
std::string replay_remark();

/// All of that for people.
std::string replay_text(std::span<const mission::Replay> replays, const Screen& screen);

/// flight,mission,schedule,... (docs/formats.md), one row a flight, mission and schedule.
std::string replay_csv(std::span<const mission::Replay> replays);

Json to_json(const mission::Replays& replays);

}  // namespace flightwatt::cli
