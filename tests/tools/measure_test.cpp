// SPDX-License-Identifier: BSD-3-Clause
// planemap-measure, as a user runs it: the simulated office against what its walls truly are.
#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <sstream>

#include "map/map_file.hpp"
#include "tools/programs.hpp"

namespace planemap {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

class MeasureTest : public test::Programs {
  protected:
    Json measured(const std::string& arguments) {
        const Outcome outcome = run("planemap-measure", arguments + " --json -");
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return outcome.exit_code == 0 ? Json::parse(outcome.out) : Json();
    }
};

/// The measure of a kind that is nearest to a truth.
Json nearest(const Json& measures, const std::string& kind, double truth) {
    Json best;
    for (const Json& measure : measures.at("measures")) {
        if (measure.at("kind") != kind) continue;
        const double off = std::abs(measure.at("distance_m").get<double>() - truth);
        if (best.is_null() || off < std::abs(best.at("distance_m").get<double>() - truth)) best = measure;
    }
    return best;
}

TEST_F(MeasureTest, TheOfficeIsAsLargeAsItIs) {
    ASSERT_EQ(run("planemap-run", "sim:office -q --no-octomap -o " + path("office")).exit_code, 0);
    const Json office = measured(path("office"));
    // The office: 6 x 5 x 2.7 m, its walls 0.12 m thick. No poses err in the way that sigmas leave out by
    // more than a centimetre and a half here.
    struct Truth {
        const char* kind;
        double metres;
    };
    for (const auto& [kind, truth] : {Truth{"wall to wall", 6}, Truth{"wall to wall", 5},
                                      Truth{"wall thickness", 0.12}, Truth{"floor to ceiling", 2.7}}) {
        const Json measure = nearest(office, kind, truth);
        ASSERT_FALSE(measure.is_null()) << kind << " " << truth;
        const double sigma = measure.at("distance_sigma_m").get<double>();
        EXPECT_NEAR(measure.at("distance_m").get<double>(), truth, 3 * std::hypot(sigma, 0.005)) << measure;
        EXPECT_LT(sigma, 0.05) << measure;
        EXPECT_NEAR(measure.at("angle_deg").get<double>(), 180, 2) << measure;
    }
    // planes.json says the same as the stored map, whose outlines are within 5 mm.
    const Json of_json = measured(path("office/planes.json"));
    ASSERT_EQ(of_json.at("measures").size(), office.at("measures").size());
    for (std::size_t i = 0; i < of_json.at("measures").size(); ++i) {
        const Json &a = office.at("measures")[i], &b = of_json.at("measures")[i];
        EXPECT_EQ(a.at("planes"), b.at("planes"));
        EXPECT_NEAR(a.at("distance_m").get<double>(), b.at("distance_m").get<double>(), 1e-3);
        EXPECT_NEAR(a.at("distance_sigma_m").get<double>(), b.at("distance_sigma_m").get<double>(), 1e-3);
    }
    for (std::size_t i = 0; i < of_json.at("planes").size(); ++i) {
        const double area = office.at("planes")[i].at("area_m2").get<double>();
        EXPECT_NEAR(of_json.at("planes")[i].at("area_m2").get<double>(), area, 0.005 * (1 + std::sqrt(area)));
    }
}

TEST_F(MeasureTest, PairsByIdAndEveryPair) {
    const std::string stored = PLANEMAP_SOURCE "/tests/stored/plane_map.lcmlog";
    const Json pair = measured(stored + " 0 1"), three = measured(stored + " 1 0 2"),
               all = measured(stored + " --all");
    ASSERT_EQ(pair.at("measures").size(), 1u);
    EXPECT_EQ(pair.at("measures")[0].at("planes"), Json::parse("[0, 1]"));
    EXPECT_TRUE(pair.at("measures")[0].contains("gap_m"));
    EXPECT_EQ(three.at("measures").size(), 3u);
    EXPECT_EQ(three.at("measures")[0].at("angle_deg"), pair.at("measures")[0].at("angle_deg"));
    EXPECT_EQ(all.at("measures").size(), 15u) << "of six planes";
    int without = 0;
    for (const Json& measure : all.at("measures")) {
        EXPECT_EQ(measure.at("distance_m").is_null(), measure.contains("why_no_distance")) << measure;
        without += measure.at("distance_m").is_null();
    }
    EXPECT_GT(without, 0);
    const Outcome text = run("planemap-measure", stored + " --all");
    EXPECT_EQ(text.exit_code, 0);
    EXPECT_THAT(text.out, HasSubstr("deg from parallel"));
    EXPECT_THAT(text.out, HasSubstr("sigmas are one standard deviation"));
}

TEST_F(MeasureTest, CsvHasTheSameNumbers) {
    const std::string stored = PLANEMAP_SOURCE "/tests/stored/planes.json";
    ASSERT_EQ(run("planemap-measure", stored + " --all --csv " + path("m.csv") + " --json " + path("m.json"))
                  .exit_code,
              0);
    const Json json = Json::parse(read_file(folder_ / "m.json"));
    std::istringstream lines(read_file(folder_ / "m.csv"));
    std::set<std::size_t> commas;
    std::size_t count = 0;
    std::string text;
    for (std::string line; std::getline(lines, line); ++count) {
        commas.insert(static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')));
        text += line + "\n";
    }
    EXPECT_EQ(commas.size(), 1u) << "as many cells in every row";
    EXPECT_EQ(count, 1 + json.at("planes").size() + json.at("measures").size());
    for (const Json& measure : json.at("measures"))
        EXPECT_THAT(text, HasSubstr("," + measure.at("angle_deg").dump() + ",")) << measure;
}

TEST_F(MeasureTest, BadInputIsOneLine) {
    const std::string stored = PLANEMAP_SOURCE "/tests/stored/plane_map.lcmlog";
    expect_error("planemap-measure", path("none.lcmlog"), "none.lcmlog");
    expect_error("planemap-measure", path("none.json"), "none.json");
    std::filesystem::create_directory(folder_ / "empty");
    expect_error("planemap-measure", path("empty"), "holds neither plane_map.lcmlog nor planes.json");
    write_file(folder_ / "planes.json", "{\"format\": \"planemap planes 1\", \"utime\": 0.5}");
    expect_error("planemap-measure", path("planes.json"), "utime is 0.5");
    write_file(folder_ / "zero.json", "");
    expect_error("planemap-measure", path("zero.json"), "zero.json");
    expect_error("planemap-measure", stored + " 0", "two ids");
    expect_error("planemap-measure", stored + " 0 0", "twice");
    expect_error("planemap-measure", stored + " 0 77", "no plane 77 in the map, which has 0, 1");
    expect_error("planemap-measure", stored + " 0 x", "\"x\" is no id");
    expect_error("planemap-measure", stored + " 0 99999999999", "is no id");
    expect_error("planemap-measure", stored + " --all 0 1", "--all");
    expect_error("planemap-measure", stored + " --json - --csv -", "standard output");
    expect_error("planemap-measure", stored + " --json " + path("no/such/folder.json"), "folder.json");
    expect_error("planemap-measure", stored + " >/dev/full", "standard output");
    map::write_plane_map(folder_ / "bare.lcmlog", {});
    const Outcome bare = run("planemap-measure", path("bare.lcmlog"));
    EXPECT_EQ(bare.exit_code, 0) << bare.err;
    EXPECT_THAT(bare.out, HasSubstr("nothing of its rooms can be measured"));
}

}  // namespace
}  // namespace planemap
