// SPDX-License-Identifier: BSD-3-Clause
#include "launcher/supervisor.hpp"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "core/processor_time.hpp"

namespace planemap::launcher {

namespace {

using namespace std::chrono_literals;

constexpr Clock::duration kFirstBackOff = 500ms, kLongestBackOff = 10s;
constexpr Clock::duration kSoundLife = 30s;  // after which an end is not the same trouble going on
constexpr int kNoProgram = 127;

/// Those that wait() takes; not a hang-up that is ignored, as under nohup.
sigset_t watched_signals() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) {
        struct sigaction action = {};
        sigaction(signal, nullptr, &action);
        if (action.sa_handler != SIG_IGN) sigaddset(&set, signal);
    }
    return set;
}

/// In the child, up to the program itself; async-signal-safe calls only.
[[noreturn]] void become(char* const* arguments, pid_t parent) {
    ::setsid();
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(kNoProgram);  // it ended before it could have told
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    const int nothing = ::open("/dev/null", O_RDONLY);
    if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
    ::execvp(arguments[0], arguments);
    ::_exit(kNoProgram);
}

}  // namespace

std::string Ending::text() const {
    if (!by_signal) return "ended with code " + std::to_string(code);
    const int signal = code - 128;
    return "was ended by signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
}

void Supervisor::block_signals() {
    const sigset_t set = watched_signals();
    ::sigprocmask(SIG_BLOCK, &set, nullptr);
}

void Supervisor::start(const std::string& name, const std::vector<std::string>& command) {
    if (runs(name)) throw std::logic_error(name + " runs already");
    std::vector<char*> arguments;
    arguments.reserve(command.size() + 1);
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const pid_t parent = ::getpid(), pid = ::fork();
    if (pid < 0) throw std::runtime_error(command.at(0) + ": cannot be started: " + std::strerror(errno));
    if (pid == 0) become(arguments.data(), parent);
    children_[name] = {pid, Clock::now()};
    commands_[name] = command;
    due_.erase(name);
}

Clock::duration Supervisor::restart_later(const Ending& ending) {
    const auto before = back_off_.find(ending.name);
    const bool is_new_trouble = before == back_off_.end() || ending.lived >= kSoundLife;
    const Clock::duration delay =
        is_new_trouble ? kFirstBackOff : std::min(2 * before->second, kLongestBackOff);
    back_off_[ending.name] = delay;
    due_[ending.name] = Clock::now() + delay;
    return delay;
}

/// Starts again what has waited long enough.
void Supervisor::start_due() {
    const Clock::time_point now = Clock::now();
    for (auto at = due_.begin(); at != due_.end();) {
        if (at->second > now) {
            ++at;
            continue;
        }
        const std::string name = at->first;
        at = due_.erase(at);
        ++restarts_[name];
        start(name, std::vector<std::string>(commands_.at(name)));
    }
}

/// A process that has ended, if there is one.
std::optional<Ending> Supervisor::reap() {
    int status = 0;
    rusage used = {};
    const pid_t pid = ::wait4(-1, &status, WNOHANG, &used);
    if (pid <= 0) return std::nullopt;
    const auto child =
        std::find_if(children_.begin(), children_.end(), [&](const auto& c) { return c.second.pid == pid; });
    if (child == children_.end()) return reap();
    Ending ending{child->first, 0, false, Clock::now() - child->second.since};
    ending.by_signal = WIFSIGNALED(status);
    cpu_s_[child->first] += processor_seconds(used);
    ending.code = ending.by_signal ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    children_.erase(child);
    return ending;
}

std::optional<Ending> Supervisor::wait(Clock::time_point until) {
    const sigset_t set = watched_signals();
    for (;;) {
        if (std::optional<Ending> ending = reap()) return ending;
        start_due();
        Clock::time_point wake = until;
        for (const auto& [name, at] : due_) wake = std::min(wake, at);
        const auto left = std::max<Clock::duration>(wake - Clock::now(), 0ms);
        const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(left).count();
        const timespec timeout = {static_cast<time_t>(ns / 1000000000), static_cast<long>(ns % 1000000000)};
        const int signal = ::sigtimedwait(&set, nullptr, &timeout);
        if (signal > 0 && signal != SIGCHLD) {
            ++stop_signals_;
            return std::nullopt;
        }
        if (signal < 0 && Clock::now() >= until) return reap();
    }
}

void Supervisor::signal(const std::string& name, int signal) {
    const auto child = children_.find(name);
    if (child != children_.end()) ::kill(child->second.pid, signal);
}

std::vector<std::string> Supervisor::kill_all() {
    due_.clear();
    std::vector<std::string> names;
    for (const auto& [name, child] : children_) {
        names.push_back(name);
        ::kill(-child.pid, SIGKILL);  // with what it started
        ::kill(child.pid, SIGKILL);
    }
    for (const auto& [name, child] : children_) ::waitpid(child.pid, nullptr, 0);
    children_.clear();
    return names;
}

}  // namespace planemap::launcher
