// SPDX-License-Identifier: BSD-3-Clause
// What every planemap process does alike: flags, a bus, status once a second, a clean stop.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "messages/bus.hpp"
#include "messages/flags.hpp"
#include "messages/module_status.hpp"

namespace planemap::messages {

/// A result of which a second passed without a new one is sent again, so that those who come late have it.
inline constexpr std::int64_t kRepeat_us = 1000000;

/// A module on the bus. Its constructor subscribes; its handlers run in Bus::handle().
class Shell {
  public:
    virtual ~Shell() = default;
    virtual ModuleStatus& status() = 0;
    /// Work that no message starts. Returns the milliseconds until it wants to be called again, or a negative
    /// number when the module is done (the sensor at the end of its input).
    virtual int poll() { return 100; }
    /// Called once before the end, a clean one or not: publish or write what is still held back. What it
    /// throws becomes the process's one line and exit code 1.
    virtual void finish() {}
};

/// True once SIGINT or SIGTERM came; a second signal ends the process at once.
bool stop_requested();
/// Installs the handlers behind stop_requested().
void catch_stop_signals();

/// Logging as all programs do it: to stderr, a line an entry, the program's name first.
void start_logging(const std::string& program, bool verbose);

/// While a line is being redrawn in place on the terminal, log lines overwrite it instead of following it.
void log_over_a_drawn_line(bool drawn);

/// Runs body, and turns an exception that reaches the top into one line on stderr and exit code 1.
int run_main(const std::string& program, const std::function<int()>& body);

/// A program with flags: parses them, and runs `body` unless they are wrong or ask for no more than text
/// (--help). Returns the exit code: that of `body`, 1 for an error, 2 for wrong flags.
int run_program(Flags& flags, int argc, const char* const* argv, const std::function<int()>& body);

/// Throws std::invalid_argument naming the URL if no other process can be on the bus (memq://): a module
/// there would wait for ever and not say why.
void require_shared(const Bus& bus);

/// One module as a process, planemap-<module>.
class Process {
  public:
    Process(std::string module, const std::string& description);

    /// For the module's own flags.
    Flags& flags() { return flags_; }
    /// Folder that the module keeps its state in (--state); empty: it keeps none.
    const std::filesystem::path& state() const { return state_; }
    /// The module's file in it; empty without.
    std::filesystem::path journal() const {
        return state_.empty() ? state_ : state_ / (module_ + ".journal");
    }
    /// Parses flags, opens the bus, makes the shell and runs it until it is done or a signal comes.
    /// Returns the exit code: 0 after a clean stop, 1 for an error (one line on stderr), 2 for wrong flags.
    int run(int argc, char** argv, const std::function<std::unique_ptr<Shell>(Bus&)>& make_shell);

  private:
    std::string module_, program_;
    Flags flags_;
    std::string lcm_url_, channel_prefix_;
    std::filesystem::path state_;
    bool verbose_ = false;
};

}  // namespace planemap::messages
