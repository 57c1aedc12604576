// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/read_ahead.hpp"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace planemap::sensor {

/// Shared with the thread, which may outlive the ReadAhead.
struct ReadAhead::State {
    explicit State(std::shared_ptr<FrameSource> s) : source(std::move(s)) {}

    void read_all();

    std::shared_ptr<FrameSource> source;  // used by the thread alone
    std::mutex mutex;
    std::condition_variable changed;
    std::optional<Item> item;  // read and not taken
    std::exception_ptr error;  // ended the reading
    bool stop = false;         // nobody will take anything more
    bool done = false;         // the thread does nothing more
};

void ReadAhead::State::read_all() {
    bool more = true;
    while (more) {
        Item next;
        std::exception_ptr failed;
        try {
            next.result = source->next(next.frame);
        } catch (...) {
            failed = std::current_exception();
        }
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return !item || stop; });
        more = !stop && !failed && next.result.status != ReadResult::Status::kEnd;
        if (failed) {
            error = failed;
        } else if (!stop) {
            item = std::move(next);
        }
        if (!more) source.reset();  // who waits for the end of reading may count on being its last owner
        done = !more;
        changed.notify_all();
    }
}

ReadAhead::ReadAhead(std::shared_ptr<FrameSource> source)
    : state_(std::make_shared<State>(std::move(source))) {
    std::thread([state = state_] { state->read_all(); }).detach();
}

bool ReadAhead::stop() {
    const auto patience = std::exchange(patience_, std::chrono::milliseconds(0));
    std::unique_lock lock(state_->mutex);
    state_->stop = true;
    state_->changed.notify_all();
    return state_->changed.wait_for(lock, patience, [&] { return state_->done; });
}

std::optional<ReadAhead::Item> ReadAhead::take(std::chrono::milliseconds wait) {
    std::unique_lock lock(state_->mutex);
    state_->changed.wait_for(lock, wait, [&] { return state_->item || state_->done; });
    if (!state_->item) {
        if (state_->error) std::rethrow_exception(state_->error);
        return std::nullopt;
    }
    std::optional<Item> taken = std::exchange(state_->item, std::nullopt);
    state_->changed.notify_all();
    return taken;
}

}  // namespace planemap::sensor
