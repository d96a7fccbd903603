#include "flight/telemetry_series.h"

#include "base/error.h"
#include "base/number.h"
#include "flight/load_flight.h"
#include "flight/series_file.h"
#include "helpers/damaged_logs.h"
#include "helpers/rejected.h"
#include "helpers/selected_tracks.h"
#include "helpers/test_paths.h"
#include "telemetry/log_reader.h"

#include <algorithm>
#include <fstream>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::HasSubstr;

/// The first sample log with the clock set by `by_s` from `from_s` on, once.
std::string with_jump(double from_s, double by_s) {
    return test::damaged_sample([&](test::Words& words) {
        const double time_s = number_or_nan(words[0]);
        if (time_s > from_s) words[0] = fmt::format("{:.3f}", time_s + by_s);
    });
}

TEST(ClockCheck, RefusesAClockThatRunsBackByLessThanAMinute) {
    for (const double by_s : {-8.0, -20.0, -50.0, -59.0}) {
        SCOPED_TRACE(by_s);
        EXPECT_THAT(test::rejected([&] { test::examined(with_jump(300.0, by_s)); }), HasSubstr("the clock runs back"));
    }
}

TEST(ClockCheck, WarnsOfAClockThatIsSetBackBySeconds) {
    for (const auto& [from_s, by_s] : {std::pair{300.0, -1.0}, {300.0, -2.0}, {300.0, -3.0}, {400.0, -5.0}}) {
        SCOPED_TRACE(by_s);
        const auto loaded = test::examined(with_jump(from_s, by_s));
        EXPECT_THAT(texts_of(loaded.diagnostics),
                    testing::Contains(testing::ContainsRegex(
                        fmt::format("the clock is set back by [{}{}]\\.[0-9] s at ({}|{})\\.[0-9] s, so that times "
                                    "occur twice: [0-9]+ lines$",
                                    -by_s - 1.0, -by_s, from_s - 1.0, from_s))));
        EXPECT_EQ(parse_series_csv(to_csv(loaded.series), "x.csv").skipped, loaded.series.skipped);
    }
}

TEST(ClockCheck, RefusesAStretchThatLiesOverAnother) {
    const auto text = test::damaged_sample([](test::Words& words) {
        const double time_s = number_or_nan(words[0]);
        if (time_s > 300.0 && time_s < 330.0) words[0] = fmt::format("{:.3f}", time_s + 30.0);
    });
    EXPECT_THAT(test::rejected([&] { test::examined(text); }), HasSubstr("the clock runs back"));
}

TEST(ClockCheck, TakesDoubledLinesAndLinesOutOfOrderAsTheyAre) {
    const auto lines = test::lines_of(test::damaged_sample([](test::Words&) {}));
    const auto joined = [](const std::vector<std::string>& parts) {
        std::string text;
        for (const auto& part : parts) text += part;
        return text;
    };
    const auto sound = test::examined(joined(lines));
    std::mt19937 random(5);
    auto shuffled = lines;
    for (std::size_t i = 0; i + 400 < lines.size(); i += 400) {
        std::shuffle(shuffled.begin() + static_cast<std::ptrdiff_t>(i),
                     shuffled.begin() + static_cast<std::ptrdiff_t>(i + 400), random);
    }
    auto far_apart = lines;
    for (std::size_t i = 0; i + 1300 < lines.size(); i += 170) std::swap(far_apart[i], far_apart[i + 500]);
    auto block = lines;
    std::rotate(block.begin() + 5000, block.begin() + 5500, block.begin() + 6000);
    auto doubled = lines;
    doubled.insert(doubled.begin() + 9000, lines.begin() + 8200, lines.begin() + 9000);
    for (const auto& changed : {shuffled, far_apart, block, doubled}) {
        const auto loaded = test::examined(joined(changed));
        EXPECT_NEAR(test::energy_in_flight_wh(loaded), test::energy_in_flight_wh(sound), 1e-6);
        EXPECT_EQ(texts_of(loaded.diagnostics), texts_of(sound.diagnostics));
    }
}

TEST(ClockCheck, KnowsNothingOfWhatComesLater) {
    const auto text = with_jump(300.0, -20.0);
    const auto series = test::all_series(text, std::nullopt).at(0);
    ASSERT_TRUE(series.clock_restart);
    for (const double until_s : {283.0, 285.0, 290.0, 296.0, 300.0, 400.0}) {
        const auto cut = test::all_series(test::cut_log(text, until_s).before, std::nullopt).at(0);
        auto expected = truncate_series(series, until_s).clock_restart;
        ASSERT_EQ(cut.clock_restart.has_value(), expected.has_value()) << until_s;
        if (expected) expected->from_s = cut.clock_restart->from_s;  // the latest time so far, for the message alone
        EXPECT_EQ(cut.clock_restart, expected) << until_s;
    }
}

/// Whether the clock runs back of a message that came at these times, in this order.
bool runs_back(const std::vector<double>& time_s) {
    telemetry::SenderLog sender{"7", {{"GPS", time_s, {}}}};
    return find_clock_restart(sender).has_value();
}

/// Appends so many times.
void add(std::vector<double>& time_s, int count, double from_s, double interval_s) {
    for (int i = 0; i < count; ++i) time_s.push_back(from_s + interval_s * i);
}

TEST(ClockCheck, TakesOneRowOfMoreThanAMinuteBeforeForARestart) {
    std::vector<double> time_s;
    add(time_s, 101, 0.0, 1.0);
    time_s.push_back(40.5);
    EXPECT_FALSE(runs_back(time_s)) << "59.5 s";
    time_s.back() = 39.5;
    EXPECT_TRUE(runs_back(time_s)) << "60.5 s";
}

TEST(ClockCheck, TakesTenRowsOfMoreThanTwoSecondsBeforeForAnOverlap) {
    const auto with_late = [](int rows, double by_s) {
        std::vector<double> time_s;
        add(time_s, 30, 0.0, 0.1);
        for (int i = 0; i < rows; ++i) {
            add(time_s, 10, 3.0 + i, 0.1);
            time_s.push_back(3.9 + i - by_s);
        }
        return runs_back(time_s);
    };
    EXPECT_TRUE(with_late(10, 2.05));
    EXPECT_FALSE(with_late(9, 2.05));
    EXPECT_FALSE(with_late(10, 1.95));
}

TEST(ClockCheck, TakesRowsForAnOverlapWhereNoneWasMissing) {
    const auto in_pauses_of = [](double pause_s) {
        std::vector<double> time_s;
        for (int i = 0; i < 15; ++i) add(time_s, 6, (2.5 + pause_s) * i, 0.5);
        add(time_s, 10, 5.0 + 1.5 * pause_s, 2.5 + pause_s);
        return runs_back(time_s);
    };
    EXPECT_TRUE(in_pauses_of(0.7)) << "1.4 intervals";
    EXPECT_FALSE(in_pauses_of(0.8));
    const auto after_rows = [](int rows) {
        std::vector<double> time_s;
        add(time_s, 20, 0.0, 1.0);
        add(time_s, 10, rows - 0.5, 0.01);
        return runs_back(time_s);
    };
    EXPECT_FALSE(after_rows(5)) << "the interval is not known";
    EXPECT_TRUE(after_rows(6));
    // The interval is that which a tenth of the last hundred do not exceed.
    const auto after_slow_rows = [](int rows) {
        std::vector<double> time_s;
        add(time_s, 51, 0.0, 0.1);
        add(time_s, rows + 5, 6.0, 1.0);
        add(time_s, 10, 5.5 + rows, 0.01);
        return runs_back(time_s);
    };
    EXPECT_FALSE(after_slow_rows(89));
    EXPECT_TRUE(after_slow_rows(90));
}

using testing::Contains;
using testing::ElementsAre;

FlightSeries series_of(const std::string& text, const std::string& id = "20") {
    auto series = flight_series(parse_telemetry(text, "x.data", std::nullopt, flight_messages()), id);
    require_power(select_tracks(series));
    return series;
}

std::vector<double> on_power_clock(const FlightSeries& series, const std::string& name) {
    return sample_selected_track(series, name, power_track(series).time_s);
}

std::string source_of(const FlightSeries& series, const std::string& name) { return select_track(series, name).source; }

TEST(TelemetrySeries, TakesPowerFromEnergyAndEverythingElseOntoItsClock) {
    const auto series = series_of(
        "2. 20 ENERGY 50 11. 2. 22. 0.2 2.\n"
        "1. 20 ENERGY 40 12. 1. 12. 0.1 1.\n"
        "1.5 20 ESTIMATOR 100. 0.\n"
        "2.5 20 ESTIMATOR 110. 0.\n"
        "2. 20 ENERGY 60 11. 4. 44. 0.3 3.\n");
    EXPECT_THAT(power_track(series).time_s, ElementsAre(1, 2));
    EXPECT_THAT(on_power_clock(series, "power_w"), ElementsAre(12, 33)) << "duplicates are averaged";
    EXPECT_THAT(on_power_clock(series, "charge_ah"), ElementsAre(0.1, 0.3)) << "of counters the latest counts";
    EXPECT_THAT(on_power_clock(series, "throttle_percent"), ElementsAre(40, 55));
    EXPECT_THAT(on_power_clock(series, "altitude_m"), ElementsAre(100, 105));
    EXPECT_EQ(source_of(series, "power_w"), "ENERGY.power");
    EXPECT_EQ(source_of(series, "altitude_m"), "ESTIMATOR.z");
}

TEST(TelemetrySeries, KnowsTheAirTemperatureAndTheClock) {
    const std::string log =
        "<configuration time_of_day=\"1594356783.16\"><protocol><msg_class name=\"telemetry\"><message name=\"AIR_DATA\" "
        "id=\"222\"><field name=\"pressure\" type=\"float\" unit=\"Pa\"/><field name=\"temp\" type=\"float\" "
        "unit=\"deg celcius\"/></message></msg_class></protocol></configuration>";
    const auto series =
        flight_series(parse_telemetry("1. 20 AIR_DATA 100000. 20.5\n2. 20 AIR_DATA 100000. 21.5\n", "x.data",
                                      telemetry::parse_log_configuration(log, "x.log"), flight_messages()),
                      "20");
    EXPECT_THAT(select_track(series, "air_temperature_c").value, ElementsAre(20.5, 21.5));
    EXPECT_EQ(series.start_clock_s, 1594356783.16);
    EXPECT_EQ(truncate_series(series, 1.5).start_clock_s, series.start_clock_s);
    EXPECT_THAT(select_track(truncate_series(series, 1.5), "air_temperature_c").value, ElementsAre(20.5));
}

/// The series of a log whose .log defines POWER_DEVICE with these attributes of current and voltage.
FlightSeries with_power_device(const std::string& current, const std::string& voltage) {
    const auto log =
        "<configuration><conf></conf><protocol><msg_class name=\"telemetry\"><message name=\"POWER_DEVICE\" id=\"19\">"
        "<field name=\"node_id\" type=\"uint8\"/><field name=\"circuit\" type=\"uint8\"/><field type=\"float\" " +
        current + "/><field type=\"float\" " + voltage + "/></message></msg_class></protocol></configuration>";
    return flight_series(parse_telemetry("1 20 POWER_DEVICE 1 0 2. 11.\n2 20 POWER_DEVICE 1 0 3. 11.\n", "x.data",
                                         telemetry::parse_log_configuration(log, "x.log"), flight_messages()),
                         "20");
}

TEST(TelemetrySeries, AssumesTheUnitsThatPaparazziLeavesOutAndSaysSo) {
    const auto series = with_power_device("name=\"current\"", "name=\"voltage\"");
    EXPECT_THAT(power_track(series).value, ElementsAre(22, 33));
    const auto assumed =
        "units in the .log: POWER_DEVICE: current has no unit: A is assumed, voltage has no unit: V is assumed";
    EXPECT_THAT(warnings_of(series), Contains(assumed));
    EXPECT_THAT(warnings_of(truncate_series(series, 0.5)), testing::IsEmpty());
    EXPECT_THAT(power_track(with_power_device("name=\"current\" unit=\"mA\"", "name=\"voltage\"")).value,
                ElementsAre(0.022, 0.033));
}

TEST(TelemetrySeries, SaysWhyAMessageTellsNoPower) {
    const auto strange = with_power_device("name=\"current\" unit=\"furlong\"", "name=\"voltage\" unit=\"V\"");
    EXPECT_EQ(no_power_reason(select_tracks(strange)),
              "POWER_DEVICE has no power in W, nor current in A with voltage; the .log: POWER_DEVICE: current "
              "has the unknown unit 'furlong'");
    const auto renamed = with_power_device("name=\"current_2\"", "name=\"voltage\" unit=\"V\"");
    EXPECT_THAT(no_power_reason(select_tracks(renamed)), HasSubstr("POWER_DEVICE has no power in W"));
}

TEST(TelemetrySeries, FallsBackToVoltageTimesCurrent) {
    const auto energy = series_of("1 20 ENERGY 11. 2. 5 0.\n2 20 ENERGY 11. 3. 6 0.\n");
    EXPECT_THAT(on_power_clock(energy, "power_w"), ElementsAre(22, 33));
    EXPECT_EQ(source_of(energy, "power_w"), "ENERGY.bat * ENERGY.amp");
    EXPECT_THAT(on_power_clock(energy, "charge_ah"), ElementsAre(0.005, 0.006)) << "an energy in mAh is a charge";
    EXPECT_TRUE(on_power_clock(energy, "energy_wh").empty());
    const auto bat = series_of("1 20 BAT 4800 110 200 5 0 5 5 7\n2 20 BAT 9600 110 300 5 0 5 5 7\n");
    EXPECT_THAT(on_power_clock(bat, "power_w"), ElementsAre(22, 33));
    EXPECT_THAT(on_power_clock(bat, "throttle_percent"), ElementsAre(50, 100));
    EXPECT_EQ(source_of(bat, "power_w"), "BAT.voltage * BAT.amps");
}

TEST(TelemetrySeries, DoesNotTrustAnAssumedPowerThatContradictsVoltageTimesCurrent) {
    std::string text;
    for (int i = 0; i < 20; ++i) text += fmt::format("{} 20 ENERGY 11. 2. 7 {}.\n", i, 500 + i);
    const auto series = series_of(text);
    EXPECT_EQ(on_power_clock(series, "power_w")[0], 22.0);
    EXPECT_THAT(warnings_of(series), Contains(HasSubstr("ENERGY.power is not voltage times current")));
}

TEST(TelemetrySeries, RefusesAClockThatBeginsAnew) {
    try {
        series_of(
            "1 20 ENERGY 0 12. 1. 12. 0. 0.\n900 20 ENERGY 0 12. 1. 12. 0. 0.\n5 20 ENERGY 0 12. 1. 12. 0. "
            "0.\n");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("the clock runs back from 900.000 to 5.000 s"));
    }
}

TEST(TelemetrySeries, SumsMotorsAndDevices) {
    const auto esc = series_of(
        "1 20 ESC 1. 12. 12. 0. 0. 0. 0\n1 20 ESC 2. 12. 24. 0. 0. 0. 1\n"
        "2 20 ESC 1. 12. 12. 0. 0. 0. 0\n2 20 ESC 4. 12. 48. 0. 0. 0. 1\n");
    EXPECT_THAT(on_power_clock(esc, "power_w"), ElementsAre(36, 60));
    EXPECT_THAT(source_of(esc, "power_w"), HasSubstr("summed over 2 devices"));
    const auto device = series_of("1 20 POWER_DEVICE 1 0 2. 12.\n2 20 POWER_DEVICE 1 0 3. 12.\n");
    EXPECT_THAT(on_power_clock(device, "power_w"), ElementsAre(24, 36));
    EXPECT_THAT(on_power_clock(esc, "current_a"), ElementsAre(3, 5));
    EXPECT_EQ(source_of(esc, "current_a"), "ESC.amps, summed over 2 devices");
    EXPECT_THAT(on_power_clock(device, "current_a"), ElementsAre(2, 3));
}

TEST(TelemetrySeries, UsesAltitudeThatVaries) {
    const std::string power = "1 20 ENERGY 0 12. 1. 12. 0. 0.\n2 20 ENERGY 0 12. 1. 12. 0. 0.\n";
    const auto gps = series_of(power +
                               "1 20 ESTIMATOR 0. 0.\n2 20 ESTIMATOR 0. 0.\n"
                               "1 20 GPS 3 1 1 0 20000 0 0 1 1 31 0\n2 20 GPS 3 1 1 0 21000 0 0 1 1 31 0\n");
    EXPECT_THAT(on_power_clock(gps, "altitude_m"), ElementsAre(20, 21));
    EXPECT_EQ(source_of(gps, "altitude_m"), "GPS.alt");
    const auto rotorcraft = series_of(power +
                                      "1 20 ROTORCRAFT_FP 0 0 256 0 0 0 0 0 0 0 0 0 0 4800 1\n"
                                      "2 20 ROTORCRAFT_FP 0 0 512 0 0 0 0 0 0 0 0 0 0 4800 2\n");
    EXPECT_THAT(on_power_clock(rotorcraft, "altitude_m"), ElementsAre(1, 2));
}

TEST(TelemetrySeries, PositionsWithoutAFixDoNotCount) {
    const auto row = [](int time_s, int mode, int alt_cm) {
        return fmt::format("{0} 20 ENERGY 0 12. 1. 12. 0. 0.\n{0} 20 GPS {1} 1 1 0 {2} 0 0 1 1 31 0\n", time_s, mode,
                           alt_cm);
    };
    const auto series = series_of(row(1, 0, 900000) + row(2, 3, 20000) + row(3, 3, 21000) + row(4, 2, 900000));
    EXPECT_THAT(select_track(series, "altitude_m").value, ElementsAre(20, 21));
    EXPECT_THAT(select_track(series, "altitude_m").time_s, ElementsAre(2, 3));
    const auto fix = select_track(series, "fix");
    EXPECT_EQ(fix.source, "GPS.mode");
    EXPECT_THAT(fix.time_s, ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(fix.value, ElementsAre(0, 1, 1, 0));
}

class ReadFlight : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text) {
        auto path = folder_ / name;
        std::ofstream(path, std::ios::binary) << text;
        return path;
    }
    static std::string refusal(const std::filesystem::path& path, const std::optional<std::string>& id = std::nullopt) {
        try {
            read_flight(path, id);
        } catch (const InputError& error) {
            return to_string(error.where()) + ": " + error.what() + "; " + error.hint();
        }
        return "accepted";
    }
    std::filesystem::path folder_ = test::scratch_dir();
};

std::string flying(int id) {
    std::string text;
    for (int t = 0; t < 20; ++t) {
        text += fmt::format("{0} {1} ENERGY 60 12. 1. 12. 0. 0.\n{0} {1} ESTIMATOR {2}. 0.\n", t, id, 100 + t);
    }
    return text;
}

std::string parked(int id) { return fmt::format("1 {0} ENERGY 0 12. 1. 12. 0. 0.\n1 {0} ESTIMATOR 100. 0.\n", id); }

TEST_F(ReadFlight, AsksWhichAircraftWhereSeveralFlew) {
    const auto two = write("two.data", flying(20) + flying(7));
    EXPECT_THAT(refusal(two), HasSubstr("several aircraft flew: 20, 7; select one with --aircraft ID"));
    EXPECT_EQ(read_flight(two, "7").aircraft_id, "7");
    EXPECT_THAT(refusal(two, "9"), HasSubstr("aircraft 9 sent nothing; the log has 20, 7"));
    EXPECT_EQ(read_flight(write("one.data", parked(7) + flying(20))).aircraft_id, "20");
}

TEST_F(ReadFlight, SaysWhatALogWithoutPowerHolds) {
    EXPECT_THAT(
        refusal(write("a.data", "1 20 ESTIMATOR 1. 0.\n2 20 ATTITUDE 0. 0. 0.\n")),
        HasSubstr(
            "has no measured power of aircraft 20 (assumed ESTIMATOR: 2 fields; assumed ATTITUDE: 3 fields); expected "
            "ENERGY with power, BAT or ENERGY with "
            "current, ESC or POWER_DEVICE; it has ATTITUDE 1, ESTIMATOR 1"));
    EXPECT_THAT(refusal(write("b.data", "1 20 ENERGY 1 12. nan nan 0. 0.\n2 20 ENERGY 1 12. nan nan 0. 0.\n")),
                HasSubstr("ENERGY.power has no two finite values"));
    EXPECT_THAT(refusal(write("c.data", "1 20 ENERGY 1 12. 0. 0. 0. 0.\n2 20 ENERGY 1 12. 0. 0. 0. 0.\n")),
                HasSubstr("ENERGY.power is 0 throughout"));
}

TEST_F(ReadFlight, ReadsASeriesBackExactly) {
    const auto series = read_flight(write("x.data", flying(20)));
    const auto again = read_flight(write("x.csv", to_csv(series)));
    auto expected = series;
    expected.file = again.file;
    EXPECT_EQ(again, expected);
}

TEST_F(ReadFlight, RefusesBadSeriesWithTheirPlace) {
    const auto at = [&](const std::string& text) {
        return refusal(write("s.csv", text)).substr(folder_.string().size());
    };
    EXPECT_EQ(at("time_s,power_w\n1,2\n2,nan\n"), "/s.csv:3:3: power_w is not a finite number: 'nan'; ");
    EXPECT_EQ(at("time_s,power_w\n1,2\n1,3\n"),
              "/s.csv:3:1: time_s = 1 does not rise from 1; sort the rows by time and remove repeated times");
    EXPECT_THAT(at("time_s,power_kw\n1,2\n"), HasSubstr("has no column 'power_w'; its columns are time_s, power_kw"));
    EXPECT_THAT(at("time_s,power_w,altitud_m\n1,2,3\n"), HasSubstr("did you mean 'altitude_m'?"));
    EXPECT_THAT(at("time_s,power_w,altitude_ft\n1,2,3\n"),
                HasSubstr("did you mean 'altitude_m'? its values are in m, not in ft: convert them"));
    EXPECT_THAT(at("time_s,power_w\n1,2\n"), HasSubstr("fewer than two samples"));
    EXPECT_THAT(at("time_s,power_w,power_w\n1,2,3\n2,2,3\n"), HasSubstr("duplicate column 'power_w'"));
}

TEST_F(ReadFlight, ReadsASeriesThatBeginsWithAByteOrderMark) {
    const auto path = write("bom.csv", "\xEF\xBB\xBFtime_s,power_w\n1,2\n2,3\n");
    EXPECT_THAT(power_track(read_flight(path)).value, ElementsAre(2, 3));
}

TEST_F(ReadFlight, RefusesTheRealLogsThatMeasuredNoPower) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto flights = test::shared_dir() / "flights";
    EXPECT_THAT(refusal(flights / "17_07_06__10_21_07_SD.data"), HasSubstr("ENERGY.power is 0 throughout"));
    EXPECT_THAT(refusal(flights / "09_05_13__14_38_13.data"), HasSubstr("BAT has no current"));
}

}  // namespace
}  // namespace flightwatt::flight
