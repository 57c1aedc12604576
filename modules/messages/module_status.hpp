// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <planemap/module_status_t.hpp>
#include <string>
#include <vector>

#include "core/histogram.hpp"
#include "messages/bus.hpp"
#include "messages/remarks.hpp"
#include "messages/seq_counter.hpp"
#include "messages/spent.hpp"

namespace planemap::messages {

/// Counts what a module does and tells it once a second on PLANEMAP_STATUS_<MODULE>.
class ModuleStatus {
  public:
    /// module: lower case, e.g. "segmentation".
    explicit ModuleStatus(std::string module);

    /// Wraps a handler: an input that throws MessageError counts as a decode error (and goes on to the bus,
    /// which logs it).
    Bus::Handler guard(Bus::Handler handler);
    /// A message came, whatever becomes of it. guard() says so itself.
    void came() { ++came_; }

    /// One input of the module's main stream; its sequence number, where there is one, shows what was missed.
    /// Inputs that are dropped count too.
    void received(std::optional<std::uint32_t> seq = std::nullopt);
    void published() { ++published_; }
    /// The same of an output whose frame is of this time: how old it is now is the module's age, from the
    /// shutter to here. Stamps that are not of the wall clock (a recording's) tell none.
    void published(std::int64_t frame_utime, std::int64_t now_us);
    void dropped(std::int64_t count = 1) { dropped_ += count; }
    void decode_error() { ++decode_errors_; }
    /// Something of an input was not used, e.g. lost("regions out of range", 3). `what` is one of a fixed few
    /// plain words of the module, plural, without figures. Shown in the status, warned of at 10, 100, 1000
    /// and so on, and told by planemap-run's report. An input that is dropped as a whole counts in dropped()
    /// too.
    void lost(const std::string& what, std::int64_t count = 1);
    /// The same without a warning, where somebody else says it.
    void count_loss(const std::string& what, std::int64_t count = 1);
    /// What keeps the module from working, or what it found; shown in the status line.
    void set_text(std::string text) { text_ = std::move(text); }
    /// What keeps the module from working at all: the status is failing until it is empty again.
    void set_failing(std::string why) { failing_ = std::move(why); }
    /// What is true of all that the module says from now on, e.g. that the sensor started again; shown in the
    /// status after the text, and told by planemap-run's report. A later remark of the same kind (a word, not
    /// shown) takes the place of the earlier one; an empty one takes it back. Warned of the first time, and
    /// the 10th, 100th and so on.
    void remark(const std::string& kind, const std::string& text);

    /// The work on one input, on whichever thread it was done.
    void worked(const Spent& spent);
    /// Measures it from construction to destruction.
    class Work {
      public:
        explicit Work(ModuleStatus& status) : status_(status) { timer_.emplace(spent_); }
        ~Work() {
            timer_.reset();
            status_.worked(spent_);
        }
        Work(const Work&) = delete;
        Work& operator=(const Work&) = delete;

      private:
        ModuleStatus& status_;
        Spent spent_;
        std::optional<SpentTimer> timer_;
    };

    const std::string& module() const { return module_; }
    /// The remarks as they are shown.
    std::vector<std::string> remarks() const { return remarks_.texts(); }
    std::int64_t decode_error_count() const { return decode_errors_; }
    /// What was lost since the start, by its reason.
    const std::map<std::string, std::int64_t>& losses() const { return losses_; }
    /// Milliseconds of work for each input since the start.
    const Histogram& work_ms() const { return work_ms_; }
    /// The same in CPU time of the thread that worked: what a busy machine does not lengthen.
    const Histogram& work_cpu_ms() const { return work_cpu_ms_; }

    /// Why the module gave nothing, though it was given something: none of its inputs could be used. Empty
    /// if it is not so.
    std::string failure() const;

    /// Publishes at once, as the first message.
    void announce(Bus& bus, std::int64_t now_us);
    /// Publishes when a second has passed since the last time; `stopped` publishes at once, as the last
    /// message. Returns true if it did.
    bool publish_if_due(Bus& bus, std::int64_t now_us, bool stopped = false);
    /// The same in a line that a human can read.
    std::string line() const;

  private:
    module_status_t message(std::int64_t now_us, bool stopped) const;
    std::int8_t state(std::int64_t now_us) const;
    std::string full_text() const;

    std::string module_, channel_, text_, failing_, bus_trouble_;
    std::int64_t came_ = 0, received_ = 0, published_ = 0, dropped_ = 0, decode_errors_ = 0;
    std::map<std::string, std::int64_t> losses_;
    Remarks remarks_;
    bool is_connected_ = true;  ///< the bus, at the last status
    SeqCounter seqs_;
    Histogram work_ms_, work_cpu_ms_, window_ms_;
    Histogram age_ms_, window_age_ms_;  ///< from a frame's utime to what was published of it
    // Since the last status.
    std::int64_t window_start_us_ = 0, window_received_ = 0, window_published_ = 0, window_unusable_ = 0;
    std::int64_t unanswered_since_us_ = 0;  ///< inputs came since then, and nothing left; 0: none
    module_status_t last_;
    std::int32_t seq_ = 0;
};

}  // namespace planemap::messages
