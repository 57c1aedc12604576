// SPDX-License-Identifier: BSD-3-Clause
#include "bench_run/program_run.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/processor_time.hpp"

namespace planemap::bench_run {

namespace {

constexpr std::chrono::milliseconds kLook{20};  // at memory, and whether it ended
constexpr int kNotStarted = 127;

/// The most memory that each process of a family had so far, KiB.
class FamilyMemory {
  public:
    void look_at(pid_t process) {
        const std::string folder = "/proc/" + std::to_string(process);
        std::ifstream status(folder + "/status");
        for (std::string line; std::getline(status, line);)
            if (line.starts_with("VmHWM:")) peak_kib_[process] = std::stod(line.substr(6));
        std::error_code gone;
        for (const auto& task : std::filesystem::directory_iterator(folder + "/task", gone)) {
            std::ifstream children(task.path() / "children");
            for (pid_t child = 0; children >> child;) look_at(child);
        }
    }
    double megabytes() const {
        double kib = 0;
        for (const auto& [process, peak] : peak_kib_) kib += peak;
        return kib / 1024;
    }

  private:
    std::map<pid_t, double> peak_kib_;
};

/// In the child; does not return.
[[noreturn]] void become(const std::vector<std::string>& command, int said) {
    std::vector<char*> arguments;
    arguments.reserve(command.size() + 1);
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nowhere >= 0) {
        ::dup2(nowhere, STDIN_FILENO);
        ::dup2(nowhere, STDOUT_FILENO);
    }
    ::dup2(said, STDERR_FILENO);
    ::execvp(arguments[0], arguments.data());
    ::_exit(kNotStarted);
}

std::string last_line(std::FILE* file) {
    std::rewind(file);
    std::string last, line;
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
        if (c != '\n') {
            line += static_cast<char>(c);
        } else if (!line.empty()) {
            last = std::exchange(line, {});
        }
    }
    return line.empty() ? last : line;
}

}  // namespace

ProgramRun run_program_to_end(const std::vector<std::string>& command) {
    using Clock = std::chrono::steady_clock;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> said(std::tmpfile(), std::fclose);
    if (!said) throw std::runtime_error("no temporary file for what " + command.front() + " says");
    const Clock::time_point start = Clock::now();
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("cannot fork for " + command.front());
    if (child == 0) become(command, ::fileno(said.get()));
    FamilyMemory memory;
    int status = 0;
    rusage usage = {};
    while (true) {
        const pid_t ended = ::wait4(child, &status, WNOHANG, &usage);
        if (ended == child) break;
        if (ended < 0 && errno != EINTR) throw std::runtime_error("lost sight of " + command.front());
        memory.look_at(child);
        std::this_thread::sleep_for(kLook);
    }
    ProgramRun run;
    run.wall_s = std::chrono::duration<double>(Clock::now() - start).count();
    run.cpu_s = processor_seconds(usage);
    run.peak_rss_mb = memory.megabytes();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return run;
    if (WIFEXITED(status) && WEXITSTATUS(status) == kNotStarted)
        throw std::runtime_error(command.front() + ": cannot be started");
    throw std::runtime_error(command.front() + ": failed: " + last_line(said.get()));
}

}  // namespace planemap::bench_run
