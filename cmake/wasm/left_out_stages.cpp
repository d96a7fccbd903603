// The stages that a browser cannot have, instead of those of tools/.
#include "base/error.h"
#include "cli/stage.h"
#include "stages.h"

#include <string>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

int refuse(const std::string& stage, const std::string& reason) {
    return cli::run_guarded("flightwatt-" + stage, [&]() -> int {
        throw UsageError(fmt::format("a browser cannot {}: {} needs the installed program", reason, stage));
    });
}

}  // namespace

int flightwatt::stages::play_stage(int, char**) { return refuse("play", "send telemetry"); }
int flightwatt::stages::profile_stage(int, char**) {
    return refuse("profile", "start programs and measure their power");
}
int flightwatt::stages::watch_stage(int, char**) { return refuse("watch", "receive telemetry"); }
