#include "telemetry/mavlink/entries.h"

#include "telemetry/binary/wire_value.h"

#include <utility>

#include <boost/endian/conversion.hpp>

namespace flightwatt::telemetry {
namespace {

/// Whether a time is between 2001 and 2100.
bool is_of_this_century(std::uint64_t time_us) {
    constexpr std::uint64_t first_us = 978'307'200'000'000;
    constexpr std::uint64_t last_us = 4'102'444'800'000'000;
    return time_us >= first_us && time_us < last_us;
}

}  // namespace

std::uint64_t tlog_time_us(std::string_view bytes) {
    return boost::endian::endian_reverse(wire_number<std::uint64_t>(bytes.data()));
}

bool may_be_tlog_entry(std::string_view bytes) {
    if (bytes.size() < tlog_time_bytes) return true;
    return is_of_this_century(tlog_time_us(bytes)) && mavlink_frame_bytes(bytes.substr(tlog_time_bytes)) != 0;
}

std::optional<TlogEntry> read_tlog_entry(std::string_view bytes) {
    if (bytes.size() < tlog_time_bytes || !is_of_this_century(tlog_time_us(bytes))) return std::nullopt;
    auto frame = read_mavlink_frame(bytes.substr(tlog_time_bytes));
    if (!frame) return std::nullopt;
    if (frame->message == nullptr && !may_be_tlog_entry(bytes.substr(tlog_time_bytes + frame->bytes)))
        return std::nullopt;
    return TlogEntry{tlog_time_us(bytes), std::move(*frame)};
}

}  // namespace flightwatt::telemetry
