// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "launcher/launch_options.hpp"
#include "launcher/supervisor.hpp"
#include "results/folder_lock.hpp"

namespace planemap::launcher {

/// The modules as processes, from their start to their end.
class LiveRun {
  public:
    /// Precondition: options.check() passed, and Supervisor::block_signals() was called.
    explicit LiveRun(LaunchOptions options);

    /// Starts the modules, watches them until the input ends or a stop signal comes, and stops them. After a
    /// signal that takes less than two seconds. Returns the exit code. Throws std::runtime_error if another
    /// run has the output folder.
    int run();

  private:
    void make_folders();
    void forget_state() const;
    bool start_all();
    bool wait_for_listeners(std::size_t others);
    bool is_over(const Ending& ending);
    void restart(const Ending& ending);
    void logger_ended();
    void stop_all(bool in_a_hurry);
    void stop(const std::string& name, Clock::time_point until);
    void summarise();
    void export_results();
    void fail(const std::string& why);

    LaunchOptions options_;
    Supervisor supervisor_;
    FolderLock lock_{".partial.lock"};
    std::string recording_;  ///< why it ended before the run; empty if it did not
    int exit_code_ = 0;
    bool is_mapped_ = true;  ///< the map module did not fail
    Clock::time_point began_ = Clock::now();
    std::filesystem::file_time_type started_ = std::filesystem::file_time_type::clock::now();
};

}  // namespace planemap::launcher
