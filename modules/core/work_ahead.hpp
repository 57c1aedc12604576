// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace planemap {

/// Items that are read one after the other and prepared ahead of their turn, by threads of its own; take()
/// gives them in the order in which they were read, whichever was ready first.
///
/// Who takes works, too: where its item is still in another thread's hands, it does what those do, and an
/// item that nobody has begun to prepare it gets as it was read. So preparing must be nothing that its user
/// cannot do alone, and the number of threads changes no result. With one thread there is none of its own,
/// and nothing is read or prepared before it is taken.
template <typename Item>
class WorkAhead {
  public:
    struct Work {
        /// Reads the next item; false: it is the last one. Never called twice at once.
        std::function<bool(Item&)> read;
        /// Prepares an item, as one of so many workers as there are threads, from 0: never twice at once as
        /// the same one.
        std::function<void(Item&, int worker)> prepare;
    };

    /// `threads`, at least 1, counts the one that takes. At most `capacity` items, at least 1, are read and
    /// not taken; then reading waits. Throws std::system_error if a thread cannot be started.
    WorkAhead(int threads, std::size_t capacity, Work work) : capacity_(capacity), work_(std::move(work)) {
        try {
            for (int worker = 1; worker < threads; ++worker)
                threads_.emplace_back([this, worker] { go_on(worker); });
        } catch (...) {
            stop();
            throw;
        }
    }
    ~WorkAhead() { stop(); }
    WorkAhead(const WorkAhead&) = delete;
    WorkAhead& operator=(const WorkAhead&) = delete;

    /// The next item; nothing after the last one, and after stop(). Where reading or preparing threw, throws
    /// that in the item's place; what was not read ends the items.
    std::optional<Item> take() {
        std::unique_lock lock(mutex_);
        while (!stop_ && (places_.empty() ? !is_at_end_ : places_.front().is_busy))
            if (!work_once(lock, 0)) changed_.wait(lock);
        if (stop_ || places_.empty()) return std::nullopt;
        Place place = std::move(places_.front());
        places_.pop_front();
        changed_.notify_all();
        if (place.error) std::rethrow_exception(place.error);
        return std::move(place.item);
    }

    /// Reads and prepares nothing more, and waits for what is under way: `read` is the caller's alone.
    void stop() {
        {
            const std::lock_guard lock(mutex_);
            stop_ = true;
            changed_.notify_all();
        }
        for (std::thread& thread : threads_) thread.join();
        threads_.clear();
    }

  private:
    struct Place {
        Item item;
        std::exception_ptr error;
        bool is_busy = false, is_prepared = false;
    };

    void go_on(int worker) {
        std::unique_lock lock(mutex_);
        while (!stop_)
            if (!work_once(lock, worker)) changed_.wait(lock);
    }

    /// False if there is nothing to do.
    bool work_once(std::unique_lock<std::mutex>& lock, int worker) {
        const auto raw = std::find_if(places_.begin(), places_.end(), [](const Place& place) {
            return !place.is_prepared && !place.is_busy && !place.error;
        });
        if (raw != places_.end()) {
            prepare(lock, *raw, worker);
        } else if (!is_reading_ && !is_at_end_ && places_.size() < capacity_) {
            read(lock);
        } else {
            return false;
        }
        changed_.notify_all();
        return true;
    }

    void read(std::unique_lock<std::mutex>& lock) {
        is_reading_ = true;
        lock.unlock();
        Place place;
        bool is_last = true;
        try {
            is_last = !work_.read(place.item);
        } catch (...) {
            place.error = std::current_exception();
        }
        lock.lock();
        places_.push_back(std::move(place));
        is_at_end_ = is_last;
        is_reading_ = false;
    }

    /// The place stays where it is: a deque's elements do while others come and go at its ends, and it is not
    /// taken meanwhile.
    void prepare(std::unique_lock<std::mutex>& lock, Place& place, int worker) {
        place.is_busy = true;
        lock.unlock();
        std::exception_ptr error;
        try {
            work_.prepare(place.item, worker);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        place.error = error;
        place.is_busy = false;
        place.is_prepared = true;
    }

    std::size_t capacity_;
    Work work_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Place> places_;  ///< read and not taken
    bool is_reading_ = false, is_at_end_ = false, stop_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace planemap
