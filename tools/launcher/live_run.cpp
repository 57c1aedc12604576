// SPDX-License-Identifier: BSD-3-Clause
#include "launcher/live_run.hpp"

#include <signal.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace planemap::launcher {

namespace {

using namespace std::chrono_literals;

constexpr const char* kLogger = "logger";
constexpr Clock::duration kPoll = 50ms;
constexpr Clock::duration kUntilAllListen = 10s;
constexpr Clock::duration kWithoutCount = 2s;  // where it cannot be counted who listens
constexpr Clock::duration kPatience = 10s;     // with each process, at the end of the input
constexpr Clock::duration kQuick = 1400ms;     // for all of them, after a signal: then they are killed
constexpr Clock::duration kPipeline = 2s;  // in which the last frames become planes, at the end of the input
constexpr Clock::duration kPipelineQuick = 100ms;

/// Sockets of this network that receive on the URL's port. Every module has one as soon as it has subscribed.
std::size_t listeners(const std::string& url) {
    const std::size_t at = url.rfind(':');
    const long port = at == std::string::npos ? 0 : std::strtol(url.c_str() + at + 1, nullptr, 10);
    char wanted[24];
    std::snprintf(wanted, sizeof(wanted), ":%04lX", port > 0 ? port : 7667);
    std::ifstream table("/proc/net/udp");
    std::size_t count = 0;
    std::string number, local;
    for (std::string line; std::getline(table, line);) {
        std::istringstream fields(line);
        if (fields >> number >> local && local.ends_with(wanted)) ++count;
    }
    return count;
}

std::string seconds(Clock::duration time) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.1f s", std::chrono::duration<double>(time).count());
    return text;
}

}  // namespace

LiveRun::LiveRun(LaunchOptions options) : options_(std::move(options)) {}

int LiveRun::run() {
    make_folders();
    if (!options_.resume) forget_state();
    const bool started = start_all();
    bool over = !started;
    while (!over && supervisor_.stop_signals() == 0)
        if (const std::optional<Ending> ending = supervisor_.wait(Clock::now() + 1h)) over = is_over(*ending);
    stop_all(supervisor_.stop_signals() > 0);
    lock_.release();
    if (started) export_results();
    summarise();
    return exit_code_;
}

void LiveRun::make_folders() {
    if (!lock_.take(options_.output)) {
        throw std::runtime_error("another run is writing its results to " + options_.output.string() +
                                 ": wait for it, or give another --output");
    }
    std::filesystem::create_directories(options_.state_folder());
    if (options_.log.has_parent_path()) std::filesystem::create_directories(options_.log.parent_path());
}

/// What the modules of an earlier run left to go on with.
void LiveRun::forget_state() const {
    std::error_code ignored;
    for (const char* module : kModules)
        for (const char* kind : {".journal", ".session", ".position"})
            std::filesystem::remove(options_.state_folder() / (module + std::string(kind)), ignored);
}

void LiveRun::fail(const std::string& why) {
    spdlog::error("{}", why);
    exit_code_ = 1;
}

/// Those who listen first. False if one ended at once, or a signal came.
bool LiveRun::start_all() {
    const std::size_t others = listeners(options_.lcm_url);
    if (!options_.log.empty()) supervisor_.start(kLogger, options_.logger_command());
    std::vector<std::string> modules = options_.modules();
    std::reverse(modules.begin(), modules.end());
    for (const std::string& module : modules)
        if (module != "sensor") supervisor_.start(module, options_.command(module));
    if (!wait_for_listeners(others)) return false;
    if (!options_.no_sensor) supervisor_.start("sensor", options_.command("sensor"));
    return true;
}

/// The sensor must not start before all others listen.
bool LiveRun::wait_for_listeners(std::size_t others) {
    const bool can_count = options_.lcm_url.starts_with("udpm://");
    const Clock::time_point until = Clock::now() + (can_count ? kUntilAllListen : kWithoutCount);
    while (Clock::now() < until) {
        if (can_count && listeners(options_.lcm_url) >= others + supervisor_.running()) return true;
        const std::optional<Ending> ending = supervisor_.wait(std::min(until, Clock::now() + kPoll));
        if (supervisor_.stop_signals() > 0) return false;
        if (!ending) continue;
        if (ending->name == kLogger) {
            logger_ended();
        } else if (ending->by_signal) {
            restart(*ending);
        } else {
            fail(ending->name + " ended at once; stopping the others");
            return false;
        }
    }
    if (can_count)
        spdlog::warn("not all modules listen on {} after {}; going on", options_.lcm_url,
                     seconds(kUntilAllListen));
    return true;
}

/// Whether a process's end is the run's: that of the input is, and that of a sensor that says why it cannot
/// go on.
bool LiveRun::is_over(const Ending& ending) {
    if (ending.name == kLogger) {
        logger_ended();
        return false;
    }
    if (ending.name == "sensor" && !ending.by_signal) {
        if (ending.code != 0) fail("sensor " + ending.text() + "; stopping the others");
        return true;
    }
    restart(ending);
    return false;
}

void LiveRun::restart(const Ending& ending) {
    const Clock::duration delay = supervisor_.restart_later(ending);
    spdlog::warn("{} {} after {}; it is started again in {}", ending.name, ending.text(),
                 seconds(ending.lived), seconds(delay));
}

/// The recorder is no module: where it ends, by a full disk above all, only the recording does.
void LiveRun::logger_ended() {
    exit_code_ = 1;
    recording_ =
        "lcm-logger ended, is the disk of " + options_.log.string() + " full? The recording ends there";
    spdlog::error("{}; the modules go on", recording_);
}

/// Upstream first: what a module still sends, the next one still receives.
void LiveRun::stop_all(bool in_a_hurry) {
    supervisor_.end_restarts();
    const int signals = supervisor_.stop_signals();
    const Clock::time_point all_until = Clock::now() + kQuick;
    std::vector<std::string> order = options_.modules();
    order.push_back(kLogger);
    const bool had_input = !options_.no_sensor;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const auto share = (all_until - Clock::now()) / static_cast<int>(order.size() - i);
        stop(order[i],
             in_a_hurry ? std::max(Clock::now(), Clock::now() + 2 * share) : Clock::now() + kPatience);
        if (order[i] != "sensor" || !had_input) continue;
        const Clock::time_point drained = Clock::now() + (in_a_hurry ? kPipelineQuick : kPipeline);
        while (Clock::now() < drained && supervisor_.stop_signals() == signals) supervisor_.wait(drained);
        in_a_hurry = in_a_hurry || supervisor_.stop_signals() > signals;
    }
    while (supervisor_.running() > 0 && Clock::now() < all_until) supervisor_.wait(all_until);
    for (const std::string& name : supervisor_.kill_all())
        fail(name + " did not stop in time and was killed");
}

/// SIGTERM, and its end awaited until then.
void LiveRun::stop(const std::string& name, Clock::time_point until) {
    const int signals = supervisor_.stop_signals();
    supervisor_.signal(name, SIGTERM);
    while (supervisor_.runs(name) && Clock::now() < until && supervisor_.stop_signals() == signals) {
        const std::optional<Ending> ending = supervisor_.wait(until);
        if (!ending) continue;
        if (ending->name == kLogger && name != kLogger)
            logger_ended();
        else if (ending->code != 0 && ending->code != 128 + SIGTERM) {
            is_mapped_ = is_mapped_ && ending->name != "map";
            fail(ending->name + " " + ending->text());
        }
    }
}

void LiveRun::summarise() {
    std::string restarts;
    for (const auto& [name, count] : supervisor_.restarts())
        restarts += (restarts.empty() ? "" : ", ") + name + " " + std::to_string(count);
    if (!restarts.empty()) spdlog::warn("started again: {}", restarts);
    const double ran_s = std::chrono::duration<double>(Clock::now() - began_).count();
    std::string cores;
    for (const auto& [name, cpu_s] : supervisor_.cpu_s()) {
        char text[64];
        std::snprintf(text, sizeof(text), "%s%s %.2f", cores.empty() ? "" : ", ", name.c_str(),
                      cpu_s / ran_s);
        cores += text;
    }
    spdlog::info("cores used in {}: {}", seconds(Clock::now() - began_), cores);
    const std::filesystem::path map = options_.output / "plane_map.lcmlog";
    std::error_code error;
    const auto written = std::filesystem::last_write_time(map, error);
    if (is_mapped_ && !error && written >= started_) spdlog::info("the map is in {}", map.string());
    if (!recording_.empty()) spdlog::error("{}", recording_);
}

/// What planemap-run leaves beside the map, where the program for it is.
void LiveRun::export_results() {
    const std::filesystem::path program = options_.bin / "planemap-export",
                                map = options_.output / "plane_map.lcmlog";
    std::error_code error;
    const auto written = std::filesystem::last_write_time(map, error);
    if (!is_mapped_ || error || written < started_ || !std::filesystem::exists(program)) return;
    if (run_to_end({program.string(), map.string(), "--output=" + options_.output.string(), "--replace",
                    "--quiet"}) != 0)
        fail(program.string() + " failed: beside the map, no results were written");
}

}  // namespace planemap::launcher
