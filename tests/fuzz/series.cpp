// A series CSV with its front matter, to its phases.

#include "flight/segment.h"
#include "flight/series_file.h"
#include "fuzz/fuzz_target.h"
#include "helpers/selected_tracks.h"

void flightwatt::fuzz::run(std::string_view bytes) {
    const auto series = flight::parse_series_csv(bytes, "fuzz.csv");
    flight::require_power(select_tracks(series));
    flight::segment(select_tracks(series));
}
