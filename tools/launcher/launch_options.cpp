// SPDX-License-Identifier: BSD-3-Clause
#include "launcher/launch_options.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "sensor/source.hpp"

namespace planemap::launcher {

namespace {

std::vector<std::string> words(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> found;
    for (std::string word; stream >> word;) found.push_back(word);
    return found;
}

bool is_on_path(const std::string& program) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (::access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
    return false;
}

/// The nearest folder above (or at) a path that is there; what a run would have to be able to write to.
std::filesystem::path existing_part(std::filesystem::path path) {
    path = std::filesystem::absolute(path);
    std::error_code ignored;
    while (!std::filesystem::exists(path, ignored) && path.has_relative_path()) path = path.parent_path();
    return path;
}

void check_folder(const std::filesystem::path& folder) {
    const std::filesystem::path there = existing_part(folder);
    if (!std::filesystem::is_directory(there)) {
        throw std::runtime_error("the folder " + folder.string() + " cannot be made: " + there.string() +
                                 " is a file");
    }
    if (::access(there.c_str(), W_OK) != 0)
        throw std::runtime_error("the folder " + there.string() + " cannot be written to");
}

/// Of what comes from there to its end; empty lines are none.
std::string last_line(int file) {
    std::string last, line;
    char bytes[4096];
    for (ssize_t n = 0; (n = ::read(file, bytes, sizeof(bytes))) > 0 || (n < 0 && errno == EINTR);) {
        for (ssize_t i = 0; i < n; ++i) {
            if (bytes[i] != '\n')
                line += bytes[i];
            else if (!line.empty())
                last = std::exchange(line, {});
        }
    }
    return line.empty() ? last : line;
}

/// Runs a program that only checks what it is given. Throws std::runtime_error that says what it said, if it
/// does not like it.
void check_by(const std::vector<std::string>& command) {
    std::string said;
    const int code = run_to_end(command, &said);
    if (code == 0) return;
    if (said.empty()) said = command.front() + " ended with code " + std::to_string(code);
    throw std::runtime_error("nothing was started: " + said);
}

}  // namespace

int run_to_end(const std::vector<std::string>& command, std::string* last_said) {
    std::vector<char*> arguments;
    arguments.reserve(command.size() + 1);
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    int pipe[2] = {-1, -1};
    if (last_said != nullptr && ::pipe2(pipe, O_CLOEXEC) != 0) return 127;
    if (last_said != nullptr) posix_spawn_file_actions_adddup2(&files, pipe[1], STDERR_FILENO);
    pid_t pid = 0;
    posix_spawnattr_t attributes;  // signals that are blocked here are not there
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    const int failed = ::posix_spawnp(&pid, arguments[0], &files, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (last_said != nullptr) {
        ::close(pipe[1]);
        *last_said = last_line(pipe[0]);
        ::close(pipe[0]);
    }
    int status = 0;
    if (failed != 0 || ::waitpid(pid, &status, 0) != pid) return 127;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void LaunchOptions::add_to(messages::Flags& all) {
    all.add_positional("input", input,
                       std::string("What planemap-sensor takes (default: sim:office): ") + sensor::kInputs,
                       false);
    all.add("rate", rate, sensor::kRateHelp);
    all.add("speed", speed, sensor::kSpeedHelp);
    all.add("channel", channel, sensor::kChannelHelp);
    all.add("camera", camera,
            "camera.json for a log that does not describe its camera, or instead of what INPUT says; with "
            "--no-sensor for "
            "frames on the bus that nobody describes");
    all.add("record", record, ".oni file to record a live OpenNI2 camera to");
    all.add("repeat", repeat, "Begin an .oni file again at its end");
    all.add("duration", duration, sensor::kDurationHelp);
    all.add("no-sensor", no_sensor, "Only the modules, e.g. to replay a log into them with lcm-logplayer");
    all.add("no-octomap", no_octomap, "Without the OctoMap, which is there for comparison");
    all.add("log", log,
            "Record all messages with lcm-logger; a file that is there is never written over. When its disk "
            "is full the "
            "recording ends, which is said, and the modules go on");
    all.add(
        "o,output", output,
        "Where the map goes as plane_map.lcmlog, and the other results at the end; an earlier map is kept as "
        "plane_map.earlier-DATE-N.lcmlog once there are planes to write, the newest five");
    all.add("resume", resume,
            "Go on with the state of the last run, in its world frame; without it a run starts anew");
    all.add("state", state,
            "Folder for what the modules go on with after a restart or a power cut (default: state in the "
            "output folder)");
    all.add("l,lcm-url", lcm_url, "The bus");
    all.add("channel-prefix", channel_prefix,
            "Begins the name of every channel, for two cameras or robots on one bus; --log records those "
            "channels");
    all.add("bin", bin, "The folder of the modules' programs (default: where this program is)");
    for (const char* module : kModules)
        all.add(std::string(module) + "-flags", flags[module],
                std::string("More flags for planemap-") + module + ", e.g. \"--verbose\"");
}

std::vector<std::string> LaunchOptions::modules() const {
    std::vector<std::string> names;
    for (const std::string name : kModules)
        if (!(name == "sensor" && no_sensor) && !(name == "octomap" && no_octomap)) names.push_back(name);
    return names;
}

/// Of those that only the sensor has: names and values of what was given; a flag has no value.
std::vector<std::pair<std::string, std::string>> LaunchOptions::sensor_flags() const {
    std::vector<std::pair<std::string, std::string>> given;
    for (const auto& [name, value] :
         {std::pair("rate", &rate), std::pair("speed", &speed), std::pair("channel", &channel),
          std::pair("record", &record), std::pair("duration", &duration)})
        if (!value->empty()) given.emplace_back(name, *value);
    if (repeat) given.emplace_back("repeat", "");
    return given;
}

/// What tells a module what to do, without where its state and results are.
std::vector<std::string> LaunchOptions::own_flags(const std::string& module) const {
    std::vector<std::string> all;
    if (module == "sensor") {
        all.push_back(input.empty() ? "sim:office" : input);
        for (const auto& [name, value] : sensor_flags())
            all.push_back("--" + name + (value.empty() ? "" : "=" + value));
    }
    const bool takes_frames = module == "segmentation" || module == "odometry" || module == "octomap";
    if (!camera.empty() && (no_sensor ? takes_frames : module == "sensor"))
        all.push_back("--camera=" + camera.string());
    all.push_back("--lcm-url=" + lcm_url);
    if (!channel_prefix.empty()) all.push_back("--channel-prefix=" + channel_prefix);
    const auto more = flags.find(module);
    if (more != flags.end())
        for (std::string& word : words(more->second)) all.push_back(std::move(word));
    return all;
}

std::vector<std::string> LaunchOptions::command(const std::string& module) const {
    std::vector<std::string> all = {program(module).string()};
    for (std::string& flag : own_flags(module)) all.push_back(std::move(flag));
    all.push_back("--state=" + state_folder().string());
    if (module == "map") all.emplace_back("--needs-planes");
    if (module == "graph" || module == "map" || module == "octomap")
        all.push_back("--output=" + output.string());
    return all;
}

std::vector<std::string> LaunchOptions::logger_command() const {
    std::vector<std::string> all{"lcm-logger", "--quiet", "--lcm-url=" + lcm_url};
    if (!channel_prefix.empty()) all.push_back("--channel=" + channel_prefix + ".*");
    all.push_back(log.string());
    return all;
}

void LaunchOptions::check() const {
    check_programs();
    if (no_sensor && !input.empty())
        throw std::runtime_error("--no-sensor takes no INPUT, and " + input + " was given");
    for (const auto& [name, value] : sensor_flags())
        if (no_sensor)
            throw std::runtime_error("--" + name + " is for the sensor, and --no-sensor was given");
    check_modules();
    check_files();
}

void LaunchOptions::check_programs() const {
    for (const char* name : kModules)
        if (::access(program(name).c_str(), X_OK) != 0)
            throw std::runtime_error(program(name).string() +
                                     " is missing: build it, install the package planemap, or give --bin");
    if (!log.empty() && !is_on_path("lcm-logger"))
        throw std::runtime_error("lcm-logger is missing: install the package liblcm-bin");
}

/// Each module says itself what is wrong with its flags.
void LaunchOptions::check_modules() const {
    std::vector<std::string> sensor = {program("sensor").string(), "--check"};
    for (std::string& flag : own_flags("sensor")) sensor.push_back(std::move(flag));
    check_by(sensor);
    for (const auto& [module, more] : flags) {
        if (module == "sensor" || more.empty()) continue;
        std::vector<std::string> command = {program(module).string()};
        for (std::string& flag : own_flags(module)) command.push_back(std::move(flag));
        command.push_back("--dump-config");
        check_by(command);
    }
}

void LaunchOptions::check_files() const {
    std::error_code ignored;
    if (!log.empty() && std::filesystem::exists(log, ignored))
        throw std::runtime_error(log.string() + " is there already: give another --log, or remove it");
    if (std::filesystem::exists(output, ignored) && !std::filesystem::is_directory(output, ignored))
        throw std::runtime_error("the output folder " + output.string() + " is a file");
    check_folder(output);
    check_folder(state_folder());
    if (!log.empty() && log.has_parent_path()) check_folder(log.parent_path());
}

}  // namespace planemap::launcher
