#include "record/record.h"

#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::record_test {

enum class Kind { plain, other };
std::string to_string(Kind kind) { return kind == Kind::plain ? "plain" : "other"; }

struct Part {
    int samples = 0;
    std::vector<double> power_w;
};

struct Whole {
    std::string name;
    double energy_wh = 0.0;
    std::optional<double> final_soc_percent;
    std::optional<Interval> interval;
    Kind kind = Kind::plain;
    bool complete = false;
    Part part;
    std::optional<Part> extra;
};

Fields<Part> record_fields(const Part*) {
    return {field("samples", &Part::samples, "their number", csv_column{}),
            field("power_w", &Part::power_w, "their power")};
}

Fields<Whole> record_fields(const Whole*) {
    using R = Whole;
    return list_fields<R>(
        field("name", &R::name, "its name", column{"who"}, csv_column{}),
        field("energy_wh", &R::energy_wh, "energy", column{}, csv_column{}),
        field("final_soc_percent", &R::final_soc_percent, "charge", column_if_any("SoC", ".2f"), csv_column{},
              optional_key{}),
        field("energy_wh_interval_95", &R::interval, "its interval", column{"low Wh|high Wh"}, csv_column{}),
        field("kind", &R::kind, "its kind"), field("complete", &R::complete, "complete", column{}), embedded(&R::part),
        field(
            "doubled", [](const R& r) { return 2.0 * r.energy_wh; }, "twice", csv_column{}, not_in_json{}),
        field("extra", &R::extra, "one more", optional_key{}));
}

Whole example() { return {"first, \"up\"", 1.23456, 50.5, Interval{1.0, 1.5}, Kind::other, true, {3, {1.5}}, Part{}}; }

TEST(Record, IsWrittenAsJsonInTheOrderOfItsFields) {
    EXPECT_EQ(record_json(example()).dump(),
              R"({"name":"first, \"up\"","energy_wh":1.23456,"final_soc_percent":50.5,)"
              R"("energy_wh_interval_95":{"low":1.0,"high":1.5},"kind":"other","complete":true,"samples":3,)"
              R"("power_w":[1.5],"extra":{"samples":0,"power_w":[]}})");
    EXPECT_EQ(record_json(Whole{}).dump(), R"({"name":"","energy_wh":0.0,"energy_wh_interval_95":null,"kind":"plain",)"
                                           R"("complete":false,"samples":0,"power_w":[]})");
}

/// A record that may have drawn flights, of which nothing need be known.
struct Drawn {
    int samples = 0;
    std::optional<double> probability;
};
struct Mission {
    std::optional<Drawn> drawn;
};
struct Outer {
    Mission mission;
};

Fields<Drawn> record_fields(const Drawn*) {
    return {field("samples", &Drawn::samples, "their number"), field("probability", &Drawn::probability, "or unknown")};
}
Fields<Mission> record_fields(const Mission*) { return list_fields<Mission>(embedded_if_any(&Mission::drawn)); }
Fields<Outer> record_fields(const Outer*) { return list_fields<Outer>(embedded(&Outer::mission)); }

TEST(Record, WritesNullForWhatIsUnknownOfARecordThatIsThere) {
    EXPECT_EQ(record_json(Mission{}).dump(), "{}");
    EXPECT_EQ(record_json(Mission{Drawn{20, std::nullopt}}).dump(), R"({"samples":20,"probability":null})");
    EXPECT_EQ(record_json(Outer{}).dump(), "{}");
    EXPECT_EQ(record_json(Outer{{Drawn{20, std::nullopt}}}).dump(), R"({"samples":20,"probability":null})");
}

TEST(Record, ReadsItsMembersBack) {
    Whole read;
    read_record(record_json(example()), read);
    EXPECT_EQ(read.name, "first, \"up\"");
    EXPECT_EQ(read.final_soc_percent, 50.5);
    EXPECT_EQ(read.part.samples, 3);
    EXPECT_THAT(read.part.power_w, testing::ElementsAre(1.5));
    auto json = record_json(example());
    json.erase("final_soc_percent");
    read = {};
    read_record(json, read);
    EXPECT_EQ(read.final_soc_percent, std::nullopt);
    for (const auto& wrong : {Json(1.5), Json("3"), Json(1e300), Json(std::numeric_limits<std::uint64_t>::max())}) {
        json["samples"] = wrong;
        EXPECT_THROW(read_record(json, read), std::exception) << wrong;
    }
    json.erase("samples");
    EXPECT_THROW(read_record(json, read), std::exception);
}

TEST(Record, HasASchema) {
    const auto schema = record_schema<Whole>();
    EXPECT_EQ(schema["required"].dump(),
              R"(["name","energy_wh","energy_wh_interval_95","kind","complete","samples","power_w"])");
    const auto& properties = schema["properties"];
    EXPECT_EQ(properties["energy_wh"].dump(),
              R"({"type":"number","description":"energy","unit":"Wh","csv":["energy_wh"]})");
    EXPECT_EQ(properties["final_soc_percent"]["type"].dump(), R"(["number","null"])");
    EXPECT_EQ(properties["energy_wh_interval_95"]["csv"].dump(),
              R"(["energy_wh_interval_95_low","energy_wh_interval_95_high"])");
    EXPECT_EQ(properties["kind"]["type"], "string");
    EXPECT_EQ(properties["power_w"]["items"]["type"], "number");
    EXPECT_EQ(properties["extra"]["properties"]["samples"]["type"], "integer");
    EXPECT_EQ(properties["doubled"]["csv_only"], true);
}

TEST(Record, IsARowOfATable) {
    const auto table = table_of(std::vector{Whole{}, example()});
    EXPECT_THAT(table.header, testing::ElementsAre("who", "energy_wh", "SoC", "low Wh", "high Wh", "complete"));
    EXPECT_THAT(table.rows[0], testing::ElementsAre("", "0.000", "-", "-", "-", "no"));
    EXPECT_THAT(table.rows[1], testing::ElementsAre("first, \"up\"", "1.235", "50.50", "1.000", "1.500", "yes"));
    EXPECT_THAT(table_of(std::vector{Whole{}}).header, testing::Not(testing::Contains("SoC")));
}

TEST(Record, IsARowOfCsv) {
    EXPECT_EQ(csv_of(std::vector{Whole{}, example()}, 4),
              "name,energy_wh,final_soc_percent,energy_wh_interval_95_low,energy_wh_interval_95_high,samples,doubled\n"
              ",0,,,,0,0\n\"first, \"\"up\"\"\",1.235,50.5,1,1.5,3,2.469\n");
}

}  // namespace flightwatt::record_test
