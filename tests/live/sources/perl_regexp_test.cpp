#include "live/sources/perl_regexp.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using testing::ElementsAre;
using testing::Optional;

TEST(PerlRegexp, FindsTheGroupsOfSubscriptions) {
    EXPECT_THAT(PerlRegexp::compile("(.*)")->groups_in("20 ENERGY 57"), Optional(ElementsAre("20 ENERGY 57")));
    EXPECT_THAT(PerlRegexp::compile("^([^ ]*) +(ENERGY( .*|$))")->groups_in("20 ENERGY 57"),
                Optional(ElementsAre("20", "ENERGY 57", " 57")));
    EXPECT_THAT(PerlRegexp::compile(R"(^(\d+) (?:BAT|(ALIVE))?)")->groups_in("20 PONG "),
                Optional(ElementsAre("20", "")));
    EXPECT_THAT(PerlRegexp::compile("ALIVE")->groups_in("20 ALIVE"), Optional(ElementsAre()));
    EXPECT_FALSE(PerlRegexp::compile("^ALIVE")->groups_in("20 ALIVE"));
    EXPECT_FALSE(PerlRegexp::compile("(20"));
    std::string long_text(5000, 'a');
    long_text.back() = 'b';
    EXPECT_FALSE(PerlRegexp::compile("(a+)+$")->groups_in(long_text));  // gives up
}

}  // namespace
}  // namespace flightwatt::live
