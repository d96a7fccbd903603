// Sensor trees as the boards' kernels arrange them, made by the test.

#include "compute/power_sampler.h"

#include "helpers/rejected.h"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using std::filesystem::path;
using testing::HasSubstr;

class SensorTree : public testing::Test {
  protected:
    path root = test::scratch_dir() / "sys";

    void put(const path& file, const std::string& text) const {
        std::filesystem::create_directories((root / file).parent_path());
        test::write_text(root / file, text + "\n");
    }
    SamplerSettings settings(SamplerKind kind = SamplerKind::automatic) const {
        SamplerSettings result;
        result.kind = kind;
        result.sysfs = root;
        return result;
    }
    double power_w(const SamplerSettings& given) const {
        const auto readings = open_sampler(given).read();
        return readings.size() == 1 ? readings.front().power_w : -1.0;
    }
    void put_iio_channel(const path& device, int channel, const std::string& rail, const std::string& power_mw) const {
        put(device / ("rail_name_" + std::to_string(channel)), rail);
        put(device / ("in_power" + std::to_string(channel) + "_input"), power_mw);
    }
    void put_hwmon_channel(const path& device, int channel, const std::string& label, const std::string& voltage_mv,
                           const std::string& current_ma) const {
        const auto number = std::to_string(channel);
        if (!label.empty()) put(device / ("in" + number + "_label"), label);
        put(device / ("in" + number + "_input"), voltage_mv);
        put(device / ("curr" + number + "_input"), current_ma);
    }
};

TEST_F(SensorTree, JetsonNanoThroughIio) {
    const path device = "bus/i2c/drivers/ina3221x/6-0040/iio:device0";
    put_iio_channel(device, 0, "POM_5V_IN", "2545");
    put_iio_channel(device, 1, "POM_5V_GPU", "82");
    put_iio_channel(device, 2, "POM_5V_CPU", "493");
    // The same device once more, as sysfs shows it.
    std::filesystem::create_directories(root / "bus/iio/devices");
    std::filesystem::create_directory_symlink(root / device, root / "bus/iio/devices/iio:device0");
    const auto sampler = open_sampler(settings());
    EXPECT_EQ(sampler.kind, SamplerKind::ina3221);
    EXPECT_THAT(sampler.source, HasSubstr("POM_5V_IN"));
    EXPECT_DOUBLE_EQ(power_w(settings()), 2.545);
    auto chosen = settings(SamplerKind::ina3221);
    chosen.rails = {"POM_5V_GPU", "POM_5V_CPU"};
    EXPECT_DOUBLE_EQ(power_w(chosen), 0.575);
    chosen.rails = {"VDD_CPU"};
    EXPECT_THROW(open_sampler(chosen), NoResultError);
}

TEST_F(SensorTree, JetsonTx2ThroughTheOlderIioPath) {
    put_iio_channel("bus/i2c/drivers/ina3221x/0-0040/iio_device", 0, "VDD_SYS_GPU", "152");
    put_iio_channel("bus/i2c/drivers/ina3221x/0-0041/iio_device", 0, "VDD_IN", "3870");
    put_iio_channel("bus/i2c/drivers/ina3221x/0-0041/iio_device", 1, "VDD_SYS_CPU", "610");
    EXPECT_DOUBLE_EQ(power_w(settings()), 3.87);
}

TEST_F(SensorTree, IioWithoutPowerMultipliesVoltageAndCurrent) {
    put("bus/iio/devices/iio:device0/name", "ina3221x");
    put("bus/iio/devices/iio:device0/rail_name_0", "VDD_IN");
    put("bus/iio/devices/iio:device0/in_voltage0_input", "19000");
    put("bus/iio/devices/iio:device0/in_current0_input", "250");
    put("bus/iio/devices/iio:device1/name", "accelerometer");
    EXPECT_DOUBLE_EQ(power_w(settings()), 4.75);
}

TEST_F(SensorTree, JetsonOrinNxThroughHwmon) {
    const path device = "bus/i2c/drivers/ina3221/1-0040/hwmon/hwmon3";
    put(device / "name", "ina3221");
    put_hwmon_channel(device, 1, "VDD_IN", "5000", "960");
    put_hwmon_channel(device, 2, "VDD_CPU_GPU_CV", "5000", "160");
    put_hwmon_channel(device, 3, "VDD_SOC", "5000", "290");
    std::filesystem::create_directories(root / "class/hwmon");
    std::filesystem::create_directory_symlink(root / device, root / "class/hwmon/hwmon3");
    const auto sampler = open_sampler(settings());
    EXPECT_EQ(sampler.kind, SamplerKind::ina3221);
    EXPECT_DOUBLE_EQ(power_w(settings()), 4.8);
    EXPECT_DOUBLE_EQ(power_w(settings(SamplerKind::ina3221)), 4.8);
}

TEST_F(SensorTree, JetsonAgxOrinAddsItsRails) {
    put("class/hwmon/hwmon2/name", "ina3221");
    put_hwmon_channel("class/hwmon/hwmon2", 1, "VDD_GPU_SOC", "20000", "120");
    put_hwmon_channel("class/hwmon/hwmon2", 2, "VDD_CPU_CV", "20000", "20");
    put_hwmon_channel("class/hwmon/hwmon2", 3, "VIN_SYS_5V0", "5000", "600");
    put("class/hwmon/hwmon4/name", "ina3221");
    put_hwmon_channel("class/hwmon/hwmon4", 1, "NC", "0", "5");
    put_hwmon_channel("class/hwmon/hwmon4", 2, "VDDQ_VDD2_1V8AO", "5000", "100");  // made from VIN_SYS_5V0
    put("class/hwmon/hwmon5/name", "coretemp");
    put_hwmon_channel("class/hwmon/hwmon5", 1, "VDD_IN", "5000", "100");
    EXPECT_DOUBLE_EQ(power_w(settings()), 2.4 + 0.4 + 3.0);
}

TEST_F(SensorTree, HwmonPassesOverChannelsThatAreOff) {
    put("class/hwmon/hwmon0/name", "ina3221");
    put_hwmon_channel("class/hwmon/hwmon0", 1, "", "5000", "1000");
    put_hwmon_channel("class/hwmon/hwmon0", 2, "", "5000", "400");
    put("class/hwmon/hwmon0/in2_enable", "0");
    EXPECT_DOUBLE_EQ(power_w(settings()), 5.0);
}

TEST_F(SensorTree, RaplCountsPackagesOnce) {
    const auto zone = [&](const std::string& name, const std::string& label, const std::string& energy_uj) {
        put("class/powercap/" + name + "/name", label);
        put("class/powercap/" + name + "/energy_uj", energy_uj);
        put("class/powercap/" + name + "/max_energy_range_uj", "1000000");
    };
    zone("intel-rapl:0", "package-0", "900000");
    zone("intel-rapl:0:0", "core", "100");
    zone("intel-rapl:1", "package-1", "500000");
    zone("intel-rapl:2", "psys", "0");
    zone("intel-rapl-mmio:0", "package-0", "0");
    const auto sampler = open_sampler(settings());
    EXPECT_EQ(sampler.kind, SamplerKind::rapl);
    const auto before = std::chrono::steady_clock::now();
    EXPECT_TRUE(sampler.read().empty());  // a counter states nothing alone
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    zone("intel-rapl:0", "package-0", "100000");  // wrapped: 0.2 J
    zone("intel-rapl:0:0", "core", "90000");
    zone("intel-rapl:1", "package-1", "800000");  // 0.3 J
    const auto readings = sampler.read();
    ASSERT_EQ(readings.size(), 1U);
    const double max_s = std::chrono::duration<double>(readings.front().time - before).count();
    EXPECT_GE(readings.front().power_w, 0.5 / max_s);
    EXPECT_LE(readings.front().power_w, 0.5 / 0.05);
}

TEST_F(SensorTree, RaplCountsNoEnergyOverAMomentAsThatOfAnInterval) {
    const path zone = "class/powercap/intel-rapl:0";
    put(zone / "name", "package-0");
    put(zone / "energy_uj", "0");
    put(zone / "max_energy_range_uj", "1000000000");
    auto given = settings();
    given.interval_s = 0.1;
    const auto sampler = open_sampler(given);
    const auto before = std::chrono::steady_clock::now();
    EXPECT_TRUE(sampler.read().empty());
    const auto at_once = sampler.read();
    if (std::chrono::steady_clock::now() - before < std::chrono::milliseconds(50)) {
        EXPECT_TRUE(at_once.empty()) << "the counter has not stepped: 0 W is of no interval";
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    put(zone / "energy_uj", "1200000");
    const auto readings = sampler.read();
    ASSERT_EQ(readings.size(), 1U);
    EXPECT_LE(readings.front().power_w, 12.0);
    EXPECT_GE(readings.front().power_w, 1.2 / std::chrono::duration<double>(readings.front().time - before).count());
}

TEST_F(SensorTree, NoSensorAndBrokenSensors) {
    std::filesystem::create_directories(root);
    EXPECT_THROW(open_sampler(settings()), NoResultError);
    const path device = "bus/i2c/drivers/ina3221x/6-0040/iio:device0";
    put_iio_channel(device, 0, "VDD_IN", "1500");
    EXPECT_THROW(open_sampler(settings(SamplerKind::rapl)), NoResultError);
    const auto sampler = open_sampler(settings());
    put_iio_channel(device, 0, "VDD_IN", "broken");
    EXPECT_EQ(test::rejected([&] { sampler.read(); }, root),
              (device / "in_power0_input").string() + ":1: the sensor shows 'broken', expected a number");
}

/// Reads until there are `count` readings, at most for a minute.
std::vector<PowerReading> read_some(const PowerSampler& sampler, std::size_t count) {
    std::vector<PowerReading> all;
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (all.size() < count && std::chrono::steady_clock::now() < until) {
        for (const auto& reading : sampler.read()) all.push_back(reading);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return all;
}

TEST(CommandSampler, TakesAProgramThatGoesOnAndOneThatPrintsOnce) {
    for (const std::string script : {"while :; do echo ' 7.5 '; sleep 0.01; done", "echo 7.5"}) {
        SamplerSettings settings;
        settings.kind = SamplerKind::command;
        settings.interval_s = 0.01;
        settings.command = {"sh", "-c", script};
        const auto readings = read_some(open_sampler(settings), 3);
        ASSERT_GE(readings.size(), 3U) << script;
        EXPECT_EQ(readings[2].power_w, 7.5);
        EXPECT_GT(readings[2].time, readings[0].time);
    }
}

/// Programs that print through stdio then flush each line. The terminal changes nothing of what they print.
TEST(CommandSampler, GivesAProgramATerminal) {
    SamplerSettings settings;
    settings.kind = SamplerKind::command;
    settings.command = {"sh", "-c", "[ -t 1 ] || exit 9; printf '7.5\\n8.5\\r\\n9.5\\n'; sleep 60"};
    const auto readings = read_some(open_sampler(settings), 3);
    ASSERT_EQ(readings.size(), 3U);
    EXPECT_EQ(readings[2].power_w, 9.5);
}

TEST(CommandSampler, RefusesWhatIsNoPower) {
    SamplerSettings settings;
    settings.kind = SamplerKind::command;
    settings.command = {"sh", "-c", "echo 3,5 W; sleep 60"};
    EXPECT_THAT(test::rejected([&] { read_some(open_sampler(settings), 1); }),
                HasSubstr("the sampler printed '3,5 W', expected watts, a number a line"));
    settings.command = {"sh", "-c", "exit 2"};
    EXPECT_THROW(read_some(open_sampler(settings), 1), NoResultError);
    settings.command = {"true"};
    EXPECT_THROW(read_some(open_sampler(settings), 1), NoResultError);
    settings.command = {"there-is-no-such-meter"};
    EXPECT_THROW(read_some(open_sampler(settings), 1), NoResultError);
}

}  // namespace
}  // namespace flightwatt::compute
