// SPDX-License-Identifier: BSD-3-Clause
#include "messages/process.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/time.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "messages/interrupt.hpp"
#include "messages/session.hpp"

namespace planemap::messages {

namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int signal) {
    if (stop.exchange(true)) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
    // Half a second, again and again: a stop takes less than a second in all. A bare system call.
    constexpr itimerval kPatience = {{0, 500000}, {0, 500000}};
    ::setitimer(ITIMER_REAL, &kPatience, nullptr);
}

/// Half a second after the signal, and from then on, nothing waits for a server any more.
void on_alarm(int) {
    interrupt_waiting();
}

constexpr const char* kLogPattern = "%n: %^%l%$: %v";
constexpr std::int64_t kLinePeriodUs = 5000000;
constexpr std::int64_t kDrainUs = 500000;  // at a stop, for messages that wait
constexpr int kQuietMs = 20;               // without a message: none waits

void run_loop(Shell& shell, Bus& bus) {
    std::int64_t last_line = now_us();
    shell.status().announce(bus, last_line);
    while (!stop_requested() && !bus.ended()) {
        const int wait_ms = shell.poll();
        if (wait_ms < 0) break;
        bus.handle(std::min(wait_ms, 200));
        const std::int64_t now = now_us();
        shell.status().publish_if_due(bus, now);
        if (now - last_line >= kLinePeriodUs) {
            spdlog::info("{}", shell.status().line());
            last_line = now;
        }
    }
}

/// Whatever fails, what the module has is published or written before the failure ends the process.
void serve(Shell& shell, Bus& bus) {
    std::exception_ptr failure;
    try {
        run_loop(shell, bus);
    } catch (...) {
        failure = std::current_exception();
    }
    try {
        if (!bus.connected()) bus.handle(0);  // a last attempt, for what finish() sends
        // What was received before the signal, and what those who stopped before still sent, is handled.
        const std::int64_t until = now_us() + kDrainUs;
        while (bus.handle(kQuietMs) && now_us() < until) {
        }
        shell.finish();
    } catch (...) {
        if (!failure) failure = std::current_exception();
    }
    shell.status().publish_if_due(bus, now_us(), true);
    spdlog::info("{}", shell.status().line());
    bus.complaints().log_totals();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace

bool stop_requested() {
    return stop.load();
}

void catch_stop_signals() {
    struct sigaction action = {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    struct sigaction hang_up = {};  // a terminal that is closed; nohup ignores it
    sigaction(SIGHUP, nullptr, &hang_up);
    if (hang_up.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
    action.sa_handler = on_alarm;
    action.sa_flags = SA_RESTART;  // writing files goes on
    sigaction(SIGALRM, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit is a write that fails, not the end
}

void start_logging(const std::string& program, bool verbose) {
    auto logger = spdlog::get(program);
    if (!logger) logger = spdlog::stderr_color_mt(program);
    logger->set_pattern(kLogPattern);
    logger->set_level(verbose ? spdlog::level::debug : spdlog::level::info);
    spdlog::set_default_logger(logger);
}

void log_over_a_drawn_line(bool drawn) {
    spdlog::set_pattern(std::string(drawn ? "\r\033[K" : "") + kLogPattern);
}

int run_main(const std::string& program, const std::function<int()>& body) {
    try {
        return body();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", program.c_str(), error.what());
        return 1;
    }
}

int run_program(Flags& flags, int argc, const char* const* argv, const std::function<int()>& body) {
    const int parsed = flags.parse(argc, argv);
    return parsed >= 0 ? parsed : run_main(flags.program(), body);
}

void require_shared(const Bus& bus) {
    if (!bus.in_process()) return;
    throw std::invalid_argument("LCM URL '" + bus.url() +
                                "': a process hears nobody but itself there; give one of udpm, tcpq or file");
}

Process::Process(std::string module, const std::string& description)
    : module_(std::move(module)), program_("planemap-" + module_), flags_(program_, description) {
    flags_.add("l,lcm-url", lcm_url_,
               "LCM URL; default: LCM_DEFAULT_URL, else udpm on this machine only (ttl=0)");
    flags_.add("channel-prefix", channel_prefix_,
               "Begins the name of every channel, for two cameras or robots on one bus; all modules of a "
               "session are given the same");
    flags_.add(
        "state", state_,
        "Folder for what the module goes on with when it is started again; without one it starts anew");
    flags_.add("v,verbose", verbose_, "Log more");
}

int Process::run(int argc, char** argv, const std::function<std::unique_ptr<Shell>(Bus&)>& make_shell) {
    return run_program(flags_, argc, argv, [&] {
        start_logging(program_, verbose_);
        catch_stop_signals();
        Bus bus(lcm_url_, channel_prefix_);
        if (!state_.empty()) bus.go_on_as(session_with_state(state_, module_));
        const std::unique_ptr<Shell> shell = make_shell(bus);
        require_shared(bus);
        if (bus.connected())
            spdlog::info("on {}{}", bus.url(),
                         channel_prefix_.empty() ? "" : ", channels " + channel_prefix_ + "*");
        serve(*shell, bus);
        if (const std::string failure = shell->status().failure(); !failure.empty())
            throw std::runtime_error(failure);
        return 0;
    });
}

}  // namespace planemap::messages
