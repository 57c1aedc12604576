// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "messages/flags.hpp"

namespace planemap::launcher {

/// The modules, each before those that hear it; they start in the opposite order.
inline constexpr const char* kModules[] = {"sensor", "segmentation", "odometry", "graph", "map", "octomap"};

/// What planemap-launch is told.
struct LaunchOptions {
    std::string input;  ///< empty: not given, sim:office
    /// For the sensor, as they were given; empty: not given.
    std::string rate, speed, channel, record, duration;
    bool repeat = false;           ///< the sensor's, too
    std::filesystem::path camera;  ///< camera.json, for the sensor or, without one, for who takes frames
    std::string channel_prefix;
    bool no_sensor = false, no_octomap = false, resume = false;
    std::filesystem::path log, output = "out/launch", state, bin;
    std::string lcm_url = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";
    std::map<std::string, std::string> flags;  ///< by module: more flags of its own

    void add_to(messages::Flags& all);

    /// Throws std::runtime_error naming what is wrong: a program that is missing, an input that cannot be
    /// opened, a wrong flag, a log that is there already, a folder that cannot be one. Starts and touches
    /// nothing.
    void check() const;

    /// Modules that are to run, in the order of kModules.
    std::vector<std::string> modules() const;
    std::filesystem::path state_folder() const { return state.empty() ? output / "state" : state; }
    /// How a module is started.
    std::vector<std::string> command(const std::string& module) const;
    std::vector<std::string> logger_command() const;

  private:
    std::filesystem::path program(const std::string& module) const { return bin / ("planemap-" + module); }
    std::vector<std::pair<std::string, std::string>> sensor_flags() const;
    std::vector<std::string> own_flags(const std::string& module) const;
    void check_programs() const;
    void check_modules() const;
    void check_files() const;
};

/// Runs a program to its end, its standard output thrown away; returns its exit code, 127 if there is none
/// such. With `last_said`, its standard error is not shown, and its last line is put there.
int run_to_end(const std::vector<std::string>& command, std::string* last_said = nullptr);

}  // namespace planemap::launcher
