// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace planemap::launcher {

using Clock = std::chrono::steady_clock;

/// How a process ended.
struct Ending {
    std::string name;
    int code = 0;  ///< exit code; 128 + signal
    bool by_signal = false;
    Clock::duration lived{};
    std::string text() const;  ///< "was killed by signal 9 (Killed)", "ended with code 1"
};

/// Processes that are started, watched, and started again when they die. Each is in a session of its own, so
/// that a terminal's Ctrl-C reaches the supervisor alone, and is told to stop should the supervisor be
/// killed. Before the first start(), block_signals() must have been called. On one thread.
class Supervisor {
  public:
    /// Blocks the signals that wait() takes (SIGINT, SIGTERM, SIGHUP, SIGCHLD) for the whole process.
    static void block_signals();

    /// Starts a process under a name; one that runs under it already is an error.
    void start(const std::string& name, const std::vector<std::string>& command);
    /// Starts it again after its back-off: 0.5 s after its first end, doubled each time to at most 10 s, and
    /// from the beginning again after it lived for half a minute. Returns the delay.
    Clock::duration restart_later(const Ending& ending);

    /// Waits until a process ends, a stop signal comes (stopping() is true then), or the time has come;
    /// starts what is due meanwhile. Returns the process that ended.
    std::optional<Ending> wait(Clock::time_point until);
    /// A stop signal came; and how many.
    int stop_signals() const { return stop_signals_; }

    bool runs(const std::string& name) const { return children_.contains(name); }
    std::size_t running() const { return children_.size(); }
    /// CPU time of the processes that ended, seconds, by name.
    const std::map<std::string, double>& cpu_s() const { return cpu_s_; }
    /// Restarts so far, by name.
    const std::map<std::string, int>& restarts() const { return restarts_; }

    /// No restarts from here on.
    void end_restarts() { due_.clear(); }
    void signal(const std::string& name, int signal);
    /// Ends all that still run, at once; returns their names.
    std::vector<std::string> kill_all();

  private:
    struct Child {
        pid_t pid = 0;
        Clock::time_point since;
    };
    std::optional<Ending> reap();
    void start_due();

    std::map<std::string, Child> children_;
    std::map<std::string, std::vector<std::string>> commands_;
    std::map<std::string, Clock::duration> back_off_;
    std::map<std::string, Clock::time_point> due_;
    std::map<std::string, int> restarts_;
    std::map<std::string, double> cpu_s_;
    int stop_signals_ = 0;
};

}  // namespace planemap::launcher
