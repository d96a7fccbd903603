// Tracks held to schemas that were written from the formats' own descriptions (schemas/): the published ones are in no
// Debian package. What is damaged must be refused by them, else they would hold nothing.

#include "base/atomic_file.h"
#include "exchange/flown_track.h"
#include "flight/load_flight.h"
#include "helpers/running_program.h"
#include "helpers/sample_logs.h"

#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::exchange {
namespace {

struct Replacement {
    std::string found;
    std::string put;
};

/// Prints what xmllint states of each file.
constexpr auto validate_json = R"(python3 -c '
import json, sys, jsonschema
validator = jsonschema.Draft7Validator(json.load(open(sys.argv[1])))
for name in sys.argv[2:]:
    for error in validator.iter_errors(json.load(open(name))):
        print(name, error.json_path, error.message[:200], file=sys.stderr)
        break
    else:
        print(name, "validates", file=sys.stderr)
' )";

/// What xmllint prints of files with these texts; of a valid one "track_INDEX validates".
std::string validated(const std::vector<std::string>& texts, const std::string& schema) {
    const auto folder = test::scratch_dir();
    std::string files;
    for (std::size_t i = 0; i < texts.size(); ++i) {
        write_file_atomically(folder / fmt::format("track_{}", i), texts[i]);
        files += fmt::format(" track_{}", i);
    }
    const auto schema_file = test::shell_quoted(test::source_dir() / "tests/exchange/schemas" / schema);
    const std::string program = schema.ends_with(".xsd") ? "xmllint --noout --nonet --schema " : validate_json;
    return test::run_shell(program + schema_file + files, folder).err;
}

bool is_here(const std::string& command) { return test::run_shell(command, test::scratch_dir()).code == 0; }

/// A flight with all that a track can have, and three places without date, altitude and power.
std::vector<FlownTrack> tracks() {
    const auto loaded = flight::load_flight(test::sample(1));
    return {flown_track(loaded.data, loaded.phases),
            {"bare <&>\x01", "", {{0.0, -70.5, -33.5}, {1.0, -70.6, -33.6}, {2.0, -70.7, -33.7}}}};
}

void expect_valid(std::string (*write)(const FlownTrack&), const std::string& schema) {
    std::vector<std::string> texts;
    for (const auto& track : tracks()) texts.push_back(write(track));
    EXPECT_EQ(validated(texts, schema), "track_0 validates\ntrack_1 validates\n");
}

/// Damages that leave it XML or JSON: it is the schema that refuses them.
void expect_refused(const std::string& text, const std::string& schema, const std::vector<Replacement>& damages) {
    std::vector<std::string> texts;
    for (const auto& [found, put] : damages) {
        const auto at = text.find(found);
        ASSERT_NE(at, std::string::npos) << found;
        texts.push_back(std::string(text).replace(at, found.size(), put));
    }
    const auto printed = validated(texts, schema);
    for (std::size_t i = 0; i < damages.size(); ++i) {
        EXPECT_THAT(printed, testing::HasSubstr(fmt::format("track_{}", i)));
        EXPECT_THAT(printed, testing::Not(testing::HasSubstr(fmt::format("track_{} validates", i))))
            << damages[i].found << " became " << damages[i].put;
    }
    EXPECT_THAT(printed, testing::Not(testing::HasSubstr("parser error")));
}

TEST(TrackSchemas, HoldGeoJsonByRfc7946) {
    if (!is_here("python3 -c 'import jsonschema'"))
        GTEST_SKIP() << "jsonschema is not here (apt-get install python3-jsonschema)";
    expect_valid(to_geojson, "geojson.schema.json");
    expect_refused(to_geojson(tracks()[1]), "geojson.schema.json",
                   {{"FeatureCollection", "Features"},
                    {"LineString", "Line"},
                    {"[-70.5,-33.5]", "[-33.5,-170.5]"},
                    {"[-70.5,-33.5]", "[-70.5]"},
                    {"[-70.5,-33.5]", "[-70.5,\"-33.5\"]"},
                    {"[-70.5,-33.5]", "[-70.5,-33.5,1,2]"},
                    {"[-70.5,-33.5],[-70.6,-33.6],", ""},
                    {"\"properties\"", "\"facts\""},
                    {"\"geometry\"", "\"coordinates\":[],\"geometry\""},
                    {"\"features\"", "\"crs\":{},\"features\""}});
}

TEST(TrackSchemas, HoldKml) {
    if (!is_here("command -v xmllint")) GTEST_SKIP() << "xmllint is not here (apt-get install libxml2-utils)";
    expect_valid(to_kml, "kml.xsd");
    const auto track = tracks()[0];
    expect_refused(to_kml(track), "kml.xsd",
                   {{"<color>ff", "<color>"},
                    {"<color>ff", "<color>#f"},
                    {"<width>3", "<width>3px"},
                    {"absolute", "above sea level"},
                    {"<when>" + utc_text(track, track.points[0].time_s), "<when>10:26:44"},
                    {"<gx:coord>", "<gx:coord>,"},
                    {"<Placemark>", "<Placemark><Style/>"},
                    {"<Document>", "<Document><colour>red</colour>"}});
    expect_refused(to_kml(tracks()[1]), "kml.xsd",
                   {{"-70.5000000,-33.5000000 ", "-70.5000000, -33.5000000 "},
                    {"-70.5000000,-33.5000000 -70.6000000,-33.6000000 ", ""}});
}

TEST(TrackSchemas, HoldGpx) {
    if (!is_here("command -v xmllint")) GTEST_SKIP() << "xmllint is not here (apt-get install libxml2-utils)";
    expect_valid(to_gpx, "gpx.xsd");
    const auto text = to_gpx(tracks()[0]);
    expect_refused(text, "gpx.xsd",
                   {{"version=\"1.1\"", "version=\"1.0\""},
                    {" creator=", " maker="},
                    {"<trkpt lat=\"", "<trkpt lat=\"1"},
                    {"<ele>", "<ele>about "},
                    {"<ele>", "<time>2020-07-05T10:26:45Z</time><ele>"},
                    {"Z</time>", " UTC</time>"},
                    {"<color>", "<color>#"},
                    {"<trkseg>", "<trkseg><color>ff0000</color>"},
                    {"<extensions>", "<extensions><colour>ff0000</colour>"}});
}

}  // namespace
}  // namespace flightwatt::exchange
