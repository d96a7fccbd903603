// A mission file, whose other files are those of missions/paper.

#include "fuzz/fuzz_target.h"
#include "mission/mission_file.h"

void flightwatt::fuzz::run(std::string_view bytes) {
    mission::parse_mission(bytes, FLIGHTWATT_SOURCE_DIR "/missions/paper/fuzz.toml", {true, std::nullopt});
}
