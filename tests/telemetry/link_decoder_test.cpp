#include "telemetry/link_decoder.h"

#include "base/atomic_file.h"
#include "base/number.h"
#include "helpers/binary_definitions.h"
#include "helpers/binary_frames.h"
#include "helpers/test_paths.h"

#include <cmath>
#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using test::binary_dictionary;
using test::binary_message;
using test::card_frame;
using test::link_frame;
using test::xbee_frame;
using testing::ElementsAre;
using testing::IsEmpty;

using Lines = std::vector<std::string>;

/// What a decoder makes of bytes that come in pieces: "TIME text", or the text alone where there is no time.
Lines pushed(LinkDecoder& decoder, std::string_view bytes, std::size_t piece, bool ends = true) {
    Lines lines;
    const auto sink = [&](const LinkMessage& message) {
        lines.push_back(message.time_s ? fmt::format("{:.4f} {}", *message.time_s, message.text)
                                       : std::string(message.text));
    };
    for (; !bytes.empty(); bytes.remove_prefix(std::min(piece, bytes.size())))
        decoder.push(bytes.substr(0, piece), sink);
    if (ends) decoder.flush(sink);
    return lines;
}

constexpr std::size_t all_at_once = 1'000'000'000;

Lines decoded(std::string_view bytes, std::optional<Framing> framing = {}, std::size_t piece = all_at_once) {
    LinkDecoder decoder(binary_dictionary(), framing);
    return pushed(decoder, bytes, piece);
}

const Lines messages{
    "7 TYPES -128 255 -32768 65535 -2147483648 4294967295 -9223372036854775808 18446744073709551615 11.62 0.1 x",
    "7 ARRAYS 1,2,255 1.5,-3e-06,123456792. \"a |b\" \"cde\" -1,300",
    "7 ARRAYS  0.,-0.,1e+30 \"\" \"\" ",
    "7 PONG",
    "7 ENERGY 57 11.62 1.64 19.1 0.08 0.97",
    "9 ESTIMATOR 185.3 -0.002",
    "7 ENERGY 58 11.61 1.7 19.7 0.09 0.98",
};

std::string message(std::size_t i, LinkVersion version) {
    return binary_message(messages[i], binary_dictionary(), version, {0, 3}).value();
}

std::string framed(Framing framing, LinkVersion version, bool escaped = false) {
    std::string bytes;
    for (std::size_t i = 0; i < messages.size(); ++i) {
        const auto bare = message(i, version);
        if (framing == Framing::card) bytes += card_frame(bare, static_cast<std::uint32_t>(10000 * i));
        if (framing == Framing::link) bytes += link_frame(bare);
        if (framing == Framing::xbee) bytes += xbee_frame(bare, i % 3 == 0 ? 0x80 : i % 3 == 1 ? 0x81 : 0x90, escaped);
    }
    return bytes;
}

TEST(LinkDecoder, DecodesEveryTypeInEveryFramingAndVersion) {
    Lines timed;
    for (std::size_t i = 0; i < messages.size(); ++i) timed.push_back(fmt::format("{}.0000 {}", i, messages[i]));
    for (const auto version : {LinkVersion::v1, LinkVersion::v2}) {
        EXPECT_EQ(decoded(framed(Framing::card, version)), timed) << to_string(version);
        EXPECT_EQ(decoded(framed(Framing::link, version)), messages) << to_string(version);
        EXPECT_EQ(decoded(framed(Framing::xbee, version)), messages) << to_string(version);
        EXPECT_EQ(decoded(framed(Framing::xbee, version, true)), messages) << to_string(version);
    }
}

/// The numbers that the words of its text are; NaN for arrays, texts and what is not finite.
TEST(LinkDecoder, GivesTheValuesOfFields) {
    LinkDecoder decoder(binary_dictionary(), Framing::link, LinkVersion::v2);
    std::size_t count = 0;
    const auto sink = [&](const LinkMessage& message) {
        ++count;
        if (message.name == "ARRAYS") {
            for (const double value : message.values) EXPECT_TRUE(std::isnan(value));
            return;
        }
        std::istringstream words{std::string(message.text)};
        std::string word;
        words >> word >> word;
        for (const double value : message.values) {
            words >> word;
            EXPECT_THAT(value, testing::NanSensitiveDoubleEq(number_or_nan(word))) << message.text;
        }
        EXPECT_FALSE(words >> word) << message.text;
    };
    decoder.push(framed(Framing::link, LinkVersion::v2), sink);
    decoder.flush(sink);
    EXPECT_EQ(count, messages.size());
}

TEST(LinkDecoder, TellsFramingAndVersion) {
    for (const auto framing : {Framing::card, Framing::link, Framing::xbee}) {
        for (const auto version : {LinkVersion::v1, LinkVersion::v2}) {
            LinkDecoder decoder(binary_dictionary());
            pushed(decoder, framed(framing, version), all_at_once);
            EXPECT_EQ(decoder.counts().framing, framing);
            EXPECT_EQ(decoder.counts().version, version);
            EXPECT_EQ(decoder.counts().messages, messages.size());
            EXPECT_EQ(decoder.counts().skipped_bytes, 0u);
        }
    }
}

TEST(LinkDecoder, TakesBytesInPiecesOfAnySize) {
    for (const auto framing : {Framing::card, Framing::link, Framing::xbee}) {
        const auto bytes = framed(framing, LinkVersion::v2);
        const auto whole = decoded(bytes);
        for (const std::size_t piece : {1, 2, 3, 7, 64, 255}) {
            EXPECT_EQ(decoded(bytes, framing, piece), whole) << piece;
            EXPECT_EQ(decoded(bytes, std::nullopt, piece), whole) << piece;
        }
    }
}

TEST(LinkDecoder, HandsAMessageOutWithItsLastByte) {
    LinkDecoder decoder(binary_dictionary(), Framing::link);
    const auto frame = link_frame(message(4, LinkVersion::v1));
    EXPECT_THAT(pushed(decoder, frame.substr(0, frame.size() - 1), all_at_once, false), IsEmpty());
    EXPECT_THAT(pushed(decoder, frame.substr(frame.size() - 1), all_at_once, false), ElementsAre(messages[4]));
}

TEST(LinkDecoder, KnowsTheDatalinkOfACardBySource) {
    const auto dictionary = binary_dictionary();
    const auto setting = binary_message("7 SETTING 3 0.5", dictionary, LinkVersion::v1).value();
    const auto bytes = card_frame(message(4, LinkVersion::v1), 0) + card_frame(setting, 10, 1) +
                       card_frame(message(4, LinkVersion::v1), 20);
    EXPECT_THAT(decoded(bytes),
                ElementsAre("0.0000 " + messages[4], "0.0010 7 SETTING 3 0.5", "0.0020 " + messages[4]));
}

TEST(LinkDecoder, ClassesOfV2HaveIdsOfTheirOwn) {
    const auto setting = binary_message("0 SETTING 3 0.5", binary_dictionary(), LinkVersion::v2).value();
    const auto bytes =
        link_frame(message(4, LinkVersion::v2)) + link_frame(setting) + link_frame(message(3, LinkVersion::v2));
    EXPECT_THAT(decoded(bytes), ElementsAre(messages[4], "0 SETTING 3 0.5", messages[3]));
}

TEST(LinkDecoder, CountsTheTimeOnWhereItStartsAnew) {
    const auto pong = message(3, LinkVersion::v1);
    std::string bytes;
    for (const std::uint32_t time : {0xFFFFFF00U, 0xFFFFFFFFU, 5U, 0xFFFFFFF0U, 10U}) bytes += card_frame(pong, time);
    EXPECT_THAT(decoded(bytes), ElementsAre("429496.7040 7 PONG", "429496.7295 7 PONG", "429496.7301 7 PONG",
                                            "429496.7280 7 PONG", "429496.7306 7 PONG"));
    bytes.clear();
    for (const std::uint32_t time : {1'000'000U, 4'000'000'000U, 1'000'100U}) bytes += card_frame(pong, time);
    EXPECT_THAT(decoded(bytes), ElementsAre("100.0000 7 PONG", "400000.0000 7 PONG", "100.0100 7 PONG"))
        << "one wild time is no restart";
}

TEST(LinkDecoder, TakesTheTimesOfAnOpenLog) {
    const auto dictionary = binary_dictionary();
    const auto stamp = [&](const std::string& ms) {
        return link_frame(binary_message("7 TIMESTAMP " + ms, dictionary, LinkVersion::v1).value());
    };
    const auto pong = link_frame(message(3, LinkVersion::v1));
    EXPECT_THAT(decoded(pong + stamp("1500") + pong + pong + stamp("1600") + pong),
                ElementsAre("7 PONG", "1.5000 7 TIMESTAMP 1500", "1.5000 7 PONG", "1.5000 7 PONG",
                            "1.6000 7 TIMESTAMP 1600", "1.6000 7 PONG"));
}

TEST(LinkDecoder, PrintsWhatWouldEndAFieldAsSomethingElse) {
    const std::string text = "7 ARRAYS 1 1.,1.,1. \"a\"b\n\" \"x\" 1";
    auto bytes = binary_message("7 ARRAYS 1 1.,1.,1. \"a_b_\" \"x\" 1", binary_dictionary(), LinkVersion::v1).value();
    bytes.replace(bytes.find("a_b_"), 4, "a\"b\n");
    EXPECT_THAT(decoded(link_frame(bytes)), ElementsAre("7 ARRAYS 1 1.,1.,1. \"a?b?\" \"x\" 1"));
    const auto nan = binary_message("7 ESTIMATOR nan inf", binary_dictionary(), LinkVersion::v1).value();
    EXPECT_THAT(decoded(link_frame(nan)), ElementsAre("7 ESTIMATOR nan inf"));
}

/// Every float comes back from its text, and in no more digits than it takes.
TEST(LinkDecoder, PrintsFloatsThatReadBack) {
    std::mt19937 random(20);
    std::uniform_int_distribution<std::uint32_t> bits;
    const auto dictionary = binary_dictionary();
    for (int i = 0; i < 20000; ++i) {
        const auto pattern = bits(random);
        float value = 0.0F;
        std::memcpy(&value, &pattern, sizeof value);
        auto bytes = binary_message("7 ESTIMATOR 0 0", dictionary, LinkVersion::v1).value();
        std::memcpy(bytes.data() + 2, &value, sizeof value);
        LinkDecoder decoder(dictionary, Framing::link, LinkVersion::v1);
        const auto line = pushed(decoder, link_frame(bytes), all_at_once).at(0);
        const auto word = line.substr(12, line.find(' ', 12) - 12);
        const float read = std::strtof(word.c_str(), nullptr);
        EXPECT_TRUE(std::isnan(value) ? std::isnan(read) : read == value) << line << " " << value;
    }
}

TEST(LinkDecoder, FindsTheFramesBehindADamagedLength) {
    for (const auto framing : {Framing::card, Framing::link}) {
        for (int length = 0; length < 256; ++length) {
            auto bytes = framed(framing, LinkVersion::v1);
            const auto first = framing == Framing::card ? card_frame(message(0, LinkVersion::v1), 0).size()
                                                        : link_frame(message(0, LinkVersion::v1)).size();
            if (static_cast<unsigned char>(bytes[first + 1]) == length) continue;
            bytes[first + 1] = static_cast<char>(length);
            LinkDecoder decoder(binary_dictionary(), framing, LinkVersion::v1);
            EXPECT_EQ(pushed(decoder, bytes, all_at_once).size(), messages.size() - 1) << length;
            EXPECT_GT(decoder.counts().skipped_bytes, 0u);
            EXPECT_EQ(decoder.counts().skipped_runs, 1u);
        }
    }
}

TEST(LinkDecoder, TellsRoomThatWasSetAsideFromDamage) {
    auto bytes = framed(Framing::card, LinkVersion::v2);
    const auto size = bytes.size();
    LinkDecoder decoder(binary_dictionary());
    EXPECT_EQ(pushed(decoder, bytes + std::string(5000, '\0'), all_at_once).size(), messages.size());
    EXPECT_EQ(decoder.counts().padding_bytes, 5000u);
    EXPECT_EQ(decoder.counts().skipped_bytes, 0u);
    LinkDecoder cut(binary_dictionary());
    EXPECT_EQ(pushed(cut, bytes.substr(0, size - 5) + std::string(5000, '\0'), all_at_once).size(),
              messages.size() - 1);
    EXPECT_GT(cut.counts().skipped_bytes, 10u);
    EXPECT_GE(cut.counts().padding_bytes, 5000u);
}

TEST(LinkDecoder, SurvivesGarbageOfAnyKindAndCountsEveryByte) {
    std::mt19937 random(4);
    std::uniform_int_distribution<int> byte(0, 255);
    for (const char sync : {'\x99', '\x7E', '\0'}) {
        for (const auto framing : {Framing::card, Framing::link, Framing::xbee}) {
            LinkDecoder decoder(binary_dictionary(), framing, LinkVersion::v1);
            std::string garbage(100'000, sync);
            for (std::size_t i = 0; sync == '\0' && i < garbage.size(); ++i)
                garbage[i] = static_cast<char>(byte(random));
            const auto good = framed(framing, LinkVersion::v1);
            const auto lines = pushed(decoder, garbage + good + garbage, 1000);
            EXPECT_GE(lines.size(), messages.size());
            EXPECT_LE(lines.size(), messages.size() + 3) << "collisions of checksums";
            EXPECT_EQ(decoder.counts().bytes, 2 * garbage.size() + good.size());
            EXPECT_GE(decoder.counts().skipped_bytes, 2 * garbage.size() - 200);
        }
    }
}

TEST(LinkDecoder, SaysNothingOfWhatIsNotDefined) {
    LinkDecoder decoder(binary_dictionary(), Framing::link, LinkVersion::v1);
    const auto unknown = link_frame(std::string("\7\310xyz", 5));
    const auto longer = link_frame(std::string("\7\3xyz", 5));
    EXPECT_THAT(pushed(decoder, unknown + longer + link_frame(message(3, LinkVersion::v1)) + longer, all_at_once),
                ElementsAre("7 PONG"));
    EXPECT_EQ(decoder.counts().unknown_ids, (std::map<std::uint16_t, std::size_t>{{256 + 200, 1}}));
    EXPECT_EQ(decoder.counts().other_length_ids, (std::map<std::uint16_t, std::size_t>{{256 + 3, 2}}));
}

Lines texts_of(const std::filesystem::path& log, const MessageDictionary& dictionary, LinkCounts* counts = nullptr) {
    LinkDecoder decoder(dictionary);
    Lines texts;
    const auto sink = [&](const LinkMessage& message) { texts.emplace_back(message.text); };
    const auto bytes = read_file(log);
    decoder.push(bytes, sink);
    decoder.flush(sink);
    if (counts != nullptr) *counts = decoder.counts();
    return texts;
}

TEST(LinkDecoder, DecodesRealCapturesAsTheCardsThatWereMadeOfThem) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto dictionary = read_message_dictionary(test::shared_dir() / "flights" / "09_05_13__14_38_13.log");
    const auto folder = test::shared_dir() / "archives" / "binary";
    LinkCounts counts;
    for (const std::string name : {"pprz", "xbee"}) {
        const auto capture = texts_of(folder / (name + ".bin"), dictionary, &counts);
        EXPECT_EQ(capture, texts_of(folder / (name + ".LOG"), dictionary));
        EXPECT_EQ(counts.version, LinkVersion::v1);
        EXPECT_EQ(counts.frames, name == "pprz" ? 941u : 4980u);
        EXPECT_EQ(counts.skipped_bytes, name == "pprz" ? 0u : 9u) << "xbee.bin begins within a frame";
    }
}

}  // namespace
}  // namespace flightwatt::telemetry
