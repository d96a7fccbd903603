#pragma once

#include "telemetry/binary/frame.h"
#include "telemetry/binary/wire_value.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace flightwatt::telemetry {

/// Fewer zeros between frames are damage, not room that was set aside.
inline constexpr std::size_t min_padding_zeros = 16;

/// The time of messages on links that have none of their own: what the last TIMESTAMP message said [ms], as an OpenLog
/// stores them.
class LinkTime {
  public:
    explicit LinkTime(const MessageDictionary& dictionary) {
        for (const auto& message : dictionary.messages()) {
            const bool tells = message.class_id == MessageDictionary::telemetry_class &&
                               message.definition.name == "TIMESTAMP" && message.fields.size() == 1 &&
                               message.fields[0].type == WireType::uint32 && message.fields[0].count == WireCount::one;
            if (tells) id_ = message.id;
        }
    }

    /// Of a message that fits its definition; nothing before the first TIMESTAMP.
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

/// The time of card frames, which starts anew after 119.3 h. It is taken to have done so where a time is before the
/// last one and, counted across the end of the range, less than an hour behind it: a damaged time or a clock that was
/// set back does not count as one.
class FrameClock {
  public:
    double time_s(std::uint32_t time_100us) {
        constexpr std::uint32_t hour = 36'000'000;
        auto round = round_;
        if (time_100us < last_ && time_100us - last_ < hour) {
            round = ++round_;
            last_ = time_100us;
        } else if (time_100us > last_ && last_ - time_100us < hour && round_ > 0) {
            --round;  // a frame from before, late
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
