// Tracks as others read them: by the rules of RFC 7946, of GPX 1.1 and of KML 2.2, and by gpsbabel where it is.

#include "base/atomic_file.h"
#include "base/number.h"
#include "exchange/flown_track.h"
#include "flight/load_flight.h"
#include "helpers/running_program.h"
#include "helpers/sample_logs.h"

#include <array>
#include <iterator>
#include <map>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

namespace flightwatt::exchange {
namespace {

using Json = nlohmann::json;

const FlownTrack& sample_track() {
    static const auto track = [] {
        const auto loaded = flight::load_flight(test::sample(1));
        return flown_track(loaded.data, loaded.phases);
    }();
    return track;
}

/// Three places in the south-west, without date, altitude and power.
FlownTrack bare_track() {
    return {"bare <&>\x01", "", {{0.0, -70.5, -33.5}, {1.0, -70.6, -33.6}, {2.0, -70.7, -33.7}}};
}

/// The names of an element's children, in their order, each once in a row.
std::vector<std::string> children(const pugi::xml_node& node) {
    std::vector<std::string> names;
    for (const auto& child : node)
        if (names.empty() || names.back() != child.name()) names.emplace_back(child.name());
    return names;
}

pugi::xml_document parsed(const std::string& text) {
    pugi::xml_document document;
    const auto result = document.load_string(text.c_str());
    EXPECT_TRUE(result) << result.description();
    return document;
}

TEST(GeoJson, IsAFeatureCollectionOfLinesByRfc7946) {
    const auto& track = sample_track();
    const auto json = Json::parse(to_geojson(track));
    EXPECT_EQ(json.at("type"), "FeatureCollection");
    std::size_t segments = 0;
    for (const auto& feature : json.at("features")) {
        EXPECT_EQ(feature.at("type"), "Feature");
        EXPECT_EQ(feature.at("geometry").at("type"), "LineString");
        const auto& places = feature.at("geometry").at("coordinates");
        ASSERT_GE(places.size(), 2U);
        segments += places.size() - 1;
        const auto& properties = feature.at("properties");
        EXPECT_EQ(properties.at("times_s").size(), places.size());
        EXPECT_EQ(properties.at("coordTimes").size(), places.size());
        EXPECT_TRUE(std::regex_match(properties.at("stroke").get<std::string>(), std::regex("#[0-9a-f]{6}")));
        for (const auto& place : places) {
            ASSERT_EQ(place.size(), 3U);
            EXPECT_LE(std::abs(place[0].get<double>()), 180.0);
            EXPECT_LE(std::abs(place[1].get<double>()), 90.0);
        }
    }
    EXPECT_EQ(segments, track.points.size() - 1) << "every step of the track is drawn once";
}

TEST(GeoJson, HasLongitudeFirstAndWhatIsKnown) {
    const auto json = Json::parse(to_geojson(bare_track()));
    const auto& feature = json.at("features").at(0);
    EXPECT_EQ(feature.at("geometry").at("coordinates"), Json::parse("[[-70.5,-33.5],[-70.6,-33.6],[-70.7,-33.7]]"));
    EXPECT_FALSE(feature.at("properties").contains("coordTimes"));
    EXPECT_TRUE(feature.at("properties").at("mean_power_w").is_null());
}

TEST(Gpx, HasTheElementsOfItsSchemaInTheirOrder) {
    const auto& track = sample_track();
    const auto document = parsed(to_gpx(track));
    const auto gpx = document.child("gpx");
    EXPECT_STREQ(gpx.attribute("version").value(), "1.1");
    EXPECT_STREQ(gpx.attribute("xmlns").value(), "http://www.topografix.com/GPX/1/1");
    EXPECT_THAT(children(gpx), testing::ElementsAre("metadata", "trk"));
    EXPECT_THAT(children(gpx.child("metadata")), testing::ElementsAre("name", "desc", "time"));
    std::size_t steps = 0;
    for (const auto& line : gpx.children("trk")) {
        EXPECT_THAT(children(line), testing::ElementsAre("name", "extensions", "trkseg"));
        std::string before;
        for (const auto& point : line.child("trkseg")) {
            EXPECT_THAT(children(point), testing::ElementsAre("ele", "time"));
            const std::string time = point.child("time").text().get();
            EXPECT_LT(before, time);
            before = time;
            ++steps;
        }
        --steps;
    }
    EXPECT_EQ(steps, track.points.size() - 1);
}

TEST(Gpx, HasNoTimeWithoutAClockAndNoNameThatXmlCannotHold) {
    const auto document = parsed(to_gpx(bare_track()));
    EXPECT_STREQ(document.child("gpx").child("metadata").child("name").text().get(), "bare <&>?");
    const auto point = document.child("gpx").child("trk").child("trkseg").child("trkpt");
    EXPECT_STREQ(point.attribute("lat").value(), "-33.5000000");
    EXPECT_STREQ(point.attribute("lon").value(), "-70.5000000");
    EXPECT_FALSE(point.first_child());
}

TEST(Kml, HasAStyledTrackAPartWithATimeAPlace) {
    const auto& track = sample_track();
    const auto document = parsed(to_kml(track));
    const auto page = document.child("kml").child("Document");
    EXPECT_THAT(children(page), testing::ElementsAre("name", "description", "Placemark"));
    const std::map<std::string, std::string> colours{
        {"ground", "ff888888"}, {"takeoff", "ff0082d9"}, {"cruise", "ffb27200"}, {"landing", "ff739e00"}};
    for (const auto& placemark : page.children("Placemark")) {
        EXPECT_THAT(children(placemark), testing::ElementsAre("name", "description", "Style", "gx:Track"));
        EXPECT_EQ(placemark.child("Style").child("LineStyle").child("color").text().get(),
                  colours.at(placemark.child("name").text().get()));
        const auto line = placemark.child("gx:Track");
        EXPECT_THAT(children(line), testing::ElementsAre("altitudeMode", "when", "gx:coord"));
        const auto count = [&](const char* name) {
            const auto all = line.children(name);
            return std::distance(all.begin(), all.end());
        };
        EXPECT_EQ(count("when"), count("gx:coord"));
        EXPECT_GE(count("when"), 2);
    }
}

TEST(Kml, HasALineOnTheGroundWithoutClockAndAltitude) {
    const auto document = parsed(to_kml(bare_track()));
    const auto line = document.child("kml").child("Document").child("Placemark").child("LineString");
    EXPECT_STREQ(line.child("altitudeMode").text().get(), "clampToGround");
    EXPECT_STREQ(line.child("coordinates").text().get(),
                 "-70.5000000,-33.5000000 -70.6000000,-33.6000000 -70.7000000,-33.7000000");
}

/// A place and its time in seconds of the minute.
using PlaceInTime = std::array<double, 4>;

PlaceInTime place_in_time(double longitude, double latitude, double altitude_m, const std::string& utc) {
    return {longitude, latitude, altitude_m, number_or_nan(utc.substr(17, utc.size() - 18))};
}

/// Each once in a row: the parts of a track share their ends.
void add_once(std::vector<PlaceInTime>& places, const PlaceInTime& place) {
    if (places.empty() || places.back() != place) places.push_back(place);
}

/// What gpsbabel reads out of a file, as the GPX that it makes of it.
std::vector<PlaceInTime> read_by_gpsbabel(const std::string& format, const std::string& text) {
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / ("track." + format), text);
    const auto result = test::run_shell("gpsbabel -t -i " + format + " -f track." + format + " -o gpx -F -", folder);
    EXPECT_EQ(result.code, 0) << result.err;
    const auto document = parsed(result.out);
    std::vector<PlaceInTime> places;
    for (const auto& line : document.child("gpx").children("trk"))
        for (const auto& segment : line.children("trkseg"))
            for (const auto& point : segment.children("trkpt"))
                add_once(places,
                         place_in_time(point.attribute("lon").as_double(), point.attribute("lat").as_double(),
                                       point.child("ele").text().as_double(), point.child("time").text().get()));
    return places;
}

void expect_read_by_gpsbabel(const std::string& format, const std::string& text) {
    const auto& track = sample_track();
    const auto places = read_by_gpsbabel(format, text);
    ASSERT_EQ(places.size(), track.points.size()) << format;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto& point = track.points[i];
        const auto expected = place_in_time(point.longitude_deg, point.latitude_deg, point.altitude_m.value(),
                                            utc_text(track, point.time_s));
        EXPECT_NEAR(places[i][0], expected[0], 6e-8) << format << " " << i;
        EXPECT_NEAR(places[i][1], expected[1], 6e-8) << format << " " << i;
        EXPECT_NEAR(places[i][2], expected[2], 0.006) << format << " " << i;
        EXPECT_NEAR(places[i][3], expected[3], 1e-3) << format << " " << i;
    }
}

/// Of GeoJSON gpsbabel makes routes, and reads no altitudes.
void expect_lines_read_by_gpsbabel(const std::string& text) {
    const auto& track = sample_track();
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / "track.geojson", text);
    const auto result = test::run_shell("gpsbabel -r -i geojson -f track.geojson -o gpx -F -", folder);
    EXPECT_EQ(result.code, 0) << result.err;
    const auto document = parsed(result.out);
    std::size_t at = 0;
    for (const auto& route : document.child("gpx").children("rte")) {
        if (at > 0) --at;  // where the line before ended
        for (const auto& point : route.children("rtept")) {
            ASSERT_LT(at, track.points.size());
            EXPECT_NEAR(point.attribute("lon").as_double(), track.points[at].longitude_deg, 6e-8) << at;
            EXPECT_NEAR(point.attribute("lat").as_double(), track.points[at].latitude_deg, 6e-8) << at;
            ++at;
        }
    }
    EXPECT_EQ(at, track.points.size());
}

TEST(TrackFiles, AreReadByGpsbabel) {
    if (test::run_shell("command -v gpsbabel", test::scratch_dir()).code != 0)
        GTEST_SKIP() << "gpsbabel is not here (apt-get install gpsbabel)";
    expect_read_by_gpsbabel("gpx", to_gpx(sample_track()));
    expect_read_by_gpsbabel("kml", to_kml(sample_track()));
    expect_lines_read_by_gpsbabel(to_geojson(sample_track()));
}

}  // namespace
}  // namespace flightwatt::exchange
