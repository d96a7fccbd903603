#include "telemetry/binary_log.h"

#include "base/atomic_file.h"
#include "helpers/binary_definitions.h"
#include "helpers/binary_frames.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"
#include "telemetry/log_reader.h"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using test::binary_dictionary;
using test::card_log;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

const std::vector<MessageRequest> wanted{{"ENERGY", {"voltage", "power", "charge"}}, {"ESTIMATOR", {"z"}}};

/// Two aircraft, with values that floats do not hold exactly.
std::string made_data(std::size_t lines) {
    std::string data;
    for (std::size_t i = 0; i < lines; ++i) {
        const double time_s = 40.0 + 0.05 * static_cast<double>(i);
        data += fmt::format("{:.4f} 7 ENERGY 57 {:.3f} 1.64 {:.3f} {:.5f} 0.97\n", time_s, 12.6 - 0.001 * i,
                            19.1 + 0.01 * i, 0.0001 * i);
        data += fmt::format("{:.4f} {} ESTIMATOR {:.2f} 0.1\n", time_s, i % 3 == 0 ? 9 : 7, 185.0 + 0.1 * i);
        if (i % 10 == 0) data += fmt::format("{:.4f} 7 PONG\n", time_s);
    }
    return data;
}

LogConfiguration configuration() { return parse_log_configuration(test::binary_protocol, "messages.xml"); }

TelemetryLog binary(const std::string& bytes, const std::vector<MessageRequest>& requests = wanted) {
    const auto dictionary = binary_dictionary();
    const auto framing = detect_binary_framing(bytes);
    if (!framing) throw std::runtime_error("is text");
    return read_binary_telemetry({bytes, *framing, "x.LOG", "messages.xml", &dictionary}, configuration(), requests);
}

void expect_same(const TelemetryLog& a, const TelemetryLog& b) {
    ASSERT_EQ(a.senders.size(), b.senders.size());
    for (std::size_t i = 0; i < a.senders.size(); ++i) {
        EXPECT_EQ(a.senders[i].id, b.senders[i].id);
        ASSERT_EQ(a.senders[i].tables.size(), b.senders[i].tables.size());
        for (std::size_t t = 0; t < a.senders[i].tables.size(); ++t) {
            const auto& left = a.senders[i].tables[t];
            const auto& right = b.senders[i].tables[t];
            EXPECT_EQ(left.message, right.message);
            EXPECT_EQ(left.time_s, right.time_s);
            ASSERT_EQ(left.columns.size(), right.columns.size());
            for (std::size_t c = 0; c < left.columns.size(); ++c)
                EXPECT_EQ(left.columns[c].values, right.columns[c].values) << left.columns[c].field;
        }
    }
}

TEST(BinaryLog, ReadsIntoColumnsWhatItsTextDoes) {
    const auto data = made_data(500);
    const auto text = parse_telemetry(data, "x.data", configuration(), wanted);
    ASSERT_EQ(text.senders.size(), 2u);
    for (const auto version : {LinkVersion::v1, LinkVersion::v2})
        expect_same(binary(card_log(data, binary_dictionary(), version)), text);
}

TEST(BinaryFraming, IsToldByContent) {
    const auto data = made_data(20);
    EXPECT_EQ(detect_binary_framing(data), std::nullopt);
    EXPECT_EQ(detect_binary_framing(""), std::nullopt);
    EXPECT_EQ(detect_binary_framing("no telemetry\n\x99\x7E at all"), std::nullopt);
    const auto log = card_log(data, binary_dictionary(), LinkVersion::v2);
    EXPECT_EQ(detect_binary_framing(log), Framing::card);
    EXPECT_EQ(detect_binary_framing(std::string(3000, 'x') + log.substr(5)), Framing::card);
    EXPECT_EQ(detect_binary_framing(log.substr(0, 33) + std::string(3000, '\0')), Framing::card) << "one frame";
    EXPECT_EQ(detect_binary_framing(data + log), std::nullopt) << "text comes first";
    EXPECT_EQ(detect_binary_framing(std::string(10000, '\x99')), std::nullopt);
}

TEST(BinaryLog, CountsWhatItSkips) {
    const auto dictionary = binary_dictionary();
    const auto pong = test::card_frame(std::string("\7\3", 2), 10000);
    const auto unknown = test::card_frame(std::string("\7\310", 2), 20000);
    const auto longer = test::card_frame(std::string("\7\3x", 3), 30000);
    const auto nan =
        test::card_frame(test::binary_message("7 ESTIMATOR nan 1.", dictionary, LinkVersion::v1).value(), 40000);
    const auto log =
        binary(pong + pong + pong + unknown + longer + "junk" + nan + pong + pong + pong + pong.substr(0, 6));
    std::vector<std::string> reasons;
    for (const auto& skipped : log.skipped) reasons.push_back(describe(skipped));
    EXPECT_THAT(reasons, ElementsAre("message 200 of class 1: not defined in messages.xml: 1 frame, first at byte 31",
                                     "PONG: another length than messages.xml defines: 1 frame, first at byte 41",
                                     "damaged, no frame with a valid checksum: 4 bytes, first at byte 52",
                                     "ESTIMATOR.z: not a finite number: 1 frame, first at byte 56",
                                     "the last frame is cut off: 6 bytes, first at byte 104"));
    EXPECT_EQ(log.skipped.at(2).lines.at(0).time_s, 4.0) << "the next message's";
    EXPECT_TRUE(std::isinf(log.skipped.at(4).lines.at(0).time_s));
    EXPECT_TRUE(std::isnan(log.senders.at(0).table("ESTIMATOR")->column("z")->values.at(0)));
}

TEST(BinaryLog, ReadToATimeIsTheLogThatEndsThere) {
    const auto log = card_log(made_data(300), binary_dictionary(), LinkVersion::v2);
    const auto whole = binary(log);
    const auto& all = *whole.senders.at(0).table("ENERGY");
    const auto frame_end = log.find('\x99', log.size() / 2);
    const auto cut = binary(log.substr(0, frame_end));
    const auto& some = *cut.senders.at(0).table("ENERGY");
    ASSERT_GT(some.time_s.size(), 100u);
    ASSERT_LT(some.time_s.size(), all.time_s.size());
    for (std::size_t i = 0; i < some.time_s.size(); ++i) EXPECT_EQ(some.time_s[i], all.time_s[i]);
}

TEST(BinaryLog, RefusesDefinitionsOfAnotherBuild) {
    const auto log = card_log(made_data(100), binary_dictionary(), LinkVersion::v1);
    auto other = test::binary_protocol;
    const std::string field = "<field name=\"charge\" type=\"float\" unit=\"Ah\"/>";
    other.replace(other.find(field), field.size(), "");
    const auto dictionary = parse_message_dictionary(other, "other.xml");
    const auto refused = test::rejected([&] {
        read_binary_telemetry({log, Framing::card, "x.LOG", "other.xml", &dictionary},
                              parse_log_configuration(other, "other.xml"), wanted);
    });
    EXPECT_THAT(refused, HasSubstr("x.LOG: 100 of 210 messages have other lengths than other.xml defines"));
    EXPECT_THAT(refused, HasSubstr("--messages FILE"));
    const auto nothing = parse_message_dictionary(
        "<protocol><class name='telemetry'><message name='A' id='99'/></class></protocol>", "none.xml");
    EXPECT_THAT(test::rejected([&] {
                    link_version({log, Framing::card, "x.LOG", "none.xml", &nothing});
                }),
                HasSubstr("no message with the length that none.xml defines"));
}

TEST(BinaryLog, RefusesALinkWithoutTimes) {
    const auto dictionary = binary_dictionary();
    const auto energy = test::link_frame(
        test::binary_message("7 ENERGY 57 11.62 1.64 19.1 0.08 0.97", dictionary, LinkVersion::v2).value());
    EXPECT_THAT(test::rejected([&] { binary(energy + energy + energy); }), HasSubstr("have no times"));
    const auto stamp = test::link_frame(test::binary_message("7 TIMESTAMP 2500", dictionary, LinkVersion::v2).value());
    const auto log = binary(energy + stamp + energy + energy);
    EXPECT_THAT(log.senders.at(0).table("ENERGY")->time_s, ElementsAre(2.5, 2.5));
    EXPECT_EQ(describe(log.skipped.at(0)), "before the first TIMESTAMP: 1 frame, first at byte 1");
}

TEST(BinaryLog, CountsMessagesByName) {
    const auto log = card_log(made_data(100), binary_dictionary(), LinkVersion::v1);
    const auto dictionary = binary_dictionary();
    EXPECT_THAT(count_binary_messages({log, Framing::card, "x.LOG", "messages.xml", &dictionary}),
                ElementsAre(Pair("ENERGY", 100), Pair("ESTIMATOR", 100), Pair("PONG", 10)));
}

/// Whether two fields are the same, but for the digits that the ground's text has.
bool is_near(const std::string& card, const std::string& ground) {
    if (card == ground) return true;
    const auto numbers = test::detail::split(card, ',');
    const auto others = test::detail::split(ground, ',');
    if (numbers.size() != others.size()) return false;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double a = std::strtod(numbers[i].c_str(), nullptr);
        const double b = std::strtod(others[i].c_str(), nullptr);
        if (!(std::fabs(a - b) <= 1e-6 * std::max(1.0, std::fabs(b)))) return false;
    }
    return true;
}

/// The messages of a text by name, in their order: the words from the name on.
std::map<std::string, std::vector<std::vector<std::string>>> by_name(const std::string& text) {
    std::map<std::string, std::vector<std::vector<std::string>>> messages;
    for (const auto& line : test::detail::split(text, '\n')) {
        auto words = test::detail::split(line, ' ');
        if (words.size() < 3 || words[1] != "61") continue;
        if (words.back().empty()) words.pop_back();
        messages[words[2]].emplace_back(words.begin() + 2, words.end());
    }
    return messages;
}

/// The card's log of 2009 next to what the ground received: the same messages in the same order, but for some at the
/// ends. (The card's clock is 5 % fast, so that its times show little.)
TEST(BinaryLog, HoldsWhatTheGroundReceived) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto flights = test::shared_dir() / "flights";
    const auto bytes = read_file(test::shared_dir() / "archives" / "binary" / "00000026.LOG");
    LinkDecoder decoder(read_message_dictionary(flights / "09_05_13__14_38_13.log"));
    std::string text;
    const auto sink = [&](const LinkMessage& message) {
        text += fmt::format("{:.4f} {}\n", message.time_s.value(), message.text);
    };
    decoder.push(bytes, sink);
    decoder.flush(sink);
    EXPECT_EQ(decoder.counts().frames, 909u);
    EXPECT_EQ(decoder.counts().messages, 909u);
    EXPECT_EQ(decoder.counts().skipped_bytes, 0u);
    auto card = by_name(text);
    EXPECT_EQ(card["PONG"].size(), 10u) << "<message NAME=\"PONG\" ID=\"3\"/>, without fields";

    std::size_t compared = 0;
    std::size_t missing = 0;
    for (const auto& [name, received] : by_name(read_file(flights / "09_05_13__14_38_13.data"))) {
        if (name == "WIND_INFO") continue;  // sent to the aircraft
        const auto& stored = card[name];
        auto next = stored.begin();
        for (const auto& words : received) {
            const auto found = std::find_if(next, stored.end(), [&](const auto& other) {
                return std::equal(other.begin(), other.end(), words.begin(), words.end(), is_near);
            });
            ++compared;
            if (found == stored.end()) {
                ++missing;
            } else {
                next = found + 1;
            }
        }
    }
    EXPECT_EQ(compared, 907u);
    EXPECT_LE(missing, 4u);
}

TEST(BinaryLog, ReadsTheFirstElementOfAnArray) {
    const std::string data =
        "40.0 7 ARRAYS 3,4 1.5,2.5,3.5 ab cdefg 9600,-20,1\n40.1 7 ARRAYS 3,4 1.5,2.5,3.5 ab cdefg -5\n";
    const std::vector<MessageRequest> requests{{"ARRAYS", {"b[0]", "e[0]", "c[0]", "a"}}};
    const auto log = binary(card_log(data, binary_dictionary(), LinkVersion::v2), requests);
    const auto* table = log.senders.at(0).table("ARRAYS");
    EXPECT_THAT(table->column("b")->values, ElementsAre(1.5, 1.5));
    EXPECT_THAT(table->column("e")->values, ElementsAre(9600.0, -5.0));
    EXPECT_TRUE(std::isnan(table->column("c")->values[0])) << "is a text";
    EXPECT_TRUE(std::isnan(table->column("a")->values[0])) << "is an array of two";
}

}  // namespace
}  // namespace flightwatt::telemetry
