// SPDX-License-Identifier: BSD-3-Clause
#include "log/copy.hpp"

#include <cmath>
#include <regex>
#include <stdexcept>

#include "core/validation.hpp"
#include "messages/log.hpp"
#include "results/new_file.hpp"

namespace planemap {

namespace {

class Selector {
  public:
    explicit Selector(const LogSelection& selection)
        : selection_(selection),
          channels_(selection.channels.empty() ? ".*" : selection.channels, std::regex::extended) {}

    bool takes(const messages::LogEvent& event) {
        if (!first_) first_ = event.utime;
        const double at = (static_cast<double>(event.utime) - static_cast<double>(*first_)) * 1e-6;
        return at >= selection_.from_s && (!selection_.to_s || at < *selection_.to_s) &&
               std::regex_match(event.channel, channels_);
    }

  private:
    const LogSelection& selection_;
    std::regex channels_;
    std::optional<std::int64_t> first_;
};

}  // namespace

void LogSelection::validate() const {
    FieldErrors errors("cut");
    errors.require(std::isfinite(from_s) && from_s >= 0, "from", from_s, "finite and at least 0");
    if (to_s) errors.require(std::isfinite(*to_s) && *to_s > from_s, "to", *to_s, "finite and beyond from");
    try {
        std::regex(channels, std::regex::extended);
    } catch (const std::regex_error&) {
        errors.require(false, "channels", channels, "a regular expression (extended)");
    }
    errors.throw_if_any();
}

CopiedLog copy_log(const std::filesystem::path& input, const std::filesystem::path& output,
                   const LogSelection& selection, const std::function<bool(double)>& progress) {
    selection.validate();
    messages::LogReader log(input);
    NewFile file(output);
    messages::LogWriter writer(file.part());
    Selector selector(selection);
    CopiedLog copied;
    for (messages::LogEvent event; log.next(event);) {
        if (selector.takes(event)) {
            event.number = copied.events++;
            writer.write(event);
        } else {
            ++copied.left_out;
        }
        if (!progress(static_cast<double>(log.bytes_read()) / static_cast<double>(log.bytes_total())))
            throw std::runtime_error(output.string() + ": stopped; nothing was written");
    }
    if (copied.events == 0) {
        throw std::runtime_error(input.string() + ": " +
                                 (copied.left_out == 0
                                      ? "is no LCM log: there is not one whole event in it"
                                      : "none of its " + std::to_string(copied.left_out) +
                                            " events lies in that time and on these channels") +
                                 "; nothing was written");
    }
    writer.close();
    file.put_in_place();
    copied.bytes_skipped = log.bytes_skipped();
    copied.complaints = log.complaints();
    return copied;
}

}  // namespace planemap
