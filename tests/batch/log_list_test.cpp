#include "batch/log_list.h"

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using testing::ElementsAre;

TEST(LogList, KeepsWhatALogIs) {
    LogList logs;
    EXPECT_TRUE(logs.empty());
    logs.push_back({"in/b.data", "b", "rough", "", false, true, "/home/in/b.data"});
    logs.push_back({"/home/a\n.data", "a", "", std::string("cannot\0be", 9), true, false, "/home/a\n.data"});
    logs.push_back({""});
    ASSERT_EQ(logs.size(), 3U);
    const auto first = logs[0];
    EXPECT_THAT((std::vector{first.path, first.flight, first.why_not_fitted, first.problem, first.place}),
                ElementsAre("in/b.data", "b", "rough", "", "/home/in/b.data"));
    EXPECT_FALSE(first.is_of_this_run);
    EXPECT_TRUE(first.is_missing);
    const auto second = logs[1];
    EXPECT_THAT((std::vector{second.path, second.flight, second.why_not_fitted, second.problem, second.place}),
                ElementsAre("/home/a\n.data", "a", "", std::string("cannot\0be", 9), "/home/a\n.data"));
    EXPECT_TRUE(second.is_of_this_run);
    EXPECT_FALSE(second.is_missing);
    EXPECT_EQ(logs.place(1), "/home/a\n.data");
    EXPECT_EQ(logs[2].place, "");
    EXPECT_THAT(logs.by_flight(), ElementsAre(2, 1, 0));
    EXPECT_THAT(logs.by_path(), ElementsAre(2, 0, 1)) << "what is not from the root comes first";
}

TEST(LogList, OrdersPathsAsTheStandardLibraryDoes) {
    std::mt19937 random(20261123);
    const std::string letters = "ab/.-~ \xE9";
    std::uniform_int_distribution<std::size_t> letter(0, letters.size() - 1);
    std::uniform_int_distribution<std::size_t> length(1, 8);
    const auto path = [&] {
        std::string text(length(random), ' ');
        for (auto& c : text) c = letters[letter(random)];
        return std::filesystem::path(text).lexically_normal();
    };
    int differing = 0;
    for (int i = 0; i < 20'000; ++i) {
        const auto one = path();
        const auto other = path();
        if (!one.has_filename() || !other.has_filename()) continue;  // no log
        ASSERT_EQ(path_less(one.string(), other.string()), one < other) << one << " and " << other;
        if ((one < other) != (one.string() < other.string())) ++differing;
    }
    EXPECT_GT(differing, 100) << "or letters would do";
}

}  // namespace
}  // namespace flightwatt::batch
