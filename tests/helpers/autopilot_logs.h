#pragma once

#include "telemetry/autopilot_log.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

/// Small logs of other autopilots, as bytes.
namespace flightwatt::test {

template <typename T>
std::string little_endian(T value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

inline std::string padded(std::string_view text, std::size_t size) {
    std::string bytes(text);
    bytes.resize(size, '\0');
    return bytes;
}

/// FMT of a message whose fields have `bytes` in all.
inline std::string dataflash_format(std::uint8_t type, std::string_view name, std::string_view codes,
                                    std::string_view columns, std::uint8_t bytes) {
    return "\xA3\x95\x80" + little_endian(type) + little_endian(static_cast<std::uint8_t>(bytes + 3)) +
           padded(name, 4) + padded(codes, 16) + padded(columns, 64);
}

inline std::string dataflash_message(std::uint8_t type, const std::string& body) {
    return "\xA3\x95" + little_endian(type) + body;
}

inline std::string dataflash_text(std::uint8_t type, std::string_view text) {
    return dataflash_message(type, little_endian(std::uint64_t{1'000'000}) + padded(text, 64));
}

/// A Copter's log of `samples` battery messages, 10 a second from 10 s: 16 V less 1 mV a sample, 10 A and 0.1 A a sample.
inline std::string dataflash_log(int samples, std::string_view firmware = "ArduCopter V4.0.2 (2cb4b85a)") {
    auto log = dataflash_format(1, "BAT", "Qff", "TimeUS,Volt,Curr", 16) +
               dataflash_format(2, "BARO", "Qf", "TimeUS,Alt", 12) +
               dataflash_format(3, "MSG", "QZ", "TimeUS,Message", 72);
    log += dataflash_text(3, firmware) + dataflash_text(3, "Pixracer 002A001A 3038510C 31353236");
    for (int i = 0; i < samples; ++i) {
        const auto time =
            little_endian(std::uint64_t{10'000'000} + std::uint64_t{100'000} * static_cast<std::uint64_t>(i));
        const auto step = static_cast<float>(i);
        log += dataflash_message(1, time + little_endian(16.0F - 0.001F * step) + little_endian(10.0F + 0.1F * step));
        log += dataflash_message(2, time + little_endian(0.5F * step));
    }
    return log;
}

inline std::string ulog_message(char kind, const std::string& body) {
    return little_endian(static_cast<std::uint16_t>(body.size())) + kind + body;
}

inline std::string ulog_text(char kind, const std::string& type_and_key, const std::string& value) {
    return ulog_message(kind, little_endian(static_cast<std::uint8_t>(type_and_key.size())) + type_and_key + value);
}

inline std::string ulog_subscription(std::uint8_t instance, std::uint16_t id, const std::string& topic) {
    return ulog_message('A', little_endian(instance) + little_endian(id) + topic);
}

inline std::string ulog_header(std::uint8_t incompatible = 0) {
    std::string flags(40, '\0');
    flags[8] = static_cast<char>(incompatible);
    return std::string("ULog\x01\x12\x35\x01", 8) + little_endian(std::uint64_t{1'000'000}) + ulog_message('B', flags);
}

inline std::string ulog_battery(std::uint16_t id, double time_s, float voltage_v, float current_a) {
    return ulog_message('D', little_endian(id) + little_endian(static_cast<std::uint64_t>(std::llround(time_s * 1e6))) +
                                 little_endian(voltage_v) + little_endian(current_a) + '\x01');
}

/// Formats and subscriptions of two batteries, ids 7 and 8.
inline std::string ulog_definitions() {
    return ulog_message('F',
                        "battery_status:uint64_t timestamp;float voltage_v;float current_a;bool connected;"
                        "uint8_t[7] _padding0;") +
           ulog_text('I', "char[8] sys_name", "PX4 test") + ulog_text('I', "char[4] sys_uuid", "0A1B") +
           ulog_text('P', "int32_t MAV_TYPE", little_endian(std::int32_t{2})) +
           ulog_subscription(0, 7, "battery_status") + ulog_subscription(1, 8, "battery_status");
}

/// A log of two batteries in parallel, 5 samples a second from 10 s, of 10 A and 5 A.
inline std::string ulog_log(int samples, float second_a = 5.0F, float second_v = 22.0F) {
    auto log = ulog_header() + ulog_definitions();
    for (int i = 0; i < samples; ++i) {
        const double time_s = 10.0 + 0.2 * i;
        log += ulog_battery(7, time_s, 22.0F, 10.0F + 0.1F * static_cast<float>(i % 2)) +
               ulog_battery(8, time_s + 0.000004, second_v, second_a);
    }
    return log;
}

inline const telemetry::MessageTable& table_of(const telemetry::AutopilotLog& log, std::string_view message) {
    static const telemetry::MessageTable none;
    const auto* table = log.log.senders.front().table(message);
    return table == nullptr ? none : *table;
}

}  // namespace flightwatt::test
