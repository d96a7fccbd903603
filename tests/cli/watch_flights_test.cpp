// A whole real flight through each source of flightwatt watch, many times as fast as it was: the last prediction is
// that of flightwatt predict on the log.

#include "base/atomic_file.h"
#include "helpers/binary_frames.h"
#include "helpers/free_port.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::cli {
namespace {

using Json = nlohmann::json;
using Words = std::vector<std::string>;

/// Times that come with the messages leave nothing to differ; of arrivals some come late.
constexpr double exactly = 1e-9;

class WatchFlights : public testing::Test {
  protected:
    void SetUp() override {
        FLIGHTWATT_NEEDS_SHARED();
        const auto log = test::shared_dir() / "flights" / "20_07_10__06_53_03";
        std::filesystem::copy(log.string() + ".data", folder / "flown.data");
        std::filesystem::copy(log.string() + ".log", folder / "flown.log");
        const auto fits = test::source_dir() / "fits";
        basis = {"--model",     (fits / "mechanical/synthetic-wing.toml").string(),
                 "--battery",   (fits / "battery/synthetic-3s.toml").string(),
                 "--remaining", "300",
                 "--json"};
    }

    ::pid_t start_watch(Words source) const {
        source.insert(source.end(), basis.begin(), basis.end());
        return test::start_program("flightwatt-watch", source, folder);
    }

    std::string printed() const {
        const auto file = folder / "stdout";
        return std::filesystem::exists(file) ? read_file(file) : "";
    }

    static Json last_object(const std::string& lines) {
        const auto before = lines.rfind("\n{");
        return Json::parse(before == std::string::npos ? lines : lines.substr(before + 1));
    }

    /// Ends a watch that has seen the end of the flight, which lasts until then on its clock; its last prediction.
    Json ended(::pid_t watching, double until_s) const {
        EXPECT_TRUE(test::wait_until([&] {
            const auto lines = printed();
            if (!lines.ends_with("}\n")) return false;
            const auto now = last_object(lines);
            return now.at("time_since_message_s").get<double>() > 0.0 && now.at("time_s").get<double>() >= until_s;
        }));
        ::kill(watching, SIGTERM);
        EXPECT_EQ(test::exit_code_of(watching), 0) << read_file(folder / "stderr");
        return last_object(printed()).at("last_prediction").at("prediction");
    }

    Json predicted(const std::string& log, double until_s) const {
        std::string options;
        for (const auto& word : basis) options += " '" + word + "'";
        const auto result =
            test::run_shell(fmt::format("flightwatt-predict {} --at-log-time {}{}", log, until_s, options), folder);
        EXPECT_EQ(result.code, 0) << result.err;
        return Json::parse(result.out);
    }

    /// Compares at the same moment after lift-off; the clock of a source without times has a start of its own.
    void expect_as_predicted(const Json& last, const std::string& log, double relative) const {
        const auto lift_off_s = [](const Json& of) { return of.at("lift_off_s").get<double>(); };
        const auto log_lift_off_s = lift_off_s(predicted(log, flight_end_s));
        const double until_s = last.at("until_s").get<double>();
        EXPECT_GT(until_s - lift_off_s(last), 700.0);  // of a cruise of 780 s
        const auto wanted = predicted(log, relative == exactly ? until_s : until_s - lift_off_s(last) + log_lift_off_s);
        for (const auto* const key : {"flown_energy_wh", "remaining_energy_wh", "total_energy_wh"}) {
            const auto value = wanted.at(key).get<double>();
            EXPECT_NEAR(last.at(key).get<double>(), value, relative * value) << key;
        }
        for (const auto* const key : {"soc_percent", "voltage_v"}) {
            const auto of = [&](const Json& from) { return from.at("battery").at("at_landing").at(key).get<double>(); };
            EXPECT_NEAR(of(last), of(wanted), relative * of(wanted)) << key;
        }
    }

    void play(const std::string& target, int speed) const {
        const auto played =
            test::run_shell(fmt::format("flightwatt-play flown.data --speed {} --to {}", speed, target), folder);
        EXPECT_EQ(played.code, 0) << played.err;
    }

    /// As a recorder writes: a piece at a time, which ends anywhere.
    void grow(const std::string& name, const std::string& bytes) const {
        constexpr std::size_t piece = 10'007;
        std::ofstream file(folder / name, std::ios::binary);
        for (std::size_t at = 0; at < bytes.size(); at += piece) {
            file << bytes.substr(at, piece) << std::flush;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }

    static constexpr double log_end_s = 1200.0;   ///< landed; the aircraft's last messages are later
    static constexpr double flight_end_s = 1100;  ///< in its cruise
    /// Times of arrival are as late as the machine is busy: 0.1 s late is 6 s at 60 times the speed.
    static constexpr double of_arrivals = 0.1;
    const std::filesystem::path folder = test::scratch_dir();
    Words basis;
};

TEST_F(WatchFlights, FromALogThatGrows) {
    std::ofstream(folder / "growing.data").flush();
    const auto watching = start_watch({"--follow", "growing.data", "--log", "flown.log"});
    grow("growing.data", read_file(folder / "flown.data"));
    expect_as_predicted(ended(watching, log_end_s), "flown.data", exactly);
}

TEST_F(WatchFlights, FromABinaryLogThatGrows) {
    const auto messages = telemetry::read_message_dictionary(folder / "flown.log");
    const auto card = test::card_log(read_file(folder / "flown.data"), messages, test::LinkVersion::v2);
    std::filesystem::copy(folder / "flown.log", folder / "card.log");
    std::ofstream(folder / "card.LOG").flush();
    const auto watching = start_watch({"--follow", "card.LOG"});
    grow("card.LOG", card);
    expect_as_predicted(ended(watching, log_end_s), "card.LOG", exactly);
}

TEST_F(WatchFlights, FromTheStandardInput) {
    std::string options;
    for (const auto& word : basis) options += " '" + word + "'";
    const auto result = test::run_shell(
        "flightwatt-play flown.data --speed 1000 --to - | flightwatt-watch - --log flown.log" + options, folder);
    ASSERT_EQ(result.code, 0) << result.err;
    expect_as_predicted(last_object(result.out).at("last_prediction").at("prediction"), "flown.data", exactly);
}

/// By times of arrival, 60 times as fast: a machine that is busy for a second makes them a minute late.
class WatchFlightsStudy : public WatchFlights {};

TEST_F(WatchFlightsStudy, OverUdp) {
    const auto port = test::free_udp_port();
    const auto watching = start_watch(
        {"--udp", fmt::format("{}", port), "--messages", "flown.log", "--clock-factor", "60", "--aircraft", "20"});
    ASSERT_TRUE(test::wait_until([&] { return test::is_taken(port); }));
    play(fmt::format("udp:127.0.0.1:{}", port), 60);
    expect_as_predicted(ended(watching, log_end_s - 30.0), "flown.data", of_arrivals);
}

}  // namespace
}  // namespace flightwatt::cli
