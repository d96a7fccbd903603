// The main of every test program. `--file=mission/plan_test.cpp` runs the tests of one source file; suites that are
// named ...Study take minutes and run with `--studies` only. Exit code 77 where a test was skipped and none failed.

#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {

/// Names of the tests of a file, or of all files if it is empty, separated by colons.
std::string tests_of(std::string_view file, bool studies) {
    std::string names;
    const auto& all = *testing::UnitTest::GetInstance();
    for (int s = 0; s < all.total_test_suite_count(); ++s) {
        const auto& suite = *all.GetTestSuite(s);
        if (std::string_view(suite.name()).ends_with("Study") != studies) continue;
        for (int t = 0; t < suite.total_test_count(); ++t) {
            const auto& test = *suite.GetTestInfo(t);
            if (!std::string_view(test.file()).ends_with(file)) continue;
            names += fmt::format("{}.{}:", suite.name(), test.name());
        }
    }
    return names;
}

}  // namespace

int main(int argc, char** argv) {
    GTEST_FLAG_SET(brief, true);  // failures alone
    testing::InitGoogleTest(&argc, argv);
    constexpr std::string_view file_option = "--file=";
    std::string file;
    bool studies = false;
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        if (argument == "--studies") {
            studies = true;
        } else if (argument.starts_with(file_option)) {
            file = fmt::format("/{}", argument.substr(file_option.size()));
        } else {
            fmt::print(stderr, "error: unknown argument '{}'; expected --file=FILE, --studies or a --gtest option\n",
                       argument);
            return 2;
        }
    }
    // A filter of exclusions ("-Suite.Test", also from GTEST_FILTER) narrows the file's tests; any other replaces them.
    const auto filter = GTEST_FLAG_GET(filter);
    if (filter == "*" || filter.starts_with('-')) {
        const auto names = tests_of(file, studies);
        if (names.empty() && studies) return 0;  // most modules have none
        if (names.empty()) {
            fmt::print(stderr, "error: no test in '{}'\n", file);
            return 2;
        }
        GTEST_FLAG_SET(filter, filter == "*" ? names : names + filter);
    }
    const int failed = RUN_ALL_TESTS();
    return failed == 0 && testing::UnitTest::GetInstance()->skipped_test_count() > 0 ? 77 : failed;
}
