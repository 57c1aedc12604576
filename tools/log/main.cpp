// SPDX-License-Identifier: BSD-3-Clause
// planemap-log: what is in LCM logs, whether they are whole, parts of them, and damaged ones made whole.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/standard_output.hpp"
#include "log/copy.hpp"
#include "log/damage.hpp"
#include "log/summary.hpp"
#include "messages/process.hpp"
#include "results/progress_line.hpp"

namespace planemap {
namespace {

constexpr const char* kDescription =
    "What is in LCM logs, whether they are whole, parts of them, and damaged ones made whole.\n"
    "  info FILE...                channels, types, rates, gaps, duration, sizes\n"
    "  check FILE...               damage by its place, and events, images and maps that cannot be decoded; "
    "exit code 1 if "
    "there is any\n"
    "  cut FILE --output NEW       the events --from S --to S after the first one, on --channels REGEX\n"
    "  repair FILE --output NEW    all events that are whole; what was left out is counted\n"
    "The source is never touched, and nothing that is there is written over.\n"
    "Example: planemap-log cut office.lcmlog --from 10 --to 20 --output part.lcmlog";

struct LogToolOptions {
    std::string command;
    std::vector<std::string> files;
    std::filesystem::path output;
    LogSelection selection;
    bool json = false, quiet = false;
};

/// Says how far the file is read; false when a signal asks to stop.
class Watch {
  public:
    Watch(const std::string& file, bool quiet) : file_(file), line_(quiet) {}
    bool operator()(double share) {
        if (line_.is_due()) {
            const double elapsed =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
            line_.show(file_ + ": " + std::to_string(static_cast<int>(100 * share)) + " %" +
                       time_left(share, elapsed));
        }
        return !messages::stop_requested();
    }

  private:
    std::string file_;
    ProgressLine line_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::function<bool(double)> watch(const std::string& file, const LogToolOptions& options) {
    return [shared = std::make_shared<Watch>(file, options.quiet)](double share) { return (*shared)(share); };
}

/// Each file by itself: a bad one is said, and the others are read all the same.
int for_each_file(const LogToolOptions& options, const std::function<bool(const std::string&)>& work) {
    int code = 0;
    for (const std::string& file : options.files) {
        try {
            if (!work(file)) code = 1;
        } catch (const std::runtime_error& error) {
            std::fprintf(stderr, "planemap-log: %s\n", error.what());
            code = 1;
        }
        if (messages::stop_requested()) return 1;
    }
    return code;
}

int info(const LogToolOptions& options) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    const int code = for_each_file(options, [&](const std::string& file) {
        const LogSummary summary = summarise(file, watch(file, options));
        if (options.json) {
            all.push_back(json_of(summary));
        } else {
            print(text_of(summary));
        }
        for (const std::string& complaint : summary.complaints) spdlog::warn("{}", complaint);
        return true;
    });
    if (options.json) print(all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    return code;
}

int check(const LogToolOptions& options) {
    return for_each_file(options, [&](const std::string& file) {
        const LogDamage damage = find_damage(file, watch(file, options));
        for (const std::string& line : damage.lines) print(line + "\n");
        print(file + ": " + std::to_string(damage.events) +
              (damage.lines.empty() ? " events, all whole\n" : " whole events, and damage\n"));
        return damage.lines.empty();
    });
}

/// cut and repair.
int copy(const LogToolOptions& options) {
    const std::string& input = options.files.front();
    const CopiedLog copied = copy_log(input, options.output, options.selection, watch(input, options));
    for (const std::string& complaint : copied.complaints) spdlog::warn("{}", complaint);
    std::string line = options.output.string() + ": " + std::to_string(copied.events) + " events";
    if (options.command == "cut") line += ", " + std::to_string(copied.left_out) + " not selected";
    if (copied.bytes_skipped > 0)
        line += ", " + std::to_string(copied.bytes_skipped) + " bytes left out that are no whole events";
    if (options.command == "repair" && copied.complaints.empty()) line += "; " + input + " was whole";
    print(line + "\n");
    return 0;
}

/// Throws std::invalid_argument for options that the command does not take.
void check_options(const LogToolOptions& options) {
    const bool copies = options.command == "cut" || options.command == "repair";
    const auto fail = [&](const std::string& what) {
        throw std::invalid_argument("planemap-log " + options.command + ": " + what + " (see --help)");
    };
    if (copies && options.files.size() != 1)
        fail("takes one FILE, not " + std::to_string(options.files.size()));
    if (copies && options.output.empty()) fail("--output is missing");
    if (!copies && !options.output.empty()) fail("takes no --output");
    if (options.command != "info" && options.json) fail("takes no --json");
    const LogSelection& s = options.selection;
    if (options.command != "cut" && (s.from_s != 0 || s.to_s || !s.channels.empty()))
        fail("takes no --from, --to or --channels");
}

int run(const LogToolOptions& options) {
    const std::vector<std::string> commands = {"info", "check", "cut", "repair"};
    if (std::find(commands.begin(), commands.end(), options.command) == commands.end())
        throw std::invalid_argument("\"" + options.command +
                                    "\" is no command: info, check, cut or repair (see --help)");
    check_options(options);
    messages::catch_stop_signals();
    if (options.command == "info") return info(options);
    return options.command == "check" ? check(options) : copy(options);
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    planemap::LogToolOptions options;
    planemap::messages::Flags flags("planemap-log", planemap::kDescription);
    flags.add_positional("COMMAND", options.command, "info, check, cut or repair, see above");
    flags.add_positionals("FILE", options.files, "LCM logs; cut and repair take one");
    flags.add("o,output", options.output, "cut, repair: the log to write, which must not be there yet");
    flags.add("from", options.selection.from_s, "cut: seconds after the first event");
    flags.add("to", options.selection.to_s, "cut: events before it; default: to the end");
    flags.add("channels", options.selection.channels,
              "cut: regular expression that matches a channel's whole name, as 'OPENNI_FRAME|PLANEMAP_.*'");
    flags.add("json", options.json, "info: as JSON");
    flags.add("q,quiet", options.quiet, "No progress lines");
    const int parsed = flags.parse(argc, argv);
    if (parsed >= 0) return parsed;
    planemap::messages::start_logging("planemap-log", false);
    return planemap::messages::run_main("planemap-log", [&] { return planemap::run(options); });
}
