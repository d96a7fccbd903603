#include "telemetry/message_decoder.h"

#include "base/number.h"
#include "telemetry/log_reader.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::ElementsAre;
using testing::Pair;

const std::vector<MessageRequest> single_messages{{"ENERGY", {"throttle", "voltage", "power"}},
                                                  {"COMMANDS", {"values[0]"}}};

TEST(MessageDecoder, GivesTheRowsThatReadingALogGives) {
    const std::vector<std::string> lines{
        "1.5 20 ENERGY 60 11.5 2 23 0.5 5.5",
        "2 20 COMMANDS 7889,-2927,-945",
        "2.5 20 ENERGY 61 nan 2 23.25 0.5 5.5 ",
        "3 20 ENERGY 60 11.5",
        "4 20 PONG",
        "5 20 ENERGY 235. -0. 2 1e2 0.5 5.5\r",
    };
    std::string text;
    MessageDecoder decoder(std::nullopt, single_messages);
    std::vector<MessageTable> rows;
    for (const auto& line : lines) {
        text += line + "\n";
        const auto message = std::string_view(line).substr(line.find("20 ") + 3);
        if (const auto* row = decoder.decode(number_or_nan(line.substr(0, line.find(' '))), message))
            rows.push_back(*row);
    }
    const auto log = parse_telemetry(text, "x.data", std::nullopt, single_messages);
    std::vector<std::size_t> rows_of(log.senders.at(0).tables.size());
    for (const auto& row : rows) {
        const auto* table = log.senders[0].table(row.message);
        ASSERT_NE(table, nullptr);
        const auto at = rows_of[static_cast<std::size_t>(table - log.senders[0].tables.data())]++;
        EXPECT_EQ(row.time_s.at(0), table->time_s.at(at));
        ASSERT_EQ(row.columns.size(), table->columns.size());
        for (std::size_t c = 0; c < row.columns.size(); ++c) {
            EXPECT_EQ(row.columns[c].field, table->columns[c].field);
            EXPECT_EQ(row.columns[c].quantity, table->columns[c].quantity);
            EXPECT_THAT(row.columns[c].values.at(0), testing::NanSensitiveDoubleEq(table->columns[c].values.at(at)));
        }
    }
    EXPECT_THAT(rows_of, ElementsAre(3U, 1U));
    MessageDecoder::Skipped skipped;
    for (const auto& lines_of : log.skipped) skipped[lines_of.reason] += lines_of.count();
    EXPECT_EQ(decoder.skipped(), skipped);
    EXPECT_THAT(decoder.assumed_definitions(), testing::ContainerEq(log.assumed_definitions));
}

TEST(MessageDecoder, TakesNumbersAsTheyAre) {
    MessageDecoder decoder(std::nullopt, single_messages);
    const auto* row = decoder.decode(1.0, "ENERGY", std::vector<double>{60.0, 11.5, 2.0, std::nan(""), 0.5, 5.5});
    ASSERT_NE(row, nullptr);
    EXPECT_EQ(row->column("voltage")->values.front(), 11.5);
    EXPECT_TRUE(std::isnan(row->column("power")->values.front()));
    EXPECT_EQ(decoder.decode(2.0, "ENERGY", std::vector<double>{60.0}), nullptr);
    EXPECT_THAT(decoder.skipped(), ElementsAre(Pair("ENERGY.power: not a finite number", 1U),
                                               Pair("ENERGY: another number of fields than is known", 1U)));
}

TEST(MessageDecoder, ChoosesBuiltInDefinitionsOncePerLog) {
    MessageDecoder decoder(std::nullopt, single_messages);
    ASSERT_NE(decoder.decode(1.0, "ENERGY 60 11.5 2 23 0.5 5.5"), nullptr);
    EXPECT_EQ(decoder.decode(2.0, "ENERGY 11.5 2 23 0.5"), nullptr);
    decoder.restart();
    EXPECT_TRUE(decoder.assumed_definitions().empty());
    ASSERT_NE(decoder.decode(3.0, "ENERGY 60 11.5 2 23 0.5 5.5"), nullptr);
}

}  // namespace
}  // namespace flightwatt::telemetry
