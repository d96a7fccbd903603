#include "report/plain_answers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Escaped, LeavesNoMarkup) {
    EXPECT_EQ(html_escaped("<script>\"a\" & 'b'\x01</script>"),
              "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39; &lt;/script&gt;");
}

Json some_document() {
    return Json::parse(
        R"({"answer": null, "headline": "<two> missions", "aircraft": [{"name": "7", "text": "2 flights"}],
        "missions": [{"title": "survey", "card": {"words": "below reserve", "landing": "12 %", "probability": "3 %",
                      "reach_name": "Longest cruise", "reach": "9 min", "help": "1 min less cruise"}}],
        "flights": [{"name": "a", "date": "2020-01-01 10:00", "rejected": "",
                     "sorties": [{"in_air_s": 600, "energy_wh": 5.017}, {"in_air_s": 30, "energy_wh": null}]},
                    {"name": "b", "date": "", "rejected": "no <flight>", "sorties": []}],
        "warnings": ["below 0 W"], "notes": [], "facts": [{"name": "by", "text": "flightwatt"}]})");
}

TEST(PlainAnswers, HaveMissionsAndFlightsAsTables) {
    const auto html = plain_answers(some_document());
    EXPECT_THAT(html, HasSubstr("<h1>&lt;two&gt; missions</h1>"));
    EXPECT_THAT(html, HasSubstr("<th scope=\"row\">survey</th><td>below reserve</td><td>12 %</td><td>3 %</td>"));
    EXPECT_THAT(html, HasSubstr("<td>2020-01-01 10:00</td><td>10 min</td><td>5.02 Wh</td>"));
    EXPECT_THAT(html, HasSubstr("<td>30.0 s</td><td>unknown</td>"));
    EXPECT_THAT(html, HasSubstr("not used: no &lt;flight&gt;"));
    EXPECT_THAT(html, HasSubstr("<li>below 0 W</li>"));
    EXPECT_THAT(html, Not(HasSubstr("<script")));
}

TEST(PlainAnswers, BeginWithTheAnswer) {
    auto document = some_document();
    document["answer"] = Json::parse(
        R"({"headline": "7: 3 flights", "lines": [{"label": "Time", "value": "10 min", "basis": " (measured)"
}]
})");
    const auto html = plain_answers(document);
EXPECT_THAT(html, testing::StartsWith("<h1>7: 3 flights</h1>\n<dl>\n<dt>Time</dt><dd>10 min (measured)</dd>"));
EXPECT_THAT(html, HasSubstr("<h2>&lt;two&gt; missions</h2>"));
}

}  // namespace
}  // namespace flightwatt::report
