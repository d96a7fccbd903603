// flightwatt watch at the end of a link over which flightwatt play sends a flight: its last prediction is that of
// flightwatt predict on the log.

#include "base/atomic_file.h"
#include "helpers/free_port.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace flightwatt::cli {
namespace {

using Json = nlohmann::json;

/// The flight to the middle of its cruise, and what is predicted from there.
class WatchLinks : public testing::Test {
  protected:
    void SetUp() override {
        const auto log = test::source_dir() / "logs" / "opterra_synthetic_01";
        const auto text = read_file(log.string() + ".data");
        std::size_t end = 0;
        constexpr int lines = 9000;
        for (int i = 0; i < lines; ++i) end = text.find('\n', end) + 1;
        write_file_atomically(folder / "flown.data", text.substr(0, end));
        std::filesystem::copy(log.string() + ".log", folder / "flown.log");
        for (const auto* part : {"live.css", "live.js"}) write_file_atomically(folder / part, "");  // built by node
        const auto predicted = test::run_shell("flightwatt predict flown.data --json" + basis(), folder);
        ASSERT_EQ(predicted.code, 0) << predicted.err;
        expected = Json::parse(predicted.out);
    }

    static std::string basis() {
        return fmt::format(
            " --model '{0}/mechanical/synthetic-wing.toml' --battery '{0}/battery/synthetic-3s.toml' --remaining 290",
            (test::source_dir() / "fits").string());
    }

    /// Watches what is played there so many times as fast, and returns the last prediction.
    Json watch(const std::string& source, const std::string& target, int speed, const std::function<bool()>& listens) {
        const auto command = "export FLIGHTWATT_WEB=.; exec flightwatt-watch " + source + basis() + " --json > watched";
        const auto watching = start_shell(command);
        EXPECT_TRUE(test::wait_until(listens));
        const auto played =
            test::run_shell(fmt::format("flightwatt play flown.data --speed {} --to {}", speed, target), folder);
        EXPECT_EQ(played.code, 0) << played.err;
        const auto until_s = expected.at("until_s").get<double>();
        std::size_t seconds = 0;
        EXPECT_TRUE(test::wait_until([&] {  // until it states nothing new: it has seen the end, and silence
            const auto text = read_file(folder / "watched");
            const auto last = text.rfind("\n{");
            const auto now = last == std::string::npos ? text : text.substr(last + 1);
            seconds = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
            return text.ends_with('\n') && Json::parse(now).at("time_since_message_s").get<double>() > 0.0;
        })) << until_s;
        EXPECT_GT(seconds, 1U);  // of 464; how many it passes over is a matter of the load
        ::kill(watching, SIGTERM);
        EXPECT_EQ(test::exit_code_of(watching), 0);
        const auto text = read_file(folder / "watched");
        const auto end = Json::parse(text.substr(text.rfind("\n{") + 1));
        return end.at("last_prediction").at("prediction");
    }

    ::pid_t start_shell(const std::string& command) {
        const auto path = fmt::format("PATH='{}':$PATH", test::programs_dir().string());
        const auto child = ::fork();
        if (child == 0) {
            std::filesystem::current_path(folder);
            ::execl("/bin/sh", "sh", "-c", (path + "; " + command).c_str(), nullptr);
            ::_exit(127);
        }
        return child;
    }

    void expect_near(const Json& prediction, double relative) const {
        for (const auto* key : {"flown_energy_wh", "remaining_energy_wh", "total_energy_wh"}) {
            const auto wanted = expected.at(key).get<double>();
            EXPECT_NEAR(prediction.at(key).get<double>(), wanted, relative * wanted) << key;
        }
        const auto soc = [](const Json& of) {
            return of.at("battery").at("at_landing").at("soc_percent").get<double>();
        };
        EXPECT_NEAR(soc(prediction), soc(expected), 100.0 * relative);
    }

    const std::filesystem::path folder = test::scratch_dir();
    Json expected;
};

TEST_F(WatchLinks, OverUdpItIsTheSameButForTimesOfArrival) {
    const auto port = test::free_udp_port();
    const auto source =
        fmt::format("--udp {} --messages flown.log --clock-factor 100 --serve {}", port, test::free_udp_port());
    // Arrivals are late by milliseconds, on a busy machine by tenths of a second, which are tens of seconds at this
    // speed. WatchFlights compares times that come with the messages exactly.
    constexpr double of_arrivals = 0.15;
    expect_near(watch(source, fmt::format("udp:127.0.0.1:{}", port), 100, [&] { return test::is_taken(port); }),
                of_arrivals);
}

}  // namespace
}  // namespace flightwatt::cli
