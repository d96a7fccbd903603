#include "live/sources.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/free_port.h"
#include "helpers/link_lines.h"
#include "helpers/pseudo_terminal.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"
#include "live/followed_files.h"
#include "live/received_links.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using boost::asio::ip::udp;
using std::chrono::milliseconds;
using test::energy_lines;
using test::frames_of;

/// What comes until there are so many.
std::vector<IncomingMessage> messages_of(MessageSource& source, std::size_t count) {
    std::vector<IncomingMessage> messages;
    test::wait_until([&] {
        source.receive(milliseconds(10), messages);
        return messages.size() >= count;
    });
    return messages;
}

std::vector<std::string> texts_of(MessageSource& source, std::size_t count) {
    std::vector<std::string> texts;
    for (const auto& message : messages_of(source, count)) texts.push_back(message.text);
    return texts;
}

/// A sender of datagrams to this machine.
class Sender {
  public:
    explicit Sender(std::uint16_t port) : to_(boost::asio::ip::address_v4::loopback(), port) {}
    void send(const std::string& bytes) { socket_.send_to(boost::asio::buffer(bytes), to_); }

  private:
    boost::asio::io_context context_;
    udp::socket socket_{context_, udp::v4()};
    udp::endpoint to_;
};

TEST(UdpSource, TakesFramesInAnyPiecesAndTellsSendersApart) {
    const auto port = test::free_udp_port();
    const auto source = open_udp(fmt::format("127.0.0.1:{}", port), test::small_dictionary());
    Sender aircraft(port), stranger(port);
    const auto lines = energy_lines(40);
    const auto frames = frames_of(lines);
    for (std::size_t at = 0; at < frames.size(); at += 13) {
        aircraft.send(frames.substr(at, 13));
        stranger.send("\x99\x20 nonsense \x99");
    }
    const auto messages = messages_of(*source, lines.size());
    ASSERT_EQ(messages.size(), lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        EXPECT_EQ(messages[i].text, lines[i]);
        EXPECT_TRUE(messages[i].time_s);
    }
}

TEST(UdpSource, DecidesTheVersionAndCountsWhatItCannotUse) {
    const auto port = test::free_udp_port();
    const auto source = open_udp(std::to_string(port), test::small_dictionary());
    Sender aircraft(port);
    const auto lines = energy_lines(30);
    aircraft.send(frames_of(lines, telemetry::LinkVersion::v1));
    aircraft.send("garbage");
    aircraft.send(frames_of(lines, telemetry::LinkVersion::v1));
    EXPECT_EQ(texts_of(*source, 2 * lines.size()).size(), 2 * lines.size());
    std::vector<IncomingMessage> more;
    source->receive(milliseconds(10), more);
    EXPECT_EQ(source->report().messages, 2 * lines.size());
    EXPECT_EQ(source->report().unusable.at("bytes between frames"), 7U);
}

TEST(UdpSource, RunsItsClockAsFastAsItIsTold) {
    const auto port = test::free_udp_port();
    const auto source = open_udp(std::to_string(port), test::small_dictionary(), 1000.0);
    Sender aircraft(port);
    const auto frames = frames_of(energy_lines(20));
    aircraft.send(frames);
    const auto first = messages_of(*source, 20);
    std::vector<IncomingMessage> none;
    source->receive(milliseconds(30), none);
    aircraft.send(frames);
    const auto second = messages_of(*source, 20);
    ASSERT_EQ(first.size(), 20U);
    ASSERT_EQ(second.size(), 20U);
    EXPECT_GE(*second.front().time_s - *first.back().time_s, 30.0);  // 30 ms
}

TEST(UdpSource, IsRefusedWhereThePortIsTaken) {
    boost::asio::io_context context;
    const udp::socket taken(context, {udp::v4(), 0});
    EXPECT_THROW(open_udp(std::to_string(taken.local_endpoint().port()), test::small_dictionary()), InputError);
    for (const auto* wrong : {"", "0", "65536", "x", "host:4242", "127.0.0.1:", "127.0.0.1:x"}) {
        EXPECT_THROW(open_udp(wrong, test::small_dictionary()), UsageError) << wrong;
    }
}

TEST(SerialSource, ReadsBytesAsTheyAreAndOpensADeviceThatIsBack) {
    const auto device = test::scratch_dir() / "ttyUSB0";
    auto modem = std::make_unique<test::PseudoTerminal>(device);
    const auto source = open_serial(device.string() + ":115200", test::small_dictionary());
    // Bytes that a line discipline would eat: \r, \n, ^C, ^D, ^Z, XON, XOFF.
    std::vector<std::string> lines{"17 ALIVE 13,10,3,4,26,17,19,127,255"};
    for (int i = 0; i < 30; ++i) lines.push_back(lines.front());
    modem->send(frames_of(lines));
    EXPECT_EQ(texts_of(*source, lines.size()), lines);
    modem.reset();
    std::vector<IncomingMessage> none;
    source->receive(milliseconds(50), none);
    EXPECT_TRUE(none.empty());
    modem = std::make_unique<test::PseudoTerminal>(device);
    ASSERT_TRUE(test::wait_until([&] {
        source->receive(milliseconds(10), none);
        return source->report().restarts == 1;
    }));
    modem->send(frames_of(lines));
    EXPECT_EQ(texts_of(*source, lines.size()), lines);
}

TEST(SerialSource, IsRefusedWhereThereIsNone) {
    EXPECT_THROW(open_serial("/dev/never:57600", test::small_dictionary()), InputError);
    EXPECT_THROW(open_serial("/dev/null:57600", test::small_dictionary()), InputError);
    EXPECT_THROW(open_serial("/dev/never:0", test::small_dictionary()), UsageError);
    EXPECT_THROW(open_serial(":57600", test::small_dictionary()), UsageError);
}

/// Card frames, a tenth of a second each.
std::string card_frames_of(const std::vector<std::string>& lines) {
    std::string frames;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto link = frames_of({lines[i]});
        const auto message = link.substr(2, link.size() - 4);
        std::string frame{'\x99', static_cast<char>(message.size()), '\0'};
        for (unsigned shift = 0; shift < 32; shift += 8) frame += static_cast<char>((i * 1000) >> shift);
        frame += message;
        unsigned sum = 0;
        for (const char c : frame.substr(1)) sum += static_cast<unsigned char>(c);
        frames += frame + static_cast<char>(sum);
    }
    return frames;
}

TEST(BinaryLogSource, FollowsACardThroughItsRoomAndAnotherThatTakesItsName) {
    const auto log = test::scratch_dir() / "fr_0001.LOG";
    const auto lines = energy_lines(60);
    const auto frames = card_frames_of(lines);
    const auto middle = frames.size() / 2 + 5;
    const std::string room(5000, '\0');
    write_file_atomically(log, frames.substr(0, middle) + room);
    const auto source = follow_binary_log(log, test::small_dictionary());
    auto messages = messages_of(*source, 29);
    {
        std::fstream file(log, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(middle));
        file << frames.substr(middle);
    }
    for (const auto& message : messages_of(*source, lines.size() - messages.size())) messages.push_back(message);
    ASSERT_EQ(messages.size(), lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        EXPECT_EQ(messages[i].text, lines[i]);
        EXPECT_NEAR(*messages[i].time_s, 0.1 * static_cast<double>(i), 1e-9);
    }
    write_file_atomically(log, frames);
    const auto again = messages_of(*source, lines.size());
    ASSERT_EQ(again.size(), lines.size());
    EXPECT_TRUE(again.front().is_after_restart);
    EXPECT_FALSE(again.back().is_after_restart);
    EXPECT_EQ(source->report().restarts, 1U);
    EXPECT_EQ(source->report().messages, 2 * lines.size());
    EXPECT_THROW(follow_binary_log(log.parent_path(), {}), InputError);
    EXPECT_THROW(follow_binary_log(log.parent_path() / "none.LOG", {}), InputError);
}

TEST(IvySource, IsRefusedForWhatIsNoBus) { EXPECT_THROW(open_ivy_bus("somewhere"), UsageError); }

TEST(Source, ALineIsATimeAndAMessage) {
    const auto message = parse_message_line("335.149 20 ENERGY 69 11.7 3.1 36.6 0.03 0.31");
    ASSERT_TRUE(message);
    EXPECT_EQ(message->time_s, 335.149);
    EXPECT_EQ(message->text, "20 ENERGY 69 11.7 3.1 36.6 0.03 0.31");
}

TEST(Source, WhatHasNoTimeIsNoMessage) {
    for (const auto* line : {"", " ", "335.149", "335.149 ", "nan 20 PONG", "inf 20 PONG", "12abc 20 PONG", "<html>"})
        EXPECT_FALSE(parse_message_line(line)) << line;
}

}  // namespace
}  // namespace flightwatt::live
