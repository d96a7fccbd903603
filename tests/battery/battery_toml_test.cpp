// Battery files.

#include "battery/battery_toml.h"

#include "helpers/rejected.h"

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

using test::rejected;

const std::string pack_toml = R"(name = "pack"
model = "thevenin"
capacity_ah = 2.0
resistance_ohm = 0.08
rc_resistance_ohm = 0.05
rc_time_constant_s = 25.0

[open_circuit]
soc_percent = [0.0, 50.0, 100.0]
voltage_v = [10.0, 11.4, 12.5]
standard_error_v = [0.2, 0.01, 0.02]

# 95 %
[intervals]
resistance_ohm = [0.07, 0.09]
rc_time_constant_s = [20.0, 31.0]
)";

TEST(BatteryToml, IsWrittenAsItIsRead) {
    const auto pack = battery_from(parse_toml(pack_toml, "b.toml"));
    EXPECT_EQ(to_toml(pack), "format = 1\n" + pack_toml);
    EXPECT_EQ(pack.intervals.resistance_ohm, (Interval{0.07, 0.09}));
    EXPECT_FALSE(pack.intervals.capacity_ah);
    EXPECT_EQ(pack.intervals.open_circuit_standard_error_v.size(), 3U);
    EXPECT_DOUBLE_EQ(open_circuit_voltage_v(pack, 75.0), 11.95);
    EXPECT_EQ(open_circuit_voltage_v(pack, 100.0), 12.5);
    EXPECT_EQ(open_circuit_voltage_v(pack, 0.0), 10.0);
    EXPECT_DOUBLE_EQ(terminal_voltage_v(pack, {50.0, 0.1}, 2.0), 11.4 - 0.1 - 0.16);
}

/// The pack with what its flights indicate, before its intervals.
std::string with_estimate(const std::string& lines) {
    auto text = pack_toml;
    return text.insert(text.find("\n# 95 %"),
                       "\n# The capacity that the flights indicate, and the curve over it\n"
                       "[flight_estimate]\n" +
                           lines);
}

TEST(BatteryToml, HoldsWhatTheFlightsIndicate) {
    auto text = with_estimate(
        "capacity_ah = 1.5\ncapacity_interval_ah = [1.2, 1.9]\nflights = [\"f1\", \"f2\"]\n"
        "soc_percent = [0.0, 40.0, 100.0]\nvoltage_v = [10.1, 11.4, 12.5]\n");
    text.insert(text.find("rc_resistance_ohm"), "cells = 3\n");
    const auto pack = battery_from(parse_toml(text, "b.toml"));
    EXPECT_EQ(to_toml(pack), "format = 1\n" + text);
    EXPECT_EQ(pack.cells, 3);
    ASSERT_TRUE(pack.flight_estimate);
    EXPECT_EQ(pack.flight_estimate->flights, (std::vector<std::string>{"f1", "f2"}));
    const auto estimated = estimated_by_flights(pack);
    ASSERT_TRUE(estimated);
    EXPECT_EQ(estimated->capacity_ah, 1.5);
    EXPECT_EQ(estimated->intervals.capacity_ah, (Interval{1.2, 1.9}));
    EXPECT_EQ(open_circuit_voltage_v(*estimated, 40.0), 11.4) << "their curve";
    EXPECT_EQ(estimated->resistance_ohm, pack.resistance_ohm);
    const auto without_curve =
        battery_from(parse_toml(with_estimate("capacity_ah = 1.5\ncapacity_interval_ah = [1.2, 1.9]\n"), "b.toml"));
    EXPECT_EQ(open_circuit_voltage_v(estimated_by_flights(without_curve).value(), 50.0), 11.4) << "the pack's own";
}

TEST(BatteryToml, HoldsTheMonitorsOfPacksAndTheirParts) {
    const auto with = [](const std::string& lines) {
        auto text = pack_toml;
        text.insert(text.find("rc_resistance_ohm"), lines);
        return text;
    };
    const auto of = [&](const std::string& lines) { return battery_from(parse_toml(with(lines), "b.toml")); };
    using Monitors = std::vector<flight::MonitorShare>;
    const std::string known = "monitors = [1, 3]\nmonitor_percent = [60.0, 40.0]\n";
    EXPECT_EQ(of(known).monitors, (Monitors{{1, 0.6}, {3, 0.4}}));
    EXPECT_EQ(to_toml(of(known)), "format = 1\n" + with(known));
    EXPECT_EQ(of("monitors = [1, 2]\n").monitors, (Monitors{{1, 0.0}, {2, 0.0}}));
    EXPECT_EQ(to_toml(of("monitors = [1, 2]\n")), "format = 1\n" + with("monitors = [1, 2]\n"));
    for (const auto* wrong :
         {"monitors = [0]\n", "monitors = [1.5]\n", "monitors = [1, 101]\n",
          "monitors = [1, 2]\nmonitor_percent = [100]\n", "monitors = [1, 2]\nmonitor_percent = [60, 60]\n",
          "monitors = [1, 2]\nmonitor_percent = [110, -10]\n", "monitor_percent = [100]\n"})
        EXPECT_NE(rejected([&] { of(wrong); }), "") << wrong;
}

TEST(BatteryToml, RefusesWhatNoFlightsIndicate) {
    const auto of = [](const std::string& lines) {
        return rejected([&] { battery_from(parse_toml(with_estimate(lines), "b.toml")); });
    };
    EXPECT_EQ(of("capacity_ah = 1.5\ncapacity_interval_ah = [1.6, 1.9]\n"),
              "b.toml:16:1: the interval does not contain capacity_interval_ah = 1.5; expected [LOW, HIGH]");
    EXPECT_NE(of("capacity_ah = 1.5\n"), "") << "its interval is missing";
    EXPECT_NE(of("capacity_ah = 0\ncapacity_interval_ah = [0, 1.9]\n"), "");
    EXPECT_NE(of("capacity_ah = 1.5\ncapacity_interval_ah = [1.2, 1.9]\nsoc_percent = [0, 100]\n"), "");
    EXPECT_NE(of("capacity_ah = 1.5\ncapacity_interval_ah = [1.2, 1.9]\nlow = 1\n"), "");
}

TEST(BatteryToml, SaysHowFlightsDiffer) {
    const std::string between =
        "\n# variability between flights\n[between_flights]\nflights = 2\nresistance_sd_ohm = 0.012\n";
    const auto pack = battery_from(parse_toml(pack_toml + between, "b.toml"));
    EXPECT_EQ(pack.intervals.resistance_scatter, (ResistanceScatter{0.012, 2}));
    EXPECT_EQ(to_toml(pack), "format = 1\n" + pack_toml + between);
    EXPECT_FALSE(battery_from(parse_toml(pack_toml, "b.toml")).intervals.resistance_scatter) << "files of before";
    const auto of = [&](const std::string& from, const std::string& to) {
        auto text = pack_toml + between;
        text.replace(text.find(from), from.size(), to);
        return rejected([&] { battery_from(parse_toml(text, "b.toml")); });
    };
    EXPECT_EQ(of("flights = 2", "flights = 1"), "b.toml:20:1: flights = 1, expected a whole number, 2 or more");
    EXPECT_EQ(of("sd_ohm = 0.012", "sd_ohm = -0.012"), "b.toml:21:1: resistance_sd_ohm = -0.012, expected 0 or more");
}

TEST(BatteryToml, RefusesWhatIsNoBattery) {
    const auto of = [](const std::string& from, const std::string& to) {
        auto text = pack_toml;
        text.replace(text.find(from), from.size(), to);
        return rejected([&] { battery_from(parse_toml(text, "b.toml")); });
    };
    EXPECT_EQ(of("thevenin", "rint"), "b.toml:2:1: there is no battery model 'rint'; it is \"paper\" or \"thevenin\"");
    EXPECT_EQ(of("[0.0, 50.0, 100.0]", "[0.0, 50.0, 99.0]"),
              "b.toml:9:1: soc_percent does not rise from 0 to 100; expected [0, ..., 100]");
    EXPECT_EQ(of("[10.0, 11.4, 12.5]", "[10.0, 12.5]"),
              "b.toml:10:1: 2 voltages for 3 states of charge; expected one each");
    EXPECT_EQ(of("[10.0, 11.4, 12.5]", "[10.0, 11.4, 11.3]"),
              "b.toml:10:1: the open-circuit voltage is not positive, or falls as charge rises; expected "
              "values in the order of soc_percent, none below the one before");
    EXPECT_EQ(of("25.0", "0.01"),
              "b.toml:6:1: rc_time_constant_s = 0.01, expected 0.1 to 100000; a faster RC "
              "pair is part of resistance_ohm");
    EXPECT_EQ(of("[0.07, 0.09]", "[0.09, 0.1]"),
              "b.toml:15:1: the interval does not contain resistance_ohm = 0.08; expected [LOW, HIGH]");
    EXPECT_NE(of("name = \"pack\"", "voltage_v = 11.1"), "");
    EXPECT_NE(of("[0.2, 0.01, 0.02]", "[0.2, -0.01, 0.02]"), "");
}

TEST(BatteryToml, ReadsThePaperBattery) {
    const auto battery = read_battery(test::source_dir() / "fits" / "battery" / "paper.toml");
    EXPECT_EQ(battery.name, "paper");
    EXPECT_EQ(battery.capacity_ah, 3.2);
    // 100 % is 39.356 kJ in the figures.
    EXPECT_NEAR(battery.voltage_v * battery.capacity_ah * 3600.0, 39356.0, 10.0);
}

TEST(BatteryToml, RefusesWhatIsNoPaperBattery) {
    const auto of = [](const std::string& text) { return rejected([&] { battery_from(parse_toml(text, "b.toml")); }); };
    EXPECT_EQ(of("voltage_v = 4\nresistance_ohm = 0\ncapacity_ah = 1\n"), "");
    EXPECT_EQ(of("voltage_v = 0\nresistance_ohm = 0\ncapacity_ah = 1\n"),
              "b.toml:1:1: voltage_v = 0, expected more than 0 and at most 1000000");
    EXPECT_EQ(of("voltage_v = 4\nresistance_ohm = -0.1\ncapacity_ah = 1\n"),
              "b.toml:2:1: resistance_ohm = -0.1, expected 0 or more");
    EXPECT_EQ(of("voltage_v = 4\nresistance_ohm = 0\ncapacity_ah = -1\n"),
              "b.toml:3:1: capacity_ah = -1, expected more than 0 and at most 200; the unit is Ah: 5000 mAh is 5 Ah");
    EXPECT_EQ(of("voltage_v = 4\nresistance_ohm = 0\ncapacity_ah = 201\n"),
              "b.toml:3:1: capacity_ah = 201, expected more than 0 and at most 200; the unit is Ah: 5000 mAh is 5 Ah");
    EXPECT_EQ(of("voltage_v = 4\nresistance_ohm = 0\ncapacity_ah = 200\n"), "");
    EXPECT_EQ(of("voltage_v = 4\nresistance_ohm = 0\ncapacity_mah = 1\n"),
              "b.toml:3:1: has no key 'capacity_ah'; 'capacity_mah' is here; was that meant?");
    EXPECT_EQ(of("voltage_v = 4\nresistance_ohm = 0\ncapacity_ah = 1\ncells = 0\n"),
              "b.toml:4:1: cells = 0, expected 1 to 100");
    EXPECT_EQ(of("voltage_v = 4\nresistance_ohm = 0\ncapacity_ah = 1\ncells = 100\n"), "");
    EXPECT_NE(of("voltage_v = 4\nresistance_ohm = 0\ncapacity_ah = 1\ncells = 101\n"), "");
    EXPECT_EQ(of("voltage_v = 4\nresistance_ohm = 0\ncapacity_ah = 1\ncolour = 3\n"),
              "b.toml:4:1: unknown key 'colour'; known keys: between_flights, capacity_ah, cells, intervals, model, "
              "monitors, name, resistance_ohm, voltage_v");
}

TEST(BatteryToml, HasAFormatThatIsKnown) {
    const auto folder = test::scratch_dir();
    const auto path = test::write_text(folder / "b.toml", "format = 2\nvoltage_v = 10\n");
    EXPECT_NE(rejected([&] { read_battery(path); }, folder).find("b.toml:1:1: format = 2 is newer"), std::string::npos);
    test::write_text(path, to_toml({"pack", 10.0, 0.0, 1.0}));
    EXPECT_EQ(read_battery(path).capacity_ah, 1.0);
}

}  // namespace
}  // namespace flightwatt::battery
