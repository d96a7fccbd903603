#include "report/document/columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

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

TEST(DeflatedBase64, OpensToTheSameText) {
    std::string text;
    for (int length = 0; length < 40; ++length) {  // all lengths of the last base64 digits
        const auto block = deflated_base64(text);
        EXPECT_EQ(block.size() % 4, 0U);
        EXPECT_EQ(block.find_first_not_of(std::string(digits) + "="), std::string::npos);
        EXPECT_EQ(opened(block), text);
        text += static_cast<char>('a' + length * 7 % 26);
    }
    EXPECT_EQ(opened(deflated_base64("αβγ </script>\n")), "αβγ </script>\n");
}

TEST(DeflatedBase64, IsSmallAndTheSameEveryTime) {
    const std::string text(100'000, 'x');
    EXPECT_LT(deflated_base64(text).size(), 400U);
    EXPECT_EQ(deflated_base64(text), deflated_base64(text));
}

TEST(Columns, AreRoundedAndHaveNullForWhatIsNoNumber) {
    const std::vector<double> values{1234.5678, -0.04, 0.1 + 0.2, std::nan("")};
    EXPECT_EQ(rounded_column(values, 1).dump(), "[1234.6,0.0,0.3,null]");
    EXPECT_EQ(column_of({1234.56789, 0.000123456789, 0.0, 1e20}).dump(), "[1234.57,0.000123457,0.0,1e+20]");
    EXPECT_TRUE(rounded_json(std::numeric_limits<double>::infinity(), 2).is_null());
}

TEST(VisibleRows, AreAllOfAShortLine) {
    const std::vector<double> time_s{0.0, 1.0, 5.0};
    EXPECT_EQ(downsample_m4(time_s, {3.0, 1.0, 2.0}, 1), (std::vector<std::size_t>{0, 1, 2}));
}

/// Pixel columns look the same: each keeps its ends and extremes.
TEST(VisibleRows, KeepTheExtremesOfEveryColumn) {
    constexpr std::size_t columns = 10;
    std::vector<double> time_s;
    std::vector<double> values;
    for (int i = 0; i <= 1000; ++i) {
        time_s.push_back(i);
        values.push_back(std::sin(0.7 * i) * i);
    }
    const auto rows = downsample_m4(time_s, values, columns);
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
    EXPECT_LE(rows.size(), 4 * columns);
    EXPECT_EQ(rows.front(), 0U);
    EXPECT_EQ(rows.back(), 1000U);
    const std::set<std::size_t> kept(rows.begin(), rows.end());
    for (std::size_t column = 0; column < columns; ++column) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(100 * column);
        const auto greatest = std::max_element(begin, begin + 100) - values.begin();
        const auto least = std::min_element(begin, begin + 100) - values.begin();
        EXPECT_TRUE(kept.contains(static_cast<std::size_t>(greatest))) << column;
        EXPECT_TRUE(kept.contains(static_cast<std::size_t>(least))) << column;
    }
}

}  // namespace
}  // namespace flightwatt::report
