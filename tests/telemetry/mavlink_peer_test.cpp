// Packets of MAVLink by another implementation, npm's node-mavlink, read by ours, and ours read by it.

#include "helpers/test_paths.h"
#include "telemetry/mavlink/frames.h"
#include "telemetry/mavlink_sender.h"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

/// A packet as the peer prints it: the message's number, and the values of its fields as text.
struct PrintedPacket {
    std::uint32_t id = 0;
    std::map<std::string, std::string> fields = {};
};

std::filesystem::path peer() { return test::source_dir() / "tests" / "mavlink_peer"; }

std::vector<PrintedPacket> run_peer(const std::string& arguments) {
    const auto command = fmt::format("node {}/peer.mjs {}", peer().string(), arguments);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> output(::popen(command.c_str(), "r"), ::pclose);
    std::string text;
    for (int c = 0; (c = std::fgetc(output.get())) != EOF;) text += static_cast<char>(c);
    std::vector<PrintedPacket> packets;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        auto& packet = packets.emplace_back();
        words >> packet.id;
        for (std::string word; words >> word;)
            packet.fields[word.substr(0, word.find('='))] = word.substr(word.find('=') + 1);
    }
    return packets;
}

/// The messages that node-mavlink knows too: all but ESC_STATUS.
std::vector<const MavlinkMessage*> common_messages() {
    std::vector<const MavlinkMessage*> messages;
    for (const auto& message : mavlink_messages())
        if (message.layout.name != "ESC_STATUS") messages.push_back(&message);
    return messages;
}

std::string common_ids() {
    std::string ids;
    for (const auto* message : common_messages()) ids += fmt::format(" {}", message->id);
    return ids;
}

bool peer_is_installed() { return std::filesystem::exists(peer() / "node_modules" / "node-mavlink"); }

TEST(MavlinkPeer, ReadsWhatNodeMavlinkWrites) {
    if (!peer_is_installed()) GTEST_SKIP() << "node-mavlink is not here: scripts/install_dependencies tests";
    const auto file = test::scratch_dir() / "packets.bin";
    const auto written = run_peer(fmt::format("write {}{}", file.string(), common_ids()));
    ASSERT_GT(written.size(), common_messages().size());
    std::ifstream in(file, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    std::size_t at = 0;
    for (const auto& packet : written) {
        const auto frame = read_mavlink_frame(std::string_view(bytes).substr(at));
        ASSERT_TRUE(frame) << packet.id;
        ASSERT_NE(frame->message, nullptr) << packet.id;
        const bool is_v1 = bytes[at] == '\xFE';
        at += frame->bytes;
        EXPECT_EQ(frame->id, packet.id);
        EXPECT_EQ(frame->system, 7);
        for (const auto& field : frame->message->layout.fields) {
            if (is_v1 && field.offset >= frame->message->base_bytes) continue;  // version 1 has no extensions
            ASSERT_TRUE(packet.fields.contains(field.name)) << packet.id << " " << field.name;
            const auto& value = packet.fields.at(field.name);
            if (field.type == WireType::text) {
                EXPECT_EQ(frame->text(field.name), value);
            } else {
                EXPECT_EQ(frame->number(field.name), std::stod(value)) << packet.id << " " << field.name;
            }
        }
    }
    EXPECT_EQ(at, bytes.size());
}

TEST(MavlinkPeer, WritesWhatNodeMavlinkReads) {
    if (!peer_is_installed()) GTEST_SKIP() << "node-mavlink is not here: scripts/install_dependencies tests";
    const auto file = test::scratch_dir() / "packets.bin";
    MavlinkSender sender(7, 1);
    std::ofstream out(file, std::ios::binary);
    for (const auto* message : common_messages()) {
        MavlinkSender::Values values;
        for (const auto& field : message->layout.fields)
            if (field.type != WireType::text) values[field.name] = static_cast<double>(3 + values.size());
        out << sender.packet(message->layout.name, values, "name");
    }
    out.close();
    const auto read = run_peer("read " + file.string());
    ASSERT_EQ(read.size(), common_messages().size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        const auto& message = *common_messages()[i];
        SCOPED_TRACE(message.layout.name);
        EXPECT_EQ(read[i].id, message.id);
        double value = 3.0;
        for (const auto& field : message.layout.fields) {
            const auto& text = read[i].fields.at(field.name);
            if (field.type == WireType::text) {
                EXPECT_EQ(text, "name");
            } else if (field.offset < message.base_bytes) {  // extensions are not sent
                EXPECT_EQ(std::stod(text), value) << field.name;
            }
            if (field.type != WireType::text) value += 1.0;
        }
    }
}

}  // namespace
}  // namespace flightwatt::telemetry
