// SPDX-License-Identifier: BSD-3-Clause
#include "core/option_list.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace planemap {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Part {
    double fill = 0.5;
};

struct Options {
    double gap_m = 0.5, slack = 1;
    int threads = 2;
    std::uint64_t seed = 1;
    std::string method = "fast", file;
    bool exact = false;
    Part part;

    void validate() const { check_options("options", *this); }
};

OptionList options_of(Part& part) {
    OptionList list("Part");
    list.add("min_fill", part.fill, between(0, 1), "Share that is filled", Audience::kExpert);
    return list;
}

OptionList options_of(Options& options) {
    OptionList list("Test");
    list.add("gap_m", options.gap_m, {0, 10}, "Largest gap");
    list.add("slack", options.slack, greater_than(0, "m/s"), "More than needed");
    list.add("threads", options.threads, at_least(1), "At work");
    list.add("seed", options.seed, kAnyNumber, "Of random numbers");
    list.add("method", options.method, {"fast", "exact", "none"}, "Way to do it");
    list.add("file", options.file, std::vector<std::string>{}, "To read");
    list.add("exact", options.exact, "Not a guess");
    list.append("part.", options_of(options.part));
    return list;
}

std::string error_of(const Options& options) {
    try {
        options.validate();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(OptionRange, HoldsItsEndsUnlessTheyAreOpen) {
    for (const double inside : {0.0, 0.5, 1.0}) EXPECT_TRUE(kShare.contains(inside));
    for (const double outside : {-1e-9, 1 + 1e-9, kNan, kInfinity, -kInfinity})
        EXPECT_FALSE(kShare.contains(outside));
    EXPECT_FALSE(between(0, 1).contains(0));
    EXPECT_FALSE(between(0, 1).contains(1));
    EXPECT_TRUE(between(0, 1).contains(0.5));
    EXPECT_TRUE(at_least(3).contains(3));
    EXPECT_FALSE(greater_than(3).contains(3));
    EXPECT_FALSE(greater_than(3).contains(kInfinity));
    EXPECT_FALSE(kAnyNumber.contains(kNan));
}

TEST(OptionRange, SaysItselfInWords) {
    EXPECT_EQ((OptionRange{1e-6, 1e6}).text(), "1e-06 to 1000000");
    EXPECT_EQ(at_least(3).text(), "at least 3");
    EXPECT_EQ(greater_than(0.5).text(), "greater than 0.5");
    EXPECT_EQ(between(0, 90).text(), "greater than 0, less than 90");
    EXPECT_EQ((OptionRange{.low = 0, .high = 1, .low_open = true}).text(), "greater than 0, at most 1");
    EXPECT_EQ(kAnyNumber.text(), "");
}

TEST(OptionList, UnitsComeFromTheNameOrTheRange) {
    for (const auto& [name, unit] : {std::pair("gap_m", "m"),
                                     {"area_m2", "m^2"},
                                     {"noise.quadratic_per_m", "1/m"},
                                     {"bend_deg", "deg"},
                                     {"speed_m_s", "m/s"},
                                     {"grow_sigmas", "sigmas"},
                                     {"threads", ""}})
        EXPECT_EQ(unit_of(name), unit);
    Options options;
    const OptionList list = options_of(options);
    EXPECT_EQ(list.options()[0].range_and_unit(), "0 to 10 m");
    EXPECT_EQ(list.options()[1].range_and_unit(), "greater than 0 m/s");
    EXPECT_EQ(list.options()[3].range_and_unit(), "");
}

TEST(OptionList, DescribesEachFieldWithItsDefault) {
    Options options;
    const OptionList list = options_of(options);
    std::vector<std::string> flags, values;
    for (const Option& option : list.options()) {
        flags.push_back(option.flag());
        values.push_back(option.value());
    }
    EXPECT_EQ(flags, (std::vector<std::string>{"gap-m", "slack", "threads", "seed", "method", "file", "exact",
                                               "part-min-fill"}));
    EXPECT_EQ(values, (std::vector<std::string>{"0.5", "1", "2", "1", "fast", "", "false", "0.5"}));
    EXPECT_EQ(list.options()[4].allowed(), "fast, exact or none");
    EXPECT_EQ(list.options().back().audience, Audience::kExpert);
}

TEST(OptionList, OneErrorNamesEveryBadField) {
    Options options;
    EXPECT_EQ(error_of(options), "");
    options.file = "any";
    options.seed = std::numeric_limits<std::uint64_t>::max();
    EXPECT_EQ(error_of(options), "");
    options.gap_m = -1;
    options.slack = kInfinity;
    options.threads = 0;
    options.method = "magic";
    options.part.fill = kNan;
    EXPECT_EQ(error_of(options),
              "options: gap_m is -1, must be 0 to 10; slack is inf, must be finite and greater than 0; "
              "threads is 0, must be at least 1; method is magic, must be fast, exact or none; "
              "part.min_fill is nan, must be greater than 0, less than 1");
}

TEST(Option, IsSetFromText) {
    Options options;
    const OptionList list = options_of(options);
    const auto set = [&](const std::string& name, const std::string& text) {
        for (const Option& option : list.options())
            if (option.name == name) option.set(text);
    };
    set("gap_m", "2.5");
    set("threads", "3");
    set("method", "exact");
    set("exact", "1");
    EXPECT_EQ(options.gap_m, 2.5);
    EXPECT_EQ(options.threads, 3);
    EXPECT_EQ(options.method, "exact");
    EXPECT_TRUE(options.exact);
    EXPECT_THROW(set("gap_m", "2.5m"), std::invalid_argument);
    EXPECT_THROW(set("threads", "2.5"), std::invalid_argument);
    EXPECT_THROW(set("exact", "yes"), std::invalid_argument);
    EXPECT_EQ(options.threads, 3);
}

}  // namespace
}  // namespace planemap
