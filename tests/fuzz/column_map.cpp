// A column map, a line of dashes, and a CSV that it maps, to the checked flights.

#include "flight/column_map.h"

#include "flight/families/mapped_csv.h"
#include "flight/load_flight.h"
#include "fuzz/fuzz_target.h"

#include <string>

void flightwatt::fuzz::run(std::string_view bytes) {
    constexpr std::string_view border = "\n---\n";
    const auto end = bytes.find(border);
    if (end == std::string_view::npos) return;
    const auto map = flight::parse_column_map(std::string(bytes.substr(0, end)), "fuzz.toml");
    for (auto& series : flight::parse_mapped_csv(bytes.substr(end + border.size()), "fuzz.csv", map))
        flight::segment_and_check(std::move(series), {});
}
