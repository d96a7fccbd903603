// flightwatt watch on a link of MAVLink over which missions of vehicles pass by.

#include "base/atomic_file.h"
#include "helpers/free_port.h"
#include "helpers/mavlink_packets.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <csignal>
#include <string>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using boost::asio::ip::udp;
using testing::HasSubstr;
using testing::Not;

/// The waypoints of a mission to this distance north and back, as a ground station reads them.
std::vector<std::string> mission_of(test::MavlinkSender& vehicle, double north_deg) {
    using test::little_endian;
    const std::vector<double> latitudes_deg{47.0, 47.0, 47.0 + north_deg, 47.0};
    std::vector<std::string> packets{
        vehicle.packet(44, little_endian(static_cast<std::uint16_t>(latitudes_deg.size())) + "\xF5\xBF")};
    std::uint16_t number = 0;
    for (const double latitude_deg : latitudes_deg) {
        const std::uint16_t command = number == 1 ? 22 : 16;  // take-off, else a waypoint
        packets.push_back(vehicle.packet(
            73, std::string(16, '\0') + little_endian(static_cast<std::int32_t>(latitude_deg * 1e7)) +
                    little_endian(std::int32_t{80'000'000}) + little_endian(number == 0 ? 0.0F : 80.0F) +
                    little_endian(number) + little_endian(command) + std::string("\xF5\xBF\x03\x00\x01", 5)));
        ++number;
    }
    return packets;
}

/// A running watch and a link to it.
class WatchMissions : public testing::Test {
  protected:
    void SetUp() override {
        const auto fits = test::source_dir() / "fits";
        watch = test::start_program(
            "flightwatt-watch",
            {"--mavlink", fmt::format("udp:{}", port), "--clock-factor", "50", "--json", "--model",
             fits / "mechanical/synthetic-wing.toml", "--battery", fits / "battery/synthetic-3s.toml"},
            folder);
        ASSERT_TRUE(test::wait_until([&] { return test::is_taken(port); }));
    }

    void send(const std::string& packet) {
        socket.send_to(boost::asio::buffer(packet), {boost::asio::ip::address_v4::loopback(), port});
    }

    /// Sends what the parked aircraft 1 does until the program has printed this on the standard error.
    bool parks_until_printed(const std::string& text) {
        return test::wait_until([&] {
            send(aircraft.heartbeat(1));
            for (int i = 0; i < 5; ++i) send(aircraft.position(0.0, 0.0));
            return printed().find(text) != std::string::npos;
        });
    }

    std::string printed() const { return read_file(folder / "stderr"); }

    const std::filesystem::path folder = test::scratch_dir();
    const std::uint16_t port = test::free_udp_port();
    boost::asio::io_context context;
    udp::socket socket{context, udp::endpoint(udp::v4(), 0)};
    test::MavlinkSender aircraft{1, 1};
    ::pid_t watch = -1;
};

TEST_F(WatchMissions, EachNewOneOfTheFollowedAircraftIsPredictedAndThoseOfOthersAreNot) {
    test::MavlinkSender other{2, 1};
    send(other.heartbeat(1));
    for (const auto& packet : mission_of(other, 0.05)) send(packet);
    send(aircraft.heartbeat(1));
    for (const auto& packet : mission_of(aircraft, 0.01)) send(packet);
    EXPECT_TRUE(parks_until_printed("the mission of aircraft 1 is known"));
    for (const auto& packet : mission_of(aircraft, 0.02)) send(packet);
    EXPECT_TRUE(test::wait_until([&] {
        parks_until_printed("");
        const auto text = printed();
        return text.find("aircraft 1 is known") != text.rfind("aircraft 1 is known");
    }));
    ::kill(watch, SIGTERM);
    EXPECT_EQ(test::exit_code_of(watch), 4) << "it has not flown: " << printed();
    EXPECT_THAT(printed(), Not(HasSubstr("aircraft 2")));
}

}  // namespace
}  // namespace flightwatt::cli
