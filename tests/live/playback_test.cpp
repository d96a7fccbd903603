#include "live/playback.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/binary_frames.h"
#include "helpers/free_port.h"
#include "helpers/link_lines.h"
#include "helpers/mavlink_packets.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"
#include "live/received_links.h"
#include "live/sources.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

const auto never = [] { return false; };

std::filesystem::path write_log(const std::string& text) {
    auto path = test::scratch_dir() / "a.data";
    write_file_atomically(path, text);
    return path;
}

/// Keeps what it is sent.
struct Kept {
    PlaybackTarget target() {
        return [this](const IncomingMessage& message) -> std::string_view {
            if (message.text.ends_with("UNSENDABLE")) return "they cannot be sent";
            lines.push_back(fmt::format("{} {}", *message.time_s, message.text));
            return {};
        };
    }
    std::vector<std::string> lines;
};

/// A log of `count` messages, ten a second.
std::string log_of(const std::vector<std::string>& lines) {
    std::string text;
    for (std::size_t i = 0; i < lines.size(); ++i)
        text += fmt::format("{:.1f} {}\n", 100.0 + 0.1 * static_cast<double>(i), lines[i]);
    return text;
}

TEST(Playback, SendsAllMessagesInOrderAndCountsTheOthers) {
    const auto log = write_log(
        "10.500 20 PONG \r\nnonsense\n\n10.5 20 A 1\n11.5 20 UNSENDABLE\n3 20 A 2\n5000 20 A 3\n5001 20 LAST");
    Kept kept;
    const auto report = play(log, {.speed = 1e5}, kept.target(), never);
    EXPECT_THAT(kept.lines, ElementsAre("10.5 20 PONG ", "10.5 20 A 1", "3 20 A 2", "5000 20 A 3", "5001 20 LAST"));
    EXPECT_EQ(report.messages, 5U);
    EXPECT_EQ(report.left_out.at("lines that are not messages (TIME SENDER NAME ...)"), 1U);
    EXPECT_EQ(report.left_out.at("they cannot be sent"), 1U);
    EXPECT_EQ(report.shortened_gaps, 1U);
    EXPECT_DOUBLE_EQ(report.log_s, 1.0 + max_played_gap_s + 1.0);
    EXPECT_FALSE(report.stopped);
}

TEST(Playback, TakesAsLongAsItShouldAndEndsWhenItIsStopped) {
    const auto log = write_log("0 20 A 1\n10 20 A 2\n20 20 A 3\n");
    Kept kept;
    const auto report = play(log, {.speed = 200.0}, kept.target(), never);
    EXPECT_EQ(kept.lines.size(), 3U);
    EXPECT_GE(report.played_s, 0.1);
    EXPECT_GE(report.max_delay_s, 0.0);
    Kept stopped;
    int asked = 0;
    EXPECT_TRUE(play(log, {.speed = 1.0}, stopped.target(), [&] { return ++asked > 2; }).stopped);
    EXPECT_EQ(stopped.lines.size(), 1U);
}

/// A card's log of messages with their own times.
std::filesystem::path write_card_log(const std::vector<std::string>& lines) {
    auto path = test::scratch_dir() / "a.LOG";
    write_file_atomically(
        path, test::card_log(log_of(lines), test::small_dictionary(), test::LinkVersion::v2) + "damage at its end");
    return path;
}

TEST(Playback, PlaysBinaryLogsAsTheirText) {
    const auto lines = test::energy_lines(50);
    const auto log = write_card_log(lines);
    Kept kept;
    const auto report = play(log, {.speed = 1e5}, kept.target(), never, test::small_dictionary());
    ASSERT_EQ(kept.lines.size(), lines.size());
    EXPECT_EQ(kept.lines.front(), "100 " + lines.front());
    EXPECT_EQ(kept.lines.back(), "104.9 " + lines.back());
    EXPECT_NEAR(report.log_s, 4.9, 1e-9);
    EXPECT_EQ(report.left_out.at("bytes between frames"), 17U);
    int asked = 0;
    Kept stopped;
    EXPECT_TRUE(play(
                    log, {.speed = 1.0}, stopped.target(), [&] { return ++asked > 2; }, test::small_dictionary())
                    .stopped);
    EXPECT_EQ(stopped.lines.size(), 1U);
    EXPECT_THROW(play(log, {.speed = 1.0}, kept.target(), never), InputError) << "nothing defines its messages";
}

TEST(Playback, BeginsLaterAndLosesAndDelaysTheSameMessagesEachTime) {
    std::string lines;
    for (int i = 0; i < 1000; ++i) lines += fmt::format("{} 1 PING {}\n", 100.0 + 0.1 * i, i);
    const auto log = write_log(lines);
    const PlaybackOptions options{.speed = 1e5, .from_s = 50.0, .loss_percent = 20.0, .delay_s = 1.0};
    Kept kept;
    const auto report = play(log, options, kept.target(), never);
    EXPECT_EQ(report.messages + report.lost, 500U);
    EXPECT_NEAR(static_cast<double>(report.lost), 100.0, 27.0) << "three standard deviations";
    ASSERT_EQ(kept.lines.size(), report.messages);
    for (const auto& line : kept.lines) EXPECT_GE(parse_message_line(line)->time_s, 150.0) << line;
    EXPECT_FALSE(std::ranges::is_sorted(kept.lines, {}, [](const auto& line) {
        return parse_message_line(line)->time_s;
    })) << "none was overtaken";
    Kept again;
    play(log, options, again.target(), never);
    EXPECT_EQ(again.lines, kept.lines);
}

/// `--aircraft` was ignored: all vehicles were sent.
TEST(Playback, SendsOneOfTheVehiclesInARecordingOfMavlink) {
    const auto log = test::scratch_dir() / "two.tlog";
    write_file_atomically(log, test::tlog_of_flight({1, 1}) + test::tlog_of_flight({2, 1}));
    const auto sent_of = [&](const std::optional<std::string>& aircraft) {
        Kept kept;
        play_as_mavlink(log, {.speed = 1e9}, kept.target(), never, aircraft);
        std::map<char, std::size_t> sent;
        for (const auto& line : kept.lines) ++sent[line[line.find(' ') + 1]];
        return sent;
    };
    const auto all = sent_of(std::nullopt);
    ASSERT_GT(all.at('2'), 6'000U);
    EXPECT_EQ(all.at('1'), all.at('2'));
    for (const auto* aircraft : {"2", "ArduCopter 2"})
        EXPECT_THAT(sent_of(aircraft), ElementsAre(std::pair('2', all.at('2'))));
    EXPECT_THROW(sent_of("3"), InputError);
}

TEST(Playback, RefusesTargetsThatAreNone) {
    for (const auto* wrong : {"", "udp", "127.0.0.1", "/dev/ttyUSB0:9600", "host:1"})
        EXPECT_THROW(open_udp_target(wrong, test::small_dictionary()), UsageError) << wrong;
}

/// What a source has when a log was played to its end.
std::vector<IncomingMessage> played(MessageSource& source, const std::filesystem::path& log, double speed,
                                    const PlaybackTarget& target, std::size_t count) {
    std::vector<IncomingMessage> messages;
    std::thread player([&] { play(log, {.speed = speed}, target, never); });
    test::wait_until([&] {
        source.receive(milliseconds(10), messages);
        return messages.size() >= count;
    });
    player.join();
    source.receive(milliseconds(50), messages);
    return messages;
}

std::vector<std::string> texts_of(const std::vector<IncomingMessage>& messages) {
    std::vector<std::string> texts;
    for (const auto& message : messages) texts.push_back(message.text);
    return texts;
}

TEST(Playback, BringsAllToAUdpSourceAtTheirTimes) {
    const auto lines = test::energy_lines(200);
    const auto log = write_log(log_of(lines));
    for (const auto version : {telemetry::LinkVersion::v1, telemetry::LinkVersion::v2}) {
        const auto port = test::free_udp_port();
        const auto source = open_udp(std::to_string(port), test::small_dictionary(), 60.0);
        const auto target = open_udp_target(fmt::format("127.0.0.1:{}", port), test::small_dictionary(), version);
        const auto messages = played(*source, log, 60.0, target, lines.size());
        EXPECT_EQ(texts_of(messages), lines);
        EXPECT_TRUE(std::ranges::is_sorted(messages, {}, &IncomingMessage::time_s));
        EXPECT_GE(*messages.back().time_s, 19.9);  // since the source was opened, however late the first were heard
    }
}

}  // namespace
}  // namespace flightwatt::live
