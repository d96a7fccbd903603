#include "base/fingerprint.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

std::string fingerprint(std::string_view a, std::string_view b = "") {
    Fingerprint result;
    result.add(a);
    result.add(b);
    return result.hex();
}

TEST(Fingerprint, TellsEveryChangedByteAndEverySplit) {
    const std::string text = "335.149 20 ENERGY 69 11.704956";
    std::set<std::string> seen{fingerprint(text)};
    for (std::size_t i = 0; i < text.size(); ++i) {
        auto changed = text;
        changed[i] = static_cast<char>(changed[i] ^ 1);
        EXPECT_TRUE(seen.insert(fingerprint(changed)).second) << i;
        EXPECT_TRUE(seen.insert(fingerprint(text.substr(0, i), text.substr(i))).second) << i;
    }
    EXPECT_EQ(fingerprint(text), fingerprint(text));
}

}  // namespace
}  // namespace flightwatt
