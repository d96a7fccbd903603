// A series CSV with its front matter, to its phases.

#include "flight/segmentation.h"
#include "flight/selected_track.h"
#include "flight/series_file.h"
#include "fuzz/fuzz_target.h"

void flightwatt::fuzz::run(std::string_view bytes) {
    const auto series = flight::parse_series_csv(bytes, "fuzz.csv");
    flight::require_power(series);
    flight::segment(series);
}
