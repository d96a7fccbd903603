#pragma once

#include "telemetry/binary/frame.h"
#include "telemetry/binary/wire_value.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace flightwatt::telemetry {

/// Minimum number of zeros between frames that counts as preallocated space; fewer are damage.
inline constexpr std::size_t min_padding_zeros = 16;

/// Gives messages on links, which have no time of their own, that of the last TIMESTAMP message (OpenLog).
class LinkTime {
  public:
    explicit LinkTime(const MessageDictionary& dictionary) {
        for (const auto& message : dictionary.messages()) {
            const bool is_timestamp = message.class_id == MessageDictionary::telemetry_class &&
                                      message.definition.name == "TIMESTAMP" && message.fields.size() == 1 &&
                                      message.fields[0].type == WireType::uint32 &&
                                      message.fields[0].count == WireCount::one;
            if (is_timestamp) id_ = message.id;
        }
    }

    /// Returns the time of a message that fits its definition; std::nullopt before the first TIMESTAMP.
    std::optional<double> time_s(const FoundFrame& found) {
        constexpr double ms_per_s = 1000.0;
        if (found.id == id_ && found.class_id == MessageDictionary::telemetry_class)
            last_s_ = wire_number<std::uint32_t>(found.fields.data()) / ms_per_s;
        return last_s_;
    }
    std::optional<double> last_s() const { return last_s_; }

  private:
    std::optional<std::uint8_t> id_;
    std::optional<double> last_s_;
};

/// Converts the times of card frames, whose counter overflows after 119.3 h, to seconds. A time before the last one
/// counts as an overflow if it is, across the end of the range, less than an hour later; otherwise it is damaged, or
/// the clock was set back.
class FrameClock {
  public:
    /// Returns the time of the next frame.
    double time_s(std::uint32_t time_100us) {
        constexpr std::uint32_t hour = 36'000'000;
        auto round = round_;
        if (time_100us < last_ && time_100us - last_ < hour) {
            round = ++round_;
            last_ = time_100us;
        } else if (time_100us > last_ && last_ - time_100us < hour && round_ > 0) {
            --round;  // a late frame from before the overflow
        } else {
            last_ = time_100us;
        }
        constexpr double ticks_per_s = 10'000.0;
        return static_cast<double>(round << 32 | time_100us) / ticks_per_s;
    }

  private:
    std::uint64_t round_ = 0;
    std::uint32_t last_ = 0;
};

}  // namespace flightwatt::telemetry
