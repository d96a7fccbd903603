
#include "report/sections/blocks.h"

#include <string>

#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// By RFC 4648, a digit at a time.
std::string bytes_of(const std::string& base64) {
    std::string bytes;
    unsigned bits = 0;
    int count = 0;
    for (const char c : base64.substr(0, base64.find('='))) {
        bits = bits << 6U | static_cast<unsigned>(digits.find(c));
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 0xFFU);
    }
    return bytes;
}

std::string opened(const std::string& block) {
    namespace io = boost::iostreams;
    const auto bytes = bytes_of(block);
    io::filtering_istream stream;
    stream.push(io::zlib_decompressor());
    stream.push(io::array_source(bytes.data(), bytes.size()));
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(CompressedBlock, OpensToTheSameText) {
    std::string text;
    for (int length = 0; length < 40; ++length) {  // all lengths of the last base64 digits
        const auto block = compressed_block(text);
        EXPECT_EQ(block.size() % 4, 0U);
        EXPECT_EQ(block.find_first_not_of(std::string(digits) + "="), std::string::npos);
        EXPECT_EQ(opened(block), text);
        text += static_cast<char>('a' + length * 7 % 26);
    }
    EXPECT_EQ(opened(compressed_block("αβγ </script>\n")), "αβγ </script>\n");
}

TEST(CompressedBlock, IsSmallAndTheSameEveryTime) {
    const std::string text(100'000, 'x');
    EXPECT_LT(compressed_block(text).size(), 400U);
    EXPECT_EQ(compressed_block(text), compressed_block(text));
}

TEST(PackedTables, AreStepsInTheLastDecimalAndTexts) {
    FigureData data({"time_s", "power_w"}, {"curve"});
    data.add({8.0, 36.62}, {"measured, \"really\""});
    data.add({9.1, -0.5}, {"measured"});
    data.add({10.25, std::nan("")}, {""});
    data.add({11.0, 7.0}, {"model"});
    const VegaJson spec{{"layer", {{{"data", data.json()}, {"mark", "line"}}}}};
    const auto packed = VegaJson::parse(
        R"({"layer": [{"data": {"packed": [["time_s", 2, [800, 110, 115, 75]], ["power_w", 2, [3662, -3712, null, 750]],
                                           ["curve", ["measured, \"really\"", "measured", "", "model"]]]},
                       "mark": "line"}]})");
    EXPECT_EQ(packed_tables(spec), packed);
}

TEST(PackedTables, HaveExponentsInTheDecimalsOfTheOthers) {
    FigureData data({"tiny", "great"});
    data.add({1.5e-9, 2e12});
    data.add({0.25, 3.0});
    EXPECT_EQ(packed_tables(data.json()),
              VegaJson::parse(R"({"packed": [["tiny", 2, [0, 25]], ["great", 0, [2000000000000, -1999999999997]]]})"));
}

TEST(PackedTables, LeaveEverythingElse) {
    const auto spec = VegaJson::parse(R"({"data": {"values": [{"a": 1}]}, "datasets": {"edges": "a,b\n1,2"},
                               "list": [1, null, "text"]})");
    EXPECT_EQ(packed_tables(spec), spec);
}

TEST(PackedTables, OfATableWithoutRowsHaveItsColumns) {
    EXPECT_EQ(packed_tables(FigureData({"x"}, {"word"}).json()),
              VegaJson::parse(R"({"packed": [["x", 0, []], ["word", []]]})"));
}

}  // namespace
}  // namespace flightwatt::report
