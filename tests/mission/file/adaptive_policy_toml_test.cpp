#include "mission/file/adaptive_policy_toml.h"

#include "helpers/rejected.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

std::optional<AdaptivePolicy> policy(const std::string& text) {
    return read_adaptive_policy(parse_toml(text, "m.toml"));
}

TEST(AdaptivePolicyToml, ReadsAndRefuses) {
    EXPECT_FALSE(policy(""));
    EXPECT_FALSE(policy("[policy]\nkind = \"static\"\n"));
    EXPECT_EQ(policy("[policy]\nkind = \"adaptive\"\n")->decide_every_s, 0.0);
    EXPECT_EQ(policy("[policy]\nkind = \"adaptive\"\nprobability = 0.9\n")->probability, 0.9);
    const auto refused = [](const std::string& text) { return test::rejected([&] { policy(text); }); };
    EXPECT_EQ(refused("[policy]\nkind = \"adaptiv\"\n"),
              "m.toml:2:1: there is no policy 'adaptiv'; it is \"adaptive\" or \"static\"");
    EXPECT_EQ(
        refused("[policy]\nkind = \"static\"\nprobability = 0.9\n"),
        "m.toml:3:1: `probability` has no meaning with kind = \"static\"; leave it out, or make it kind = "
        "\"adaptive\"");
    EXPECT_EQ(refused("[policy]\nkind = \"adaptive\"\ndecide_every_s = 0\n"),
              "m.toml:3:1: decide_every_s = 0, expected 0.1 to 1000000");
}

}  // namespace
}  // namespace flightwatt::mission
