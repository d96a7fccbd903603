# The program for browsers. What they cannot do is left out: live links (watch, play), processes (profile, programs that draw figures), signals.
string(CONCAT left_out "/src/base/signal_watch\\.cpp$"
  "|/src/compute/(profiler|power_sampler)\\.cpp$|/src/compute/(processes|profiling|sensors)/"
  "|/src/live/sources/|/src/live/state/(moment|soc_estimation|telemetry_store)\\.cpp$|/src/live/(announcer|followed_files|live_flight|live_schedule|page_server|playback)\\.cpp$"
  "|/src/live/(link_mission|predictor|received_links|recorder|sources)\\.cpp$|/src/cli/output/watch_output\\.cpp$"
  "|/src/report/figures/run_program\\.cpp$|/tools/flightwatt_(play|profile|watch)\\.cpp$")
set(instead_of_left_out ${CMAKE_CURRENT_LIST_DIR}/left_out_stages.cpp ${CMAKE_CURRENT_LIST_DIR}/run_program.cpp)
add_compile_options("SHELL:-include missing.h")

# Headers that nearly every batch of files includes, compiled ahead: a fifth of the time.
function(include_common_headers target)
  if(NOT target STREQUAL flightwatt_base)
    target_precompile_headers(${target} REUSE_FROM flightwatt_base)
    return()
  endif()
  target_precompile_headers(${target} PRIVATE <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional>
    <iostream> <limits> <map> <memory> <mutex> <numeric> <optional> <random> <ranges> <regex> <set> <span> <sstream>
    <stdexcept> <string> <string_view> <system_error> <thread> <tuple> <unordered_map> <utility> <variant> <vector>
    <fmt/chrono.h> <fmt/format.h> <fmt/ranges.h> <nlohmann/json.hpp>)
endfunction()
