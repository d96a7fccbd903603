#include "flight/families/mavlink_family.h"

#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "flight/select.h"
#include "helpers/mavlink_packets.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::HasSubstr;

std::filesystem::path written(const std::string& bytes) {
    return test::write_text(test::scratch_dir() / "flight.tlog", bytes);
}

/// Two minutes of messages that `add(time_s)` returns each second, after heartbeats.
template <typename Add>
FlightSeries series_of(test::MavlinkSender& vehicle, const Add& add) {
    std::string log;
    for (int i = 0; i < 120; ++i) {
        log += test::tlog_entry(i, vehicle.heartbeat());
        for (const auto& packet : add(i)) log += test::tlog_entry(i, packet);
    }
    return read_candidates(FlightFile(written(log)), std::nullopt).front();
}

std::vector<std::string> sources_of(const FlightSeries& series, const std::string& name) {
    std::vector<std::string> sources;
    for (const auto& track : series.tracks)
        if (track.name == name) sources.push_back(track.source);
    return sources;
}

TEST(MavlinkFamily, HasThePhasesAndEnergyOfAFlight) {
    const auto flight = load_flight(written(test::tlog_of_flight()));
    ASSERT_EQ(flight.phases.sorties.size(), 1U);
    const auto& phases = flight.phases.sorties.front();
    EXPECT_NEAR(phases.start_s(), 30.0, 1.0);
    EXPECT_NEAR(phases.end_s(), 270.0, 1.0);
    EXPECT_EQ(flight.series.aircraft_name, "ArduCopter");
    EXPECT_EQ(flight.series.firmware, "rotorcraft");
    EXPECT_NEAR(value_at(flight.data.power_w, 100.0), 237.0, 1e-9);
    EXPECT_NEAR(flight.series.start_clock_s.value(), 1.78e9, 1e-3);
}

TEST(MavlinkFamily, ReadsTheStateOfAVtolAndNoneOfOtherAircraft) {
    test::MavlinkSender vehicle;
    const auto state_of = [&](int i, char vtol_state) {
        return std::vector{vehicle.battery({4'000}, 1'000, 10 * i), vehicle.packet(245, {vtol_state, '\2'})};
    };
    const auto vtol = series_of(vehicle, [&](int i) { return state_of(i, i < 60 ? '\3' : '\4'); });
    const auto state = select_tracks(vtol).vtol_state;
    EXPECT_EQ(state_at(state, 30.0), 3.0);
    EXPECT_EQ(state_at(state, 90.0), 4.0);
    const auto copter = series_of(vehicle, [&](int i) { return state_of(i, '\0'); });
    EXPECT_THAT(sources_of(copter, "vtol_state"), testing::IsEmpty());
}

TEST(MavlinkFamily, AddsTheVoltagesOfCellsThatAreKnown) {
    test::MavlinkSender vehicle;
    const auto series = series_of(vehicle, [&](int i) {
        return std::vector{vehicle.battery({4'000, 3'900, 4'100}, 1'000, 10 * i), vehicle.status(11'000, 900)};
    });
    const auto data = select_tracks(series);
    EXPECT_NEAR(data.voltage_v.value.front(), 12.0, 1e-9);
    EXPECT_NEAR(data.power_w.value.front(), 120.0, 1e-9);
    EXPECT_THAT(sources_of(series, "charge_ah"), testing::ElementsAre("BATTERY_STATUS.current_consumed"));
}

/// A speed of 0 throughout was that of an aircraft at rest: a motor whose throttle is not stated was idle, and 180 of
/// 210 s in the air were missed.
TEST(MavlinkFamily, KnowsNoSpeedWhereNoneIsStated) {
    test::MavlinkSender vehicle;
    const auto sources_with = [&](float hud_speed) {
        return sources_of(
            series_of(vehicle,
                      [&](int i) {
                          return std::vector{
                              vehicle.battery({4'000}, 1'000, 10 * i), vehicle.position(i, 50.0),
                              vehicle.packet(74, test::little_endian(0.0F) + test::little_endian(hud_speed) +
                                                     test::little_endian(540.0F) + std::string(8, '\1'))};
                      }),
            "ground_speed_m_per_s");
    };
    EXPECT_THAT(sources_with(0.0F), testing::IsEmpty());
    EXPECT_THAT(sources_with(12.0F), testing::ElementsAre("VFR_HUD.groundspeed")) << "the other is 0, as of Betaflight";
}

/// Every flight of INAV was left out, as its energy counter has mWh times 36.
TEST(MavlinkFamily, UsesNoEnergyThatItsChargeCannotHave) {
    const auto sources_with = [](std::int32_t energy_for_each_mah) {
        test::MavlinkSender vehicle;
        return sources_of(
            series_of(vehicle,
                      [&](int i) {
                          return std::vector{vehicle.packet(
                              147, test::little_endian(std::int32_t{i}) + test::little_endian(energy_for_each_mah * i) +
                                       test::little_endian(std::int16_t{32767}) +
                                       test::little_endian(std::uint16_t{12'000}) + std::string(18, '\xFF') +
                                       test::little_endian(std::int16_t{360}) + std::string("\0\1\1\1", 4))};
                      }),
            "energy_wh");
    };
    EXPECT_THAT(sources_with(432), testing::IsEmpty()) << "12 kV";
    EXPECT_THAT(sources_with(1), testing::ElementsAre("BATTERY_STATUS.energy_consumed")) << "28 V";
}

/// A hover in the cruise of a quadplane was power of its wing.
TEST(MavlinkFamily, KnowsTheHoverOfQuadplanesByTheirMode) {
    const auto series_in = [](std::uint32_t mode, std::uint8_t autopilot) {
        test::MavlinkSender vehicle;
        std::string log;
        for (std::uint32_t i = 0; i < 120; ++i) {
            log += test::tlog_entry(i, vehicle.packet(0, test::little_endian(i < 60 ? mode : 10U) + '\1' +
                                                             static_cast<char>(autopilot) + "\xD1\x04\x03"));
            log += test::tlog_entry(i, vehicle.battery({12'000}, 360, static_cast<std::int32_t>(i)));
        }
        return read_candidates(FlightFile(written(log)), std::nullopt).front();
    };
    constexpr std::uint32_t qloiter = 19;
    const auto quadplane = series_in(qloiter, 3);
    EXPECT_THAT(quadplane.notes, testing::Contains(HasSubstr("the hover is by the modes")));
    const auto state = select_tracks(quadplane).vtol_state;
    EXPECT_EQ(state_at(state, 30.0), 3.0);
    EXPECT_EQ(state_at(state, 90.0), 4.0);
    EXPECT_THAT(sources_of(series_in(5, 3), "vtol_state"), testing::IsEmpty()) << "a plane";
    EXPECT_THAT(sources_of(series_in(qloiter, 12), "vtol_state"), testing::IsEmpty()) << "another autopilot";
}

TEST(MavlinkFamily, BatteryStatesItsTemperatureOrNone) {
    const auto temperature_c = [](std::int16_t stated) {
        test::MavlinkSender vehicle;
        const auto series =
            series_of(vehicle, [&](int i) { return std::vector{vehicle.battery({12'000}, 1'000, 10 * i, 0, stated)}; });
        return select_tracks(series).battery_temperature_c;
    };
    EXPECT_NEAR(first_value(temperature_c(-1250)).value(), -12.5, 1e-9);
    EXPECT_EQ(temperature_c(2150).source, "BATTERY_STATUS.temperature");
    EXPECT_TRUE(temperature_c(32767).empty());
    EXPECT_TRUE(temperature_c(0).empty());
}

TEST(MavlinkFamily, TakesTheStatusWhereTheBatteryHasNoCurrent) {
    test::MavlinkSender vehicle;
    const auto series = series_of(vehicle, [&](int) {
        return std::vector{vehicle.battery({4'000}, -1, -1), vehicle.status(11'000, 900)};
    });
    EXPECT_NEAR(select_tracks(series).power_w.value.front(), 99.0, 1e-9);
}

/// It was "a pack of its own, perhaps", and its counter was lost, which shows the energy of gaps.
TEST(MavlinkFamily, TheCounterOfABatteryWithoutCurrentIsThatOfTheStatus) {
    test::MavlinkSender vehicle;
    const auto series = series_of(vehicle, [&](int i) {
        return std::vector{vehicle.battery({16'000}, -1, 10 * i),
                           vehicle.status(15'900, static_cast<std::int16_t>(900 + i))};
    });
    const auto data = select_tracks(series);
    EXPECT_NEAR(value_at(data.charge_ah, 50.0), 0.5, 1e-9);
    EXPECT_EQ(data.voltage_v.value.front(), 15.9);
    EXPECT_THAT(data.power_w.notes, testing::IsEmpty());
}

TEST(MavlinkFamily, HasNoPowerWhereTheCurrentIsUnknown) {
    test::MavlinkSender vehicle;
    const auto series = series_of(vehicle, [&](int) { return std::vector{vehicle.status(11'000, -1)}; });
    EXPECT_TRUE(select_tracks(series).power_w.empty());
    EXPECT_FALSE(select_tracks(series).voltage_v.empty());
}

// Without a sensor ArduPilot states an estimate, or the speed over ground, in the same field.
TEST(MavlinkFamily, HasAnAirspeedOnlyWithItsSensor) {
    for (const std::uint32_t sensors : {0U, 16U}) {
        test::MavlinkSender vehicle;
        const auto series = series_of(vehicle, [&](int i) {
            return std::vector{vehicle.status(11'000, 900, sensors),
                               vehicle.hud(13.0F + 0.1F * static_cast<float>(i), 5.0F, 40)};
        });
        EXPECT_EQ(sources_of(series, "airspeed_m_per_s").size(), sensors == 0U ? 0U : 1U);
    }
}

TEST(MavlinkFamily, ReadsTheCapacityOfThePack) {
    test::MavlinkSender vehicle;
    const auto series = series_of(vehicle, [&](int) {
        return std::vector{vehicle.status(11'000, 900), vehicle.parameter("BATT_CAPACITY", 5200.0F)};
    });
    EXPECT_NEAR(series.monitor_capacities_ah.at("0"), 5.2, 1e-9);
}

std::int16_t rising_ca(int i) { return static_cast<std::int16_t>(1'000 + 10 * i); }

TEST(MavlinkFamily, CountsAPackOnceThatTheEscsSeeToo) {
    for (const float kind : {4.0F, 9.0F}) {
        test::MavlinkSender vehicle;
        const auto series = series_of(vehicle, [&](int i) {
            const auto escs_ca = static_cast<std::int16_t>(0.9 * rising_ca(i));
            return std::vector{vehicle.battery({16'000}, rising_ca(i), 10 * i),
                               vehicle.battery({16'000}, escs_ca, 9 * i, 1), vehicle.parameter("BATT_MONITOR", 4.0F),
                               vehicle.parameter("BATT2_MONITOR", kind)};
        });
        EXPECT_NEAR(select_tracks(series).power_w.value.front(), kind == 9.0F ? 160.0 : 304.0, 1e-9);
    }
}

TEST(MavlinkFamily, ReadsTheSecondBatteryOfItsOwnMessage) {
    const auto first_w = [](bool has_status, bool has_second) {
        test::MavlinkSender vehicle;
        const auto series = series_of(vehicle, [&](int i) {
            const auto half_ca = static_cast<std::int16_t>(rising_ca(i) / 2);
            std::vector packets{vehicle.status(16'000, rising_ca(i)), vehicle.battery2(16'000, half_ca)};
            if (has_status) packets.push_back(vehicle.battery({16'000}, rising_ca(i), 10 * i));
            if (has_second) packets.push_back(vehicle.battery({16'000}, half_ca, 5 * i, 1));
            return packets;
        });
        return select_tracks(series).power_w.value.front();
    };
    EXPECT_NEAR(first_w(false, false), 240.0, 1e-9);
    EXPECT_NEAR(first_w(true, false), 240.0, 1e-9);
    EXPECT_NEAR(first_w(true, true), 240.0, 1e-9) << "not twice";
}

TEST(MavlinkFamily, CountsNoBatteryOfAPayload) {
    constexpr std::int16_t no_temperature = 32767;
    const auto first_w = [](std::uint8_t function) {
        test::MavlinkSender vehicle;
        const auto series = series_of(vehicle, [&](int i) {
            return std::vector{vehicle.battery({16'000}, 1'000, 10 * i),
                               vehicle.battery({12'000}, 300, 3 * i, 1, no_temperature, function)};
        });
        EXPECT_EQ(series.notes.size(), function >= 3 ? 1U : 0U);
        return select_tracks(series).power_w.value.front();
    };
    EXPECT_NEAR(first_w(2), 196.0, 1e-9);
    EXPECT_NEAR(first_w(3), 160.0, 1e-9);
    EXPECT_NEAR(first_w(4), 160.0, 1e-9);
}

TEST(MavlinkFamily, TakesTheStatusOfThePackWhereThatOfThePayloadIsTheOnlyOther) {
    test::MavlinkSender vehicle;
    const auto series = series_of(vehicle, [&](int i) {
        return std::vector{vehicle.status(16'000, 1'000), vehicle.battery({12'000}, 300, 3 * i, 0, 32767, 4)};
    });
    EXPECT_NEAR(select_tracks(series).power_w.value.front(), 160.0, 1e-9);
}

TEST(MavlinkFamily, TakesTheStatusThatContinuesWhereTheBatteryHasEnded) {
    test::MavlinkSender vehicle;
    const auto series = series_of(vehicle, [&](int i) {
        std::vector packets{vehicle.status(16'000, rising_ca(i))};
        if (i < 60) packets.push_back(vehicle.battery({16'000}, rising_ca(i), 10 * i));
        return packets;
    });
    EXPECT_NEAR(select_tracks(series).power_w.time_s.back(), 119.0, 1.0);
}

/// A flight of which a message is missing from and to these seconds.
LoadedFlight flight_without(std::uint32_t id, int from_s, int to_s, bool has_heartbeat = true) {
    test::MavlinkSender vehicle;
    std::string log;
    for (int i = 0; i < 300; ++i) {
        const bool flies = i >= 60 && i < 270;
        const double height_m = !flies ? 0.0 : std::min({4.0 * (i - 60), 60.0, 4.0 * (270 - i)});
        const auto current_ca = static_cast<std::int16_t>(flies ? 1'500 + i % 7 : 50);
        const auto add = [&](std::uint32_t of, const std::string& packet) {
            if (of != id || i < from_s || i >= to_s) log += test::tlog_entry(i, packet);
        };
        if (has_heartbeat) add(0, vehicle.heartbeat(2, 3, flies ? 209 : 81));
        add(1, vehicle.status(15'800, current_ca));
        add(147, vehicle.battery({15'800}, current_ca, 4 * std::clamp(i - 60, 0, 210)));
        add(33, vehicle.position(i, height_m));
        add(74, vehicle.hud(0.0F, static_cast<float>(500.0 + height_m), flies ? 50 : 0));
    }
    return load_flight(written(log));
}

/// A message that the station asked for in flight, or that needs a fix, hid the one that has the whole flight: its
/// take-off was missing.
TEST(MavlinkFamily, HasTheWholeFlightWhereOneMessageBeginsOrEndsInIt) {
    constexpr std::uint32_t battery = 147;
    constexpr std::uint32_t position = 33;
    const auto energy_wh = [](const LoadedFlight& flight) {
        const auto& sortie = flight.phases.sorties.front();
        return integrated_energy_wh(flight.data.power_w, sortie.start_s(), sortie.end_s());
    };
    const double whole_wh = energy_wh(flight_without(battery, 0, 0));
    for (const auto& [id, from_s, to_s] : {std::tuple{battery, 0, 150}, {position, 0, 150}, {position, 150, 300}}) {
        const auto flight = flight_without(id, from_s, to_s);
        ASSERT_EQ(flight.phases.sorties.size(), 1U);
        EXPECT_NEAR(flight.phases.sorties.front().start_s(), 60.0, 2.0);
        EXPECT_NEAR(flight.phases.sorties.front().end_s(), 270.0, 2.0);
        EXPECT_NEAR(energy_wh(flight), whole_wh, 0.02 * whole_wh);
    }
}

TEST(MavlinkFamily, HasThePowerOfTheStatusWhereNoHeartbeatShowsThatTheBatteryBeginsInFlight) {
    EXPECT_NEAR(flight_without(147, 0, 150, false).data.power_w.time_s.front(), 0.0, 1.0);
}

TEST(MavlinkFamily, CountsByTheBatteryThatBeginsBeforeTheFlight) {
    const auto flight = flight_without(147, 0, 50);
    EXPECT_THAT(flight.data.power_w.source, HasSubstr("BATTERY_STATUS"));
    EXPECT_FALSE(flight.data.charge_ah.empty());
}

/// A receiver that did not know the week dated a flight to 2019.
TEST(MavlinkFamily, IsDatedByTheStationUntilTheVehicleKnowsTheTime) {
    const auto begin_s = [](double first_s) {
        test::MavlinkSender vehicle;
        const auto series = series_of(vehicle, [&](int i) {
            const auto time_us = static_cast<std::uint64_t>((first_s + i) * 1e6);
            return std::vector{vehicle.status(16'000, rising_ca(i)),
                               vehicle.packet(2, test::little_endian(time_us) + std::string(4, '\1'))};
        });
        return series.start_clock_s.value();
    };
    EXPECT_NEAR(begin_s(315'964'800.0), 1.78e9, 1.0) << "1980";
    EXPECT_NEAR(begin_s(0.0), 1.78e9, 1.0);
    EXPECT_NEAR(begin_s(1.79e9), 1.79e9, 1.0);
    EXPECT_NEAR(begin_s(1.79e9 - 1024.0 * 604'800.0), 1.79e9, 1.0);
}

/// With a battery's message every 45 s, the power was that of it or of the status by turns while the log grew.
TEST(MavlinkFamily, TakesTheStatusWhereTheBatterysMessageIsRare) {
    for (const int every_s : {6, 45}) {
        for (const int end_s : {50, 89, 91, 120}) {
            test::MavlinkSender vehicle;
            const auto series = series_of(vehicle, [&](int i) {
                std::vector<std::string> packets;
                if (i >= end_s) return packets;
                for (int k = 0; k < 2; ++k) packets.push_back(vehicle.status(16'000, rising_ca(i)));
                if (i % every_s == 3) packets.push_back(vehicle.battery({15'000}, rising_ca(i), 10 * i, 0, 2'500));
                return packets;
            });
            const auto data = select_tracks(series);
            EXPECT_EQ(data.power_w.time_s.size(), static_cast<std::size_t>(end_s));
            EXPECT_EQ(value_at(data.voltage_v, 40.0), 16.0);
            EXPECT_EQ(data.battery_temperature_c.value.front(), 25.0);
            EXPECT_TRUE(data.charge_ah.empty()) << "a rare counter differs from the energy of a phase";
            EXPECT_THAT(series.notes, testing::Contains(HasSubstr("the power is by SYS_STATUS")));
        }
    }
}

/// Half of a flight was "missing", or interpolated, that the status has.
TEST(MavlinkFamily, TakesTheStatusWhereTheBatterysMessageBeginsLateOrPauses) {
    const auto power_of = [](int silent_from_s, int silent_until_s, const char* note) {
        test::MavlinkSender vehicle;
        const auto series = series_of(vehicle, [&](int i) {
            std::vector packets{vehicle.status(16'000, rising_ca(i))};
            if (i < silent_from_s || i >= silent_until_s)
                packets.push_back(vehicle.battery({15'000}, rising_ca(i), 10 * i, 0, 2'500));
            return packets;
        });
        EXPECT_EQ(std::ranges::any_of(series.notes, [&](const auto& of) { return of.find(note) != of.npos; }),
                  silent_until_s - silent_from_s > 8);
        return select_tracks(series);
    };
    for (const auto& data :
         {power_of(0, 60, "silent for 60 s from 0 s on"), power_of(40, 80, "silent for 41 s from 39")}) {
        EXPECT_EQ(data.power_w.source, "SYS_STATUS.voltage_battery * SYS_STATUS.current_battery");
        EXPECT_EQ(data.power_w.time_s.size(), 120U);
        EXPECT_EQ(data.battery_temperature_c.value.front(), 25.0);
        EXPECT_TRUE(data.charge_ah.empty());
    }
    EXPECT_EQ(value_at(power_of(0, 8, "silent").voltage_v, 40.0), 15.0) << "from before the flight on";
}

TEST(MavlinkFamily, FurtherCellsThatAreUnknownAreNone) {
    test::MavlinkSender vehicle;
    const auto series = series_of(vehicle, [&](int i) {
        // time_remaining, charge_state, voltages_ext, mode and fault_bitmask
        auto payload = test::little_endian(std::int32_t{i}) + test::little_endian(std::int32_t{-1}) +
                       test::little_endian(std::int16_t{32767});
        for (int cell = 0; cell < 10; ++cell)
            payload += test::little_endian(static_cast<std::uint16_t>(cell < 4 ? 4'000 : 65'535));
        payload += test::little_endian(rising_ca(i)) + std::string{'\0', '\1', '\1', '\62'} + std::string(5, '\0') +
                   std::string(8, '\xFF') + std::string(5, '\1');
        return std::vector{vehicle.packet(147, payload)};
    });
    EXPECT_EQ(select_tracks(series).voltage_v.value.front(), 16.0);
}

/// A flight in a simulator was used as a real one.
TEST(MavlinkFamily, HardwareInTheLoopIsASimulation) {
    test::MavlinkSender vehicle;
    const auto name_with = [&](std::uint8_t base_mode) {
        return series_of(
                   vehicle,
                   [&](int i) {
                       return std::vector{vehicle.heartbeat(2, 12, base_mode), vehicle.status(16'000, rising_ca(i))};
                   })
            .aircraft_name;
    };
    EXPECT_EQ(name_with(209), "ArduCopter") << "by the first heartbeat";
    EXPECT_EQ(name_with(209 | 32), "ArduCopter HITL");
}

TEST(MavlinkFamily, CompletesThePackOfMoreThanTenCells) {
    const auto voltage_v = [](std::size_t cells, std::uint16_t status_mv, std::size_t notes) {
        test::MavlinkSender vehicle;
        const auto series = series_of(vehicle, [&](int i) {
            return std::vector{vehicle.battery(std::vector<std::uint16_t>(cells, 4'000), 1'000, 10 * i),
                               vehicle.status(status_mv, 1'000)};
        });
        EXPECT_EQ(series.notes.size(), notes);
        return select_tracks(series).voltage_v.value.front();
    };
    EXPECT_NEAR(voltage_v(10, 48'100, 1), 48.0, 1e-9);
    EXPECT_NEAR(voltage_v(10, 40'900, 0), 40.0, 1e-9) << "two sensors";
    EXPECT_NEAR(voltage_v(6, 28'000, 0), 24.0, 1e-9) << "all of its cells";
}

TEST(MavlinkFamily, VehiclesOfOneNumberThatAreFlownInTurnAreRecordings) {
    std::string log;
    test::MavlinkSender vehicle;
    for (const int begin : {0, 300})
        for (int i = begin; i < begin + 100; ++i) {
            log += test::tlog_entry(i, vehicle.heartbeat(begin == 0 ? 2 : 1)) +
                   test::tlog_entry(i, vehicle.position(i - begin + 50, 3.0)) +
                   test::tlog_entry(i, vehicle.status(begin == 0 ? 16'000 : 12'000, rising_ca(i)));
        }
    const auto recordings = read_recordings(FlightFile(written(log)), std::nullopt, false);
    ASSERT_EQ(recordings.size(), 2U);
    EXPECT_EQ(recordings[0].front().aircraft_name, "ArduCopter");
    EXPECT_EQ(recordings[1].front().aircraft_name, "ArduPlane");
    EXPECT_EQ(recordings[1].front().flight, "flight@2");
    EXPECT_EQ(value_at(select_tracks(recordings[1].front()).voltage_v, 350.0), 12.0);
}

TEST(MavlinkFamily, AsksWhichOfTwoVehiclesThatFlew) {
    const auto log = test::tlog_of_flight({1, 1}) + test::tlog_of_flight({2, 1});
    EXPECT_THAT(test::rejected([&] { load_flight(written(log)); }), HasSubstr("--aircraft"));
    LoadOptions options;
    options.aircraft = "ArduCopter 2";
    EXPECT_EQ(load_flight(written(log), options).series.aircraft_id, "2");
}

/// A vehicle with a serial number was found by that and by its name alone.
TEST(MavlinkFamily, FindsOneOfTwoVehiclesByItsNumberToo) {
    test::MavlinkSender second{2, 1};
    const auto version = second.packet(148, std::string(8, '\0') + "ABCDEFGH" + std::string(44, '\0'));
    const auto log = test::tlog_of_flight({1, 1}) + test::tlog_entry(0.0, version) + test::tlog_of_flight(second);
    LoadOptions options;
    for (const auto* name : {"2", "ArduCopter 2", "4847464544434241"}) {
        options.aircraft = name;
        EXPECT_EQ(load_flight(written(log), options).series.aircraft_id, "4847464544434241");
    }
    options.aircraft = "22";
    EXPECT_THAT(test::rejected([&] { load_flight(written(log), options); }), HasSubstr("22 sent nothing"));
}

}  // namespace
}  // namespace flightwatt::flight
