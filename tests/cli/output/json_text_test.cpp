// JSON as stages print it.

#include "cli/output/json_text.h"

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

TEST(JsonText, EndsWithALineBreakAndReplacesWhatIsNotUtf8) {
    EXPECT_EQ(json_text({{"flight", "caf\xE9"}}), "{\n  \"flight\": \"caf\xEF\xBF\xBD\"\n}\n");
}

TEST(OptionalJson, IsNullForWhatIsNotKnown) {
    EXPECT_EQ(optional_json(std::optional<double>(2.5)).dump(), "2.5");
    EXPECT_EQ(optional_json(std::optional<std::string>()).dump(), "null");
}

}  // namespace
}  // namespace flightwatt::cli
