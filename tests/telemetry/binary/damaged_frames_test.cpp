// Ten thousand damaged logs: every frame that is whole is found again, and no message is made of damage unless its
// checksum happens to be right.

#include "helpers/binary_definitions.h"
#include "helpers/binary_frames.h"
#include "telemetry/binary/frame.h"
#include "telemetry/link_decoder.h"

#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using Random = std::mt19937;

std::size_t below(Random& random, std::size_t size) {
    return std::uniform_int_distribution<std::size_t>(0, size - 1)(random);
}
char any_byte(Random& random) { return static_cast<char>(below(random, 256)); }

/// A frame, or what became of it.
struct Piece {
    std::string bytes;
    std::string text;  ///< of the message; empty where it is damaged, or states nothing
    bool is_damaged = false;
    std::string before = {};  ///< the text, where it is damaged
};

std::string a_message(Random& random, std::size_t i) {
    switch (below(random, 5)) {
        case 0:
            return fmt::format("7 ENERGY {} 11.62 1.64 19.1 0.08 {}.", below(random, 101), i);
        case 1:
            return fmt::format("7 ARRAYS 1,{},153 1.5,-3.,{}. \"xyz\" \"ab\" 126,153", below(random, 256), i);
        case 2:
            return fmt::format("7 TYPES 1 153 {} 3 {} 5 6 7 8.5 {}. x", i, i, below(random, 1000));
        default:
            return fmt::format("{} ESTIMATOR {}. 0.5", below(random, 10) == 0 ? 9 : 7, i);
    }
}

std::string framed(Framing framing, const std::string& message, std::size_t i) {
    if (framing == Framing::card) return test::card_frame(message, static_cast<std::uint32_t>(400'000 + 500 * i));
    return framing == Framing::link ? test::link_frame(message) : test::xbee_frame(message, 0x81, i % 2 == 0);
}

std::vector<Piece> a_log(Random& random, Framing framing, LinkVersion version, const MessageDictionary& dictionary) {
    std::vector<Piece> log;
    for (std::size_t i = 0; i < 40; ++i) {
        if (below(random, 20) == 0) {  // of a message that is not defined
            std::string unknown = version == LinkVersion::v1 ? "\7\xC8" : std::string("\7\xFF\1\xC8", 4);
            for (std::size_t size = below(random, 30); size > 0; --size) unknown += any_byte(random);
            log.push_back({framed(framing, unknown, i), "", false});
            continue;
        }
        const auto text = a_message(random, i);
        const auto message = test::binary_message(text, dictionary, version).value();
        const auto time = framing == Framing::card ? fmt::format("{:.4f} ", 40.0 + 0.05 * static_cast<double>(i)) : "";
        log.push_back({framed(framing, message, i), time + text, false});
    }
    return log;
}

void damage(Random& random, Piece& piece) {
    auto& bytes = piece.bytes;
    if (bytes.size() < 2) return;  // little is left of it
    const auto before = bytes;
    const auto at = below(random, bytes.size());
    switch (below(random, 7)) {
        case 0:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(random, 8)));
            break;
        case 1:
            for (std::size_t i = at; i < std::min(at + 4, bytes.size()); ++i) bytes[i] = any_byte(random);
            break;
        case 2:
            bytes.erase(at, 1 + below(random, bytes.size()));
            break;
        case 3:
            bytes[1] = any_byte(random);
            break;
        case 4:
            for (std::size_t count = 1 + below(random, 60); count > 0; --count) bytes.insert(at, 1, any_byte(random));
            break;
        case 5:
            bytes.replace(at, std::string::npos, bytes.size() - at, '\0');
            break;
        default:
            bytes[at] = below(random, 2) == 0 ? '\x99' : '\x7E';
            break;
    }
    if (bytes != before) {
        piece.is_damaged = true;
        if (!piece.text.empty()) piece.before = std::exchange(piece.text, {});
    }
}

struct Tally {
    std::size_t whole = 0;
    std::size_t damaged = 0;
    std::size_t lost = 0;
    std::size_t invented = 0;
};

/// How many frames with right checksums begin in damaged pieces.
std::size_t collisions_in(const std::vector<Piece>& log, Framing framing) {
    std::string bytes;
    for (const auto& piece : log) bytes += piece.bytes;
    std::size_t count = 0;
    std::size_t begin = 0;
    Frame frame;
    for (const auto& piece : log) {
        for (std::size_t i = begin; piece.is_damaged && i < begin + piece.bytes.size(); ++i) {
            if (bytes[i] != sync_byte(framing)) continue;
            const char* const end = bytes.data() + bytes.size();
            const auto look = framing == Framing::card   ? parse_frame<Framing::card>(bytes.data() + i, end, frame)
                              : framing == Framing::link ? parse_frame<Framing::link>(bytes.data() + i, end, frame)
                                                         : parse_frame<Framing::xbee>(bytes.data() + i, end, frame);
            count += look == ParseStatus::frame ? 1 : 0;
        }
        begin += piece.bytes.size();
    }
    return count;
}

/// Decodes a log, some of whose frames are damaged, and sets what was found next to what is whole.
void try_log(unsigned seed, Framing framing, LinkVersion version, const MessageDictionary& dictionary, Tally& tally) {
    Random random(seed);
    auto log = a_log(random, framing, version, dictionary);
    for (std::size_t count = 1 + below(random, 12); count > 0; --count) damage(random, log[below(random, log.size())]);
    std::string bytes;
    std::map<std::string, std::size_t> expected;
    std::set<std::string> damaged;  ///< may be whole again: damaged twice, or before its first byte alone
    for (const auto& piece : log) {
        bytes += piece.bytes;
        tally.damaged += piece.is_damaged ? 1 : 0;
        if (!piece.text.empty()) ++expected[piece.text];
        if (piece.is_damaged) damaged.insert(piece.before);
    }
    for (const auto& [text, count] : expected) tally.whole += count;
    std::size_t invented = 0;
    LinkDecoder decoder(dictionary, framing, below(random, 2) == 0 ? std::optional(version) : std::nullopt);
    const auto sink = [&](const LinkMessage& message) {
        const auto line =
            message.time_s ? fmt::format("{:.4f} {}", *message.time_s, message.text) : std::string(message.text);
        const auto found = expected.find(line);
        if (found == expected.end() || found->second == 0) {
            if (damaged.contains(line)) return;
            ++invented;
        } else {
            --found->second;
        }
    };
    decoder.push(bytes, sink);
    decoder.flush(sink);
    for (const auto& [text, count] : expected) tally.lost += count;
    tally.invented += invented;
    EXPECT_LE(invented, collisions_in(log, framing)) << "seed " << seed;
    EXPECT_EQ(decoder.counts().bytes, bytes.size());
}

Tally try_logs(Framing framing, unsigned first_seed, unsigned logs) {
    const auto dictionary = test::binary_dictionary();
    Tally tally;
    for (unsigned seed = first_seed; seed < first_seed + logs; ++seed)
        try_log(seed, framing, seed % 2 == 0 ? LinkVersion::v1 : LinkVersion::v2, dictionary, tally);
    ::testing::Test::RecordProperty(
        "damage", fmt::format("{}: {} whole, {} damaged, {} lost, {} made of damage by a right checksum",
                              to_string(framing), tally.whole, tally.damaged, tally.lost, tally.invented));
    return tally;
}

/// Of damaged frames, `one_in` may have a right checksum by chance.
void expect_others_found(Framing framing, unsigned first_seed, unsigned logs, std::size_t one_in) {
    const auto tally = try_logs(framing, first_seed, logs);
    EXPECT_GT(tally.whole, 20U * logs);
    EXPECT_EQ(tally.lost, 0U);
    EXPECT_LT(tally.invented, std::max<std::size_t>(1, tally.damaged / one_in)) << to_string(framing);
}

TEST(DamagedFrames, LeaveTheOthersToBeFound) {
    expect_others_found(Framing::card, 0, 500, 100);
    expect_others_found(Framing::link, 100'000, 300, 1000);
    expect_others_found(Framing::xbee, 200'000, 200, 100);
}

TEST(DamagedFramesStudy, LeaveTheOthersToBeFound) {
    expect_others_found(Framing::card, 0, 5000, 100);         // one checksum in 256 is right by chance
    expect_others_found(Framing::link, 100'000, 3000, 1000);  // one in 65536
    expect_others_found(Framing::xbee, 200'000, 2000, 100);
}

std::vector<std::string> texts_of(const std::string& bytes, Framing framing) {
    std::vector<std::string> texts;
    LinkDecoder decoder(test::binary_dictionary(), framing, LinkVersion::v1);
    const auto sink = [&](const LinkMessage& message) { texts.emplace_back(message.text); };
    decoder.push(bytes, sink);
    decoder.flush(sink);
    return texts;
}

/// Messages of ENERGY until one's frame is as asked.
std::string energy_with(Framing framing, const std::function<bool(const std::string&)>& is_asked_for) {
    const auto dictionary = test::binary_dictionary();
    for (std::size_t i = 0; i < 100'000; ++i) {
        auto text = fmt::format("7 ENERGY {} {}.25 1.64 19.1 0.08 {}.", i % 100, i, i);
        if (is_asked_for(framed(framing, test::binary_message(text, dictionary, LinkVersion::v1).value(), 1)))
            return text;
    }
    throw std::logic_error("no frame is as asked for");
}

/// One byte is missing between two frames: the last of the first or the first of the second, which are equal.
TEST(DamagedFrames, AreBothFoundWhereTheyShareTheByteThatOneHasLost) {
    const auto dictionary = test::binary_dictionary();
    for (const auto framing : {Framing::card, Framing::link, Framing::xbee}) {
        SCOPED_TRACE(to_string(framing));
        const auto frame_of = [&](const std::string& text) {
            return framed(framing, test::binary_message(text, dictionary, LinkVersion::v1).value(), 1);
        };
        const auto ends_in_sync = [&](const std::string& frame) { return frame.back() == sync_byte(framing); };
        const auto first = energy_with(framing, ends_in_sync);
        const std::string before = "7 ESTIMATOR 1. 0.5";
        const std::string behind = "7 ESTIMATOR 2. 0.5";
        const auto bytes = frame_of(before) + frame_of(first) + frame_of(behind).substr(1) + frame_of(before);
        EXPECT_EQ(texts_of(bytes, framing), (std::vector{before, first, behind, before}));
    }
}

/// An escaped packet that has a right checksum as it stands, too: what fits its definition was sent.
TEST(DamagedFrames, OfAnXbeeAreReadAsTheirMessagesFit) {
    const auto dictionary = test::binary_dictionary();
    Frame frame;
    const auto is_right_in_both = [&](const std::string& plain) {
        const std::string_view packet(plain);
        const auto escaped = test::xbee_frame(packet.substr(8, packet.size() - 9), 0x81, true) + "\x01\x02\x03";
        return parse_xbee_frame(escaped.data(), escaped.data() + escaped.size(), false, frame) == ParseStatus::frame;
    };
    const auto text = energy_with(Framing::xbee, is_right_in_both);
    const auto packet = test::xbee_frame(test::binary_message(text, dictionary, LinkVersion::v1).value(), 0x81, true);
    EXPECT_EQ(texts_of(packet + "\x01\x02\x03", Framing::xbee), std::vector{text});
}

}  // namespace
}  // namespace flightwatt::telemetry
