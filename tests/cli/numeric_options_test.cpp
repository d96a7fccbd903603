// Options that hold numbers: what is taken, and what is refused with which words.

#include "cli/numeric_options.h"

#include "base/error.h"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

namespace po = boost::program_options;

StageCall call_with(const std::vector<std::string>& arguments) {
    po::options_description options;
    options.add_options()("count", po::value<std::string>())("capacity", po::value<double>());
    StageCall call;
    po::store(po::command_line_parser(arguments).options(options).run(), call.options);
    return call;
}

std::string refusal(const std::function<void()>& read) {
    try {
        read();
    } catch (const UsageError& error) {
        return error.what();
    }
    return "nothing refused";
}

TEST(CountOption, TakesWholeNumbersInItsRange) {
    EXPECT_EQ(count_option(call_with({"--count", "0"}), "count"), 0U);
    EXPECT_EQ(count_option(call_with({"--count", "24"}), "count", 1, 24), 24U);
}

TEST(CountOption, RefusesOthersWithTheRange) {
    for (const auto* text : {"-1", "1.5", "many", "25"}) {
        const auto call = call_with({std::string("--count=") + text});
        EXPECT_EQ(refusal([&] { count_option(call, "count", 1, 24); }),
                  std::string("--count ") + text + ": expected a whole number from 1 to 24");
    }
    EXPECT_EQ(refusal([] { count_option(call_with({"--count=0"}), "count", 1); }),
              "--count 0: expected a whole number from 1");
    EXPECT_EQ(refusal([] { count_option(call_with({"--count=x"}), "count"); }), "--count x: expected a whole number");
}

TEST(NumberOption, LiesInItsRange) {
    EXPECT_EQ(number_option(call_with({"--capacity", "2.5"}), "capacity", 0.0, 2.5), 2.5);
    for (const auto* text : {"-1", "3", "inf", "nan"}) {
        const auto call = call_with({std::string("--capacity=") + text});
        EXPECT_EQ(refusal([&] { number_option(call, "capacity", 0.0, 2.5); }),
                  std::string("--capacity ") + text + ": expected 0 to 2.5");
    }
}

TEST(PositiveOption, IsAbsentOrAboveZero) {
    EXPECT_EQ(positive_option(call_with({}), "capacity", "Ah"), std::nullopt);
    EXPECT_EQ(positive_option(call_with({"--capacity", "2.5"}), "capacity", "Ah"), 2.5);
    for (const auto* text : {"0", "-2", "inf", "nan"}) {
        const auto call = call_with({std::string("--capacity=") + text});
        EXPECT_EQ(refusal([&] { positive_option(call, "capacity", "Ah"); }),
                  std::string("--capacity ") + text + ": expected more than 0 Ah");
    }
    EXPECT_EQ(refusal([] { positive_option(call_with({"--capacity=11"}), "capacity", "Ah", 10.0); }),
              "--capacity 11: expected more than 0 and at most 10 Ah");
}

}  // namespace
}  // namespace flightwatt::cli
