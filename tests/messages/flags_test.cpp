// SPDX-License-Identifier: BSD-3-Clause
#include "messages/flags.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.hpp"
#include "core/version.hpp"
#include "temporary_folder.hpp"

namespace planemap::messages {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Options of every type.
struct Options {
    std::string input, method = "cells";
    std::filesystem::path output;
    double merge_distance_m = 0.05;
    int max_points = 300;
    std::uint64_t seed = 1;
    std::optional<double> delta;
    std::optional<std::uint64_t> other_seed;
    std::string color = "jpeg";
    bool quiet = false;

    bool operator==(const Options&) const = default;
};

OptionList options_of(Options& options) {
    OptionList list("Map");
    list.add("method", options.method, {"cells", "ransac"}, "which");
    list.add("merge_distance_m", options.merge_distance_m, {0, 10}, "largest distance");
    list.add("max_points", options.max_points, kAnyNumber, "at most", Audience::kExpert);
    list.add("seed", options.seed, kAnyNumber, "of the random numbers", Audience::kExpert);
    list.add("color", options.color, {"jpeg", "raw"}, "how");
    return list;
}

void add_flags(Flags& flags, Options& options) {
    flags.add_positional("input", options.input, "what to read");
    flags.add("o,output", options.output, "folder\nfor the results");
    flags.required();
    flags.add("q,quiet", options.quiet, "say nothing");
    flags.add("map-delta", options.delta, "one more");
    flags.add("map-other-seed", options.other_seed, "another");
    flags.add(options_of(options), "map-");
}

struct Outcome {
    int code;
    std::string out, err;
    Options options;
};

Outcome parse(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "program");
    std::vector<const char*> argv;
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    Outcome outcome;
    Flags flags("planemap-test", "A test.");
    add_flags(flags, outcome.options);
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    outcome.code = flags.parse(static_cast<int>(argv.size()), argv.data());
    outcome.out = testing::internal::GetCapturedStdout();
    outcome.err = testing::internal::GetCapturedStderr();
    return outcome;
}

void expect_error(const std::vector<std::string>& arguments, const testing::Matcher<std::string>& message) {
    const Outcome outcome = parse(arguments);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, message);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

TEST(Flags, UnknownOnesAreNamedWithTheNearest) {
    expect_error({"in", "--outptu", "x"}, AllOf(HasSubstr("unknown flag --outptu"), HasSubstr("--output?"),
                                                Not(HasSubstr("required"))));
    expect_error({"--outptu", "x", "in"}, HasSubstr("--outptu, did you mean --output?"));
    expect_error({"--outptu=x", "in"}, HasSubstr("--outptu, did you mean --output?"));
    expect_error({"in", "-o", "x", "--map-merge-distnace-m", "1"}, HasSubstr("--map-merge-distance-m?"));
    expect_error({"in", "-o", "x", "--merge-distance-m", "1"}, HasSubstr("--map-merge-distance-m?"));
    expect_error({"in", "-o", "x", "--xyzzy"}, AllOf(HasSubstr("--xyzzy"), Not(HasSubstr("did you mean"))));
    expect_error({"in", "-o", "x", "-z"}, HasSubstr("unknown flag -z"));
    expect_error({"in", "-output", "x"}, HasSubstr("-output, did you mean --output?"));
    expect_error({"in", "-o", "x", "more"}, HasSubstr("unexpected argument \"more\""));
    expect_error({"in"}, HasSubstr("--output is required"));
    expect_error({"-o", "x"}, HasSubstr("input is required"));
    expect_error({"in", "-o", "x", "--map-max-points", "many"}, HasSubstr("--map-max-points"));
}

TEST(Flags, Version) {
    const Outcome outcome = parse({"--version"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out, std::string("planemap-test ") + version() + "\n");
    EXPECT_THAT(version(), testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

TEST(Flags, HelpShowsUsersTheirOptionsAndHelpAllAllOfThem) {
    const Outcome help = parse({"--help"}), all = parse({"--help-all", "in"});
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(all.code, 0) << all.err;
    for (const std::string& text : {help.out, all.out}) {
        EXPECT_THAT(text, HasSubstr("--map-merge-distance-m"));
        EXPECT_THAT(text, HasSubstr("=0.05"));
        EXPECT_THAT(text, HasSubstr("largest distance [0 to 10 m]"));
        EXPECT_THAT(text, HasSubstr("\nMap:\n"));
    }
    for (const char* seldom : {"--map-max-points", "--map-seed"}) {
        EXPECT_THAT(help.out, Not(HasSubstr(seldom)));
        EXPECT_THAT(all.out, HasSubstr(seldom));
    }
    EXPECT_THAT(help.out, HasSubstr("--help-all lists more options"));
    expect_error({"in", "-o", "x", "--map-max-pionts", "1"}, HasSubstr("--map-max-points?"));
    expect_error({"in", "-o", "x", "--map-method", "magic"}, HasSubstr("magic"));
}

TEST(Flags, DumpedConfigReadsBack) {
    const test::TemporaryFolder folder;
    const Outcome given =
        parse({"sim:office?frames=60&seed=7", "--output", "a \"folder\" # with, [all] \\ 'kinds'",
               "--map-merge-distance-m", "0.1", "--map-max-points", "-7", "--map-seed",
               "18446744073709551615", "--map-delta", "1e-9", "--map-color", "raw", "-q"});
    EXPECT_EQ(given.code, -1) << given.err;
    const Outcome dumped =
        parse({"sim:office?frames=60&seed=7", "--output", "a \"folder\" # with, [all] \\ 'kinds'",
               "--map-merge-distance-m", "0.1", "--map-max-points", "-7", "--map-seed",
               "18446744073709551615", "--map-delta", "1e-9", "--map-color", "raw", "-q", "--dump-config"});
    EXPECT_EQ(dumped.code, 0);
    write_file(folder / "all.ini", dumped.out);
    const Outcome back = parse({"--config", folder / "all.ini"});
    EXPECT_EQ(back.code, -1) << back.err << dumped.out;
    EXPECT_EQ(back.options, given.options) << dumped.out;
    EXPECT_EQ(parse({"--config", folder / "all.ini", "--dump-config"}).out, dumped.out);
    EXPECT_EQ(parse({"--config", folder / "all.ini", "--map-max-points", "9"}).options.max_points, 9)
        << "the command line goes first";
}

TEST(Flags, DumpsAllOptionsWithoutTheRequiredOnes) {
    const Outcome dumped = parse({"--dump-config"});
    EXPECT_EQ(dumped.code, 0) << dumped.err;
    for (const char* line : {"\n# input = ", "\n# output = ", "\nquiet = false", "\nmap-method = \"cells\"",
                             "\nmap-merge-distance-m = 0.05", "\n# map-delta = ", "\n# Map\n"})
        EXPECT_THAT(dumped.out, HasSubstr(line));
    expect_error({"--dump-config", "--outptu"}, HasSubstr("--output?"));
}

TEST(Flags, ConfigFilesAreReadLineByLine) {
    const test::TemporaryFolder folder;
    const auto with = [&](const std::string& text) {
        write_file(folder / "c.ini", text);
        return parse({"in", "-o", "x", "--config", folder / "c.ini"});
    };
    const Outcome good = with(
        "\xef\xbb\xbf# a remark\r\n\r\n; another\r\nquiet\r\nmap-method = ransac  # the paper's\r\n"
        "map-color='raw'\r\nmap-max-points=12\r\n");
    EXPECT_EQ(good.code, -1) << good.err;
    EXPECT_TRUE(good.options.quiet);
    EXPECT_EQ(good.options.method, "ransac");
    EXPECT_EQ(good.options.color, "raw");
    EXPECT_EQ(good.options.max_points, 12);
    for (const auto& [text, reason] :
         {std::pair("\nmap-sede = 1\n", "c.ini:2: unknown option map-sede, did you mean map-seed?"),
          {"map-seed = 1\nmap-seed = 2\n", "c.ini:2: map-seed is given twice"},
          {"map-method = \"cells\n", "c.ini:1: the value of map-method has no end"},
          {"\nmap-seed = one\n", "c.ini:2: map-seed: \"one\" is no whole number from 0 to"},
          {"map-max-points = 1e9\n", "c.ini:1: map-max-points: \"1e9\" is no whole number"},
          {"map-delta = nan\n", "c.ini:1: map-delta: \"nan\" is no finite number"},
          {"map-color = blue\n", "c.ini:1: map-color: "},
          {"quiet = maybe\n", "c.ini:1: quiet: \"maybe\" is neither true nor false"},
          {"map-method =\n", "c.ini:1: map-method: must not be empty"},
          {"[map]\nseed = 1\n", "c.ini:1: unknown option [map]"}}) {
        const Outcome bad = with(text);
        EXPECT_EQ(bad.code, 2) << text;
        EXPECT_THAT(bad.err, HasSubstr(reason));
    }
    expect_error({"in", "-o", "x", "--config", folder / "missing.ini"}, HasSubstr("missing.ini"));
}

TEST(Flags, NumbersAreDecimalAndWithinTheirRange) {
    const std::vector<std::string> good{"in", "-o", "x"};
    const auto with = [&](const std::string& flag, const std::string& value) {
        std::vector<std::string> arguments = good;
        arguments.insert(arguments.end(), {flag, value});
        return arguments;
    };
    for (const char* seed : {"-1", "18446744073709551616", "1.5", "0x10", "1e3", "", " 1", "one"}) {
        expect_error(with("--map-seed", seed),
                     AllOf(HasSubstr("--map-seed"), HasSubstr("whole number from 0")));
        expect_error(with("--map-other-seed", seed), HasSubstr("--map-other-seed"));
    }
    for (const char* points : {"2147483648", "-2147483649", "3.0", "nan"})
        expect_error(with("--map-max-points", points), HasSubstr("-2147483648 to 2147483647"));
    for (const char* metres : {"nan", "inf", "-inf", "1e999", "0x1p3", "1,5"})
        expect_error(with("--map-merge-distance-m", metres), HasSubstr("no finite number"));
    EXPECT_EQ(parse(with("--map-seed", "010")).options.seed, 10u);
    EXPECT_EQ(parse(with("--map-max-points", "+7")).options.max_points, 7);
    EXPECT_EQ(parse(with("--map-merge-distance-m", "-.5e-1")).options.merge_distance_m, -0.05);
}

TEST(Flags, EmptyTextIsNoValue) {
    expect_error({"in", "-o", ""}, AllOf(HasSubstr("--output"), HasSubstr("must not be empty")));
    expect_error({"in", "--output="}, HasSubstr("--output"));
    expect_error({"", "-o", "x"}, HasSubstr("input: must not be empty"));
    expect_error({"in", "-o", "x", "--map-method", ""}, HasSubstr("--map-method: must not be empty"));
    expect_error({"in", "-o", "x", "--map-color", ""}, HasSubstr("--map-color"));
}

TEST(Flags, ValuesAreTyped) {
    Options options;
    options.output = "x";
    Flags flags("planemap-test", "A test.");
    add_flags(flags, options);
    std::map<std::string, FlagValue> values;
    for (const FlagValue& value : flags.values()) values[value.name] = value;
    EXPECT_EQ(values.size(), 10u);
    EXPECT_EQ(std::get<std::string>(values.at("output").value), "x");
    EXPECT_EQ(std::get<double>(values.at("map-merge-distance-m").value), 0.05);
    EXPECT_EQ(std::get<std::int64_t>(values.at("map-max-points").value), 300);
    EXPECT_EQ(std::get<std::uint64_t>(values.at("map-seed").value), 1u);
    EXPECT_EQ(std::get<bool>(values.at("quiet").value), false);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(values.at("map-delta").value));
    EXPECT_TRUE(std::holds_alternative<std::monostate>(values.at("input").value));
}

}  // namespace
}  // namespace planemap::messages
