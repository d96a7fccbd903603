// gzip, bzip2, xz and zstd.

#include "fuzz/fuzz_target.h"
#include "telemetry/data_file.h"

void flightwatt::fuzz::run(std::string_view bytes) {
    constexpr std::size_t most_bytes = 1'000'000;
    telemetry::read_data_file(as_file(bytes, "fuzz.data"), most_bytes);
}
