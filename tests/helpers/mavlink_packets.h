#pragma once

#include "helpers/autopilot_logs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// Packets of MAVLink as bytes, made without the program's own table: names and sizes are not used, only ids, seeds of the
/// checksum and payloads.
namespace flightwatt::test {

/// The seeds (CRC_EXTRA) that MAVLink's documents state for messages.
inline const std::map<std::uint32_t, std::uint8_t>& mavlink_seeds() {
    static const std::map<std::uint32_t, std::uint8_t> seeds{
        {0, 50},   {1, 124},   {2, 137},   {22, 220},  {24, 24},   {30, 39},   {33, 104},  {39, 254},  {42, 28},
        {43, 132}, {44, 221},  {47, 153},  {51, 196},  {73, 38},   {74, 20},   {147, 154}, {148, 178}, {164, 154},
        {168, 1},  {181, 174}, {230, 163}, {231, 105}, {242, 104}, {245, 130}, {251, 170}, {253, 83},  {291, 10}};
    return seeds;
}

struct MavlinkSender {
    std::uint8_t system = 1;
    std::uint8_t component = 1;
    std::uint8_t sequence = 0;
    bool is_v1 = false;
    bool is_signed = false;

    std::string packet(std::uint32_t id, std::string payload) {
        while (!is_v1 && payload.size() > 1 && payload.back() == '\0') payload.pop_back();
        std::string head{static_cast<char>(payload.size())};
        if (!is_v1) head += std::string{static_cast<char>(is_signed ? 1 : 0), '\0'};
        head += std::string{static_cast<char>(sequence++), static_cast<char>(system), static_cast<char>(component)};
        head += little_endian(id).substr(0, is_v1 ? 1 : 3);
        const auto seed = mavlink_seeds().contains(id) ? mavlink_seeds().at(id) : std::uint8_t{0};
        std::uint16_t crc = 0xFFFF;
        for (const char c : head + payload + static_cast<char>(seed)) {
            crc = static_cast<std::uint16_t>(crc ^ static_cast<std::uint8_t>(c));
            for (int bit = 0; bit < 8; ++bit)
                crc = static_cast<std::uint16_t>((crc & 1U) != 0 ? (crc >> 1U) ^ 0x8408U : crc >> 1U);
        }
        return (is_v1 ? "\xFE" : "\xFD") + head + payload + little_endian(crc) + std::string(is_signed ? 13 : 0, 's');
    }

    std::string heartbeat(std::uint8_t type = 2, std::uint8_t autopilot = 3, std::uint8_t base_mode = 209) {
        return packet(0, little_endian(std::uint32_t{5}) + static_cast<char>(type) + static_cast<char>(autopilot) +
                             static_cast<char>(base_mode) + "\x04\x03");
    }

    /// SYS_STATUS with a battery; bit 4 of the sensors is an airspeed sensor.
    std::string status(std::uint16_t voltage_mv, std::int16_t current_ca, std::uint32_t sensors = 0) {
        const auto flags = little_endian(sensors);
        return packet(1, flags + flags + flags + std::string(2, '\0') + little_endian(voltage_mv) +
                             little_endian(current_ca) + std::string(13, '\0'));
    }

    /// BATTERY_STATUS whose first cells have these voltages [mV], with its temperature in 0.01 degC.
    std::string battery(const std::vector<std::uint16_t>& cells_mv, std::int16_t current_ca, std::int32_t consumed_mah,
                        std::uint8_t id = 0, std::int16_t temperature = 32767, std::uint8_t function = 1) {
        std::string cells;
        for (std::size_t i = 0; i < 10; ++i)
            cells += little_endian(i < cells_mv.size() ? cells_mv[i] : std::uint16_t{65535});
        return packet(147, little_endian(consumed_mah) + little_endian(std::int32_t{-1}) + little_endian(temperature) +
                               cells + little_endian(current_ca) + static_cast<char>(id) + static_cast<char>(function) +
                               std::string(2, '\1'));
    }

    /// BATTERY2, the second battery of ArduPilot.
    std::string battery2(std::uint16_t voltage_mv, std::int16_t current_ca) {
        return packet(181, little_endian(voltage_mv) + little_endian(current_ca));
    }

    std::string position(double boot_s, double height_m) {
        return packet(33, little_endian(static_cast<std::uint32_t>(boot_s * 1e3)) + std::string(12, '\1') +
                              little_endian(static_cast<std::int32_t>(height_m * 1e3)) + std::string(8, '\0'));
    }

    std::string hud(float airspeed, float height_m, std::uint16_t throttle) {
        return packet(74, little_endian(airspeed) + little_endian(12.0F) + little_endian(height_m) +
                              little_endian(0.0F) + little_endian(std::int16_t{10}) + little_endian(throttle));
    }

    std::string parameter(const std::string& name, float value, std::uint8_t type = 9) {
        return packet(22, little_endian(value) + std::string(4, '\0') + padded(name, 16) + static_cast<char>(type));
    }
};

/// An entry of a .tlog: the time of reception, big-endian, and the packet.
inline std::string tlog_entry(double time_s, const std::string& packet) {
    const auto time_us = std::uint64_t{1'780'000'000'000'000} + static_cast<std::uint64_t>(std::llround(time_s * 1e6));
    std::string time;
    for (int shift = 56; shift >= 0; shift -= 8) time += static_cast<char>(time_us >> shift);
    return time + packet;
}

/// Four minutes in the air at 60 m with 15.8 V and 15 A, between half minutes on the ground with 0.5 A.
inline std::string tlog_of_flight(MavlinkSender vehicle = {}) {
    std::string log;
    MavlinkSender station{255, 190};
    for (int i = 0; i < 3000; ++i) {
        const double time_s = 0.1 * i;
        const bool flies = time_s >= 30.0 && time_s < 270.0;
        const double height_m = !flies ? 0.0 : std::min({3.0 * (time_s - 30.0), 60.0, 3.0 * (270.0 - time_s)});
        const auto add = [&](const std::string& packet) { log += tlog_entry(time_s, packet); };
        if (i % 10 == 0) {
            add(vehicle.heartbeat());
            add(station.heartbeat(6, 8));
        }
        if (i % 5 == 0) add(vehicle.status(15'800, flies ? 1500 : 50));
        add(vehicle.position(time_s, height_m));
        add(vehicle.hud(0.0F, static_cast<float>(500.0 + height_m), flies ? 50 : 0));
    }
    return log;
}

}  // namespace flightwatt::test
