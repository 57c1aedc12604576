// SPDX-License-Identifier: BSD-3-Clause
#include "messages/module_status.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <ctime>

#include "messages/channels.hpp"

namespace planemap::messages {

namespace {
constexpr std::int64_t kPeriodUs = 1000000;
constexpr std::int64_t kOldest_us = 60000000;  // older, a frame was not taken just now
constexpr std::int64_t kAnswerUs = 3000000;    // by then something should have come out of what came in
}  // namespace

double thread_cpu_ms() {
    timespec time = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

ModuleStatus::ModuleStatus(std::string module)
    : module_(std::move(module)), channel_(channels::kStatusPrefix + module_) {
    std::transform(channel_.begin(), channel_.end(), channel_.begin(),
                   [](unsigned char c) { return std::toupper(c); });
    last_ = message(0, false);
}

Bus::Handler ModuleStatus::guard(Bus::Handler handler) {
    return [this, handler = std::move(handler)](const RawMessage& message) {
        came();
        try {
            handler(message);
        } catch (const MessageError& error) {
            decode_error();
            set_text(error.what());
            throw;
        }
    };
}

void ModuleStatus::received(std::optional<std::uint32_t> seq) {
    ++received_;
    if (seq) seqs_.add(*seq);
}

void ModuleStatus::published(std::int64_t frame_utime, std::int64_t now_us) {
    published();
    const std::int64_t age_us = now_us - frame_utime;
    if (age_us < 0 || age_us > kOldest_us) return;
    age_ms_.add(1e-3 * static_cast<double>(age_us));
    window_age_ms_.add(1e-3 * static_cast<double>(age_us));
}

void ModuleStatus::count_loss(const std::string& what, std::int64_t count) {
    if (count > 0) losses_[what] += count;
}

void ModuleStatus::lost(const std::string& what, std::int64_t count) {
    if (count <= 0) return;
    std::int64_t threshold = 10;
    while (threshold <= losses_[what]) threshold *= 10;
    count_loss(what, count);
    if (losses_[what] >= threshold) spdlog::warn("{}: lost {} {} so far", module_, losses_[what], what);
}

void ModuleStatus::remark(const std::string& kind, const std::string& text) {
    if (remarks_.set(kind, text)) spdlog::warn("{}: {}", module_, text);
}

/// The text with what was lost, and what ails the bus, behind it.
std::string ModuleStatus::full_text() const {
    std::string text = text_;
    const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
    if (!failing_.empty()) add(failing_);
    if (!bus_trouble_.empty()) add(bus_trouble_);
    for (const std::string& remark : remarks()) add(remark);
    for (const auto& [what, count] : losses_) add("lost " + std::to_string(count) + " " + what);
    if (seqs_.restarts() > 0) add("its sender started again, times: " + std::to_string(seqs_.restarts()));
    return text;
}

/// What the module has been doing since its last status.
std::int8_t ModuleStatus::state(std::int64_t now_us) const {
    const std::int64_t inputs = received_ - window_received_, outputs = published_ - window_published_;
    const std::int64_t unusable = dropped_ + decode_errors_ - window_unusable_;
    if (!failing_.empty()) return module_status_t::FAILING;
    if (!is_connected_) return module_status_t::FAILING;  // the bus's trouble says why
    if (came_ == 0 && received_ == 0 && published_ == 0) return module_status_t::WAITING;
    if (inputs > 0 && outputs > 0) return module_status_t::RUNNING;
    if (unusable > 0 && unusable >= inputs) return module_status_t::FAILING;
    if (inputs == 0) return module_status_t::IDLE;
    const bool unanswered = unanswered_since_us_ != 0 && now_us - unanswered_since_us_ >= kAnswerUs;
    return unanswered ? module_status_t::FAILING : module_status_t::RUNNING;
}

std::string ModuleStatus::failure() const {
    if (received_ == 0 || published_ > 0 || dropped_ + decode_errors_ < received_) return {};
    return "none of the " + std::to_string(received_) + " inputs could be used: " + full_text();
}

void ModuleStatus::worked(const Spent& spent) {
    work_ms_.add(spent.ms);
    work_cpu_ms_.add(spent.cpu_ms);
    window_ms_.add(spent.ms);
}

module_status_t ModuleStatus::message(std::int64_t now_us, bool stopped) const {
    const double seconds = static_cast<double>(now_us - window_start_us_) * 1e-6;
    const std::int64_t inputs = received_ - window_received_;
    module_status_t m;
    m.utime = now_us;
    m.seq = seq_;
    m.session = 0;
    const Histogram& age = window_age_ms_.count() > 0 ? window_age_ms_ : age_ms_;
    m.age_median_ms = age.count() > 0 ? static_cast<float>(age.median()) : -1;
    m.age_p95_ms = age.count() > 0 ? static_cast<float>(age.p95()) : -1;
    m.module = module_;
    m.text = full_text();
    m.rate_hz = seconds > 0 ? static_cast<double>(inputs) / seconds : 0;
    const Histogram& ms = window_ms_.count() > 0 ? window_ms_ : work_ms_;  // a slow module has quiet seconds
    m.latency_median_ms = static_cast<float>(ms.median());
    m.latency_p95_ms = static_cast<float>(ms.p95());
    m.received = received_;
    m.published = published_;
    m.dropped = dropped_;
    m.decode_errors = decode_errors_;
    m.gaps = seqs_.missed();
    m.state = stopped ? std::int8_t{module_status_t::STOPPED} : state(now_us);
    return m;
}

void ModuleStatus::announce(Bus& bus, std::int64_t now_us) {
    window_start_us_ = now_us - kPeriodUs;
    publish_if_due(bus, now_us);
}

bool ModuleStatus::publish_if_due(Bus& bus, std::int64_t now_us, bool stopped) {
    if (window_start_us_ == 0) window_start_us_ = now_us;
    if (!stopped && now_us - window_start_us_ < kPeriodUs) return false;
    bus_trouble_ = bus.trouble();
    is_connected_ = bus.connected();
    last_ = message(now_us, stopped);
    last_.session = bus.session();
    bus.publish(channel_, last_);
    ++seq_;
    if (published_ > window_published_)
        unanswered_since_us_ = 0;
    else if (received_ > window_received_ && unanswered_since_us_ == 0)
        unanswered_since_us_ = window_start_us_;
    window_start_us_ = now_us;
    window_unusable_ = dropped_ + decode_errors_;
    window_received_ = received_;
    window_published_ = published_;
    window_ms_ = window_age_ms_ = Histogram();
    return true;
}

std::string ModuleStatus::line() const {
    static constexpr const char* kStates[] = {"waiting", "running", "idle", "failing", "stopped"};
    // What came since the last status is newer than its state.
    const bool news =
        is_connected_ && (received_ > window_received_ || last_.state == module_status_t::WAITING);
    const std::int8_t now =
        news && last_.state != module_status_t::STOPPED ? state(window_start_us_) : last_.state;
    char line[256];
    std::snprintf(
        line, sizeof(line),
        "%s: %.1f Hz, %.2f ms (p95 %.2f), %lld in, %lld out, %lld dropped, %lld corrupt, %lld missed",
        kStates[now], last_.rate_hz, static_cast<double>(last_.latency_median_ms),
        static_cast<double>(last_.latency_p95_ms), static_cast<long long>(received_),
        static_cast<long long>(published_), static_cast<long long>(dropped_),
        static_cast<long long>(decode_errors_), static_cast<long long>(seqs_.missed()));
    std::string text = full_text();
    if (age_ms_.count() > 0) {
        char age[80];
        std::snprintf(age, sizeof(age), "%.0f ms (p95 %.0f) after the shutter", age_ms_.median(),
                      age_ms_.p95());
        text = age + (text.empty() ? "" : "; " + text);
    }
    return text.empty() ? line : std::string(line) + "; " + text;
}

}  // namespace planemap::messages
