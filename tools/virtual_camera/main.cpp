// SPDX-License-Identifier: BSD-3-Clause
// planemap-virtual-camera: runs a command that finds a camera where there is none.
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "messages/process.hpp"
#include "sensor/source.hpp"
#include "virtual_camera/options.hpp"
#include "virtual_camera/private_folder.hpp"

namespace planemap::virtual_camera {
namespace {

constexpr const char* kProgram = "planemap-virtual-camera";
volatile sig_atomic_t child = 0;

/// What somebody sent to this process alone; Ctrl-C of a terminal reaches the command by itself.
void forward(int signal, siginfo_t* info, void*) {
    if (info->si_code != SI_KERNEL && child > 0) kill(child, signal);
}

/// Puts a folder in front of a list of folders in the environment.
void prepend(const char* variable, const std::filesystem::path& folder) {
    const char* const before = std::getenv(variable);
    std::string value = folder.string();
    if (before != nullptr && *before != '\0') value.append(":").append(before);
    setenv(variable, value.c_str(), 1);
}

/// Runs the command to its end and returns its exit code, or 128 and the signal that ended it.
int run_command(char** command) {
    struct sigaction action = {};
    action.sa_sigaction = forward;
    action.sa_flags = SA_SIGINFO | SA_RESTART;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
    const pid_t pid = fork();
    if (pid < 0)
        throw std::runtime_error(std::string("the command cannot be started: ") + std::strerror(errno));
    if (pid == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        execvp(command[0], command);
        std::fprintf(stderr, "%s: %s: %s\n", kProgram, command[0], std::strerror(errno));
        _exit(errno == ENOENT ? 127 : 126);
    }
    child = pid;
    int status = 0;
    while (waitpid(pid, &status, 0) < 0) {
        if (errno != EINTR) throw std::runtime_error(std::string("waitpid: ") + std::strerror(errno));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int run(const Order& order, char** command) {
    order.options.validate();
    sensor::open_source(order.input);  // an input that is none is said here, not by a driver
    const std::filesystem::path programs = std::filesystem::canonical("/proc/self/exe").parent_path();
    const PrivateFolder folder(programs.parent_path() / "lib/planemap/libPlanemapVirtualCamera.so.0");
    prepend("LD_LIBRARY_PATH", folder.path());
    prepend("PATH", programs);
    setenv(kOrderVariable, to_text(order).c_str(), 1);
    return run_command(command);
}

}  // namespace
}  // namespace planemap::virtual_camera

int main(int argc, char** argv) {
    using namespace planemap;
    virtual_camera::Order order;
    messages::Flags flags(
        virtual_camera::kProgram,
        "planemap-virtual-camera INPUT [options] -- COMMAND [arguments]\n"
        "Runs COMMAND with a virtual OpenNI2 camera that streams INPUT, and faults on order; of "
        "other cameras it sees none.\n"
        "Example: planemap-virtual-camera sim:office -- planemap-sensor openni2");
    flags.add_positional(
        "input", order.input,
        "What the camera sees: an INPUT of planemap-run, e.g. a TUM-layout folder, an LCM log or sim:WORLD");
    flags.add(virtual_camera::options_of(order.options));
    char** const dashes =
        std::find_if(argv, argv + argc, [](const char* a) { return std::strcmp(a, "--") == 0; });
    const int parsed = flags.parse(static_cast<int>(dashes - argv), argv);
    if (parsed >= 0) return parsed;
    if (dashes >= argv + argc - 1) {
        std::fprintf(stderr, "%s: give the command to run behind --; see --help\n", virtual_camera::kProgram);
        return 2;
    }
    return messages::run_main(virtual_camera::kProgram,
                              [&] { return virtual_camera::run(order, dashes + 1); });
}
