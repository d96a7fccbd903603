#include "telemetry/link_encoder.h"

#include "telemetry/link_decoder.h"

#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

const std::string definitions = R"(<protocol><msg_class NAME="telemetry" ID="1">
<message name="ALL" id="7"><field name="a" type="uint8"/><field name="b" type="int8"/><field name="c" type="uint16"/>
<field name="d" type="int16"/><field name="e" type="uint32"/><field name="f" type="int32"/><field name="g" type="float"/>
<field name="h" type="double"/><field name="i" type="int64"/><field name="j" type="uint64"/></message>
<message name="LISTS" id="8"><field name="a" type="int16[]"/><field name="b" type="float[2]"/><field name="c" type="char[]"/>
<field name="d" type="char[4]"/></message>
<message name="NOTE" id="9"><field name="a" type="uint8"/><field name="b" type="string"/></message>
<message name="EMPTY" id="10"/></msg_class>
<msg_class NAME="datalink" ID="2"><message name="SETTING" id="7"><field name="a" type="uint8"/></message></msg_class>
</protocol>)";

class LinkEncoderTest : public testing::TestWithParam<LinkVersion> {
  protected:
    /// What a decoder makes of the frames of these lines.
    std::vector<std::string> there_and_back(const std::vector<std::string>& lines) {
        LinkEncoder encoder(dictionary, GetParam());
        std::string frames;
        for (const auto& line : lines) EXPECT_EQ(encoder.append_frame(line, frames), "") << line;
        LinkDecoder decoder(dictionary, Framing::link, GetParam());
        std::vector<std::string> texts;
        const auto keep = [&](const LinkMessage& message) { texts.emplace_back(message.text); };
        decoder.push(frames, keep);
        decoder.flush(keep);
        return texts;
    }

    const MessageDictionary dictionary = parse_message_dictionary(definitions, "messages.xml");
};

TEST_P(LinkEncoderTest, MakesFramesThatADecoderTurnsIntoTheSameLines) {
    const std::vector<std::string> lines{
        "20 ALL 255 -128 65535 -32768 4294967295 -2147483648 11.704956 -3e-300 -9223372036854775808 18446744073709551615",
        "1 ALL 0 0 0 0 0 0 nan 235. 0 0",
        R"(255 LISTS 94,0,-1454 0.5,-1. "two words" "abcd")",
        R"(7 LISTS  1.,2. "" "a")",
        R"(7 NOTE 1 ", FLIGHT_RECORDER\fr_0219.LOG")",
        "7 EMPTY",
    };
    EXPECT_EQ(there_and_back(lines), lines);
    // As text may have them, too.
    EXPECT_THAT(
        there_and_back({R"(7 NOTE 1 , FLIGHT_RECORDER\fr_0219.LOG)", "7 NOTE 2 |so it is|", "7 EMPTY "}),
        testing::ElementsAre(R"(7 NOTE 1 ", FLIGHT_RECORDER\fr_0219.LOG")", R"(7 NOTE 2 "so it is")", "7 EMPTY"));
}

TEST_P(LinkEncoderTest, SaysWhyALineCannotBeAFrame) {
    LinkEncoder encoder(dictionary, GetParam());
    std::string frames;
    EXPECT_EQ(encoder.append_frame("ground EMPTY", frames), "their sender is not an aircraft");
    EXPECT_EQ(encoder.append_frame("256 EMPTY", frames), "their sender is not an aircraft");
    for (const auto* unknown : {"20 SETTING 1", "20 NEVER 1", "20", ""}) {
        EXPECT_NE(encoder.append_frame(unknown, frames), "") << unknown;
    }
    for (const auto* wrong : {"20 EMPTY 1", "20 NOTE 256 a", "20 NOTE -1 a", "20 NOTE 1.5 a", "20 LISTS 1 1. a abcd",
                              "20 LISTS 1 1.,2. a abcde", "20 LISTS 1,,2 1.,2. a abcd", "20 ALL 1"}) {
        EXPECT_EQ(encoder.append_frame(wrong, frames), "their fields do not match the definition") << wrong;
    }
    EXPECT_EQ(encoder.append_frame("20 NOTE 1 " + std::string(250, 'x'), frames), "they are too long for a frame");
    EXPECT_EQ(frames, "");
}

INSTANTIATE_TEST_SUITE_P(Versions, LinkEncoderTest, testing::Values(LinkVersion::v1, LinkVersion::v2));

}  // namespace
}  // namespace flightwatt::telemetry
