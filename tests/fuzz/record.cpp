// The record of a log in a batch: as it is, and with the seal that makes the reader accept it.

#include "base/fingerprint.h"
#include "batch/flight_record.h"
#include "fuzz/fuzz_target.h"

#include <string>

#include <fmt/format.h>

void flightwatt::fuzz::run(std::string_view bytes) {
    batch::record_from_json(std::string(bytes));
    const auto text = bytes.substr(0, bytes.rfind(",\n \"seal\": \""));
    Fingerprint fingerprint;
    fingerprint.add(text);
    batch::record_from_json(fmt::format("{},\n \"seal\": \"{}\"\n}}\n", text, fingerprint.hex()));
}
